#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/file_size_limit.h"
#include "roadbed/tests/tools/audit/audit_command_fixture.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

TEST_F(AuditCommand, WritesATestCasePerDrive) {
  const std::string junit = folder_ / "audit.xml";
  EXPECT_EQ(audit({"--trajectory", drives_, "--junit", junit}).status, 1);
  const std::string xml = bytes_of(junit);
  EXPECT_THAT(xml, HasSubstr("tests=\"4\" failures=\"1\" errors=\"1\""));
  EXPECT_THAT(xml, HasSubstr("name=\"hit.csv\">\n      <failure message=\"conflict\">"));
  EXPECT_THAT(xml, HasSubstr("name=\"broken.csv\">\n      <error message="));
}

TEST_F(AuditCommand, WritesStretchesConflictsAndWitnessesAsGeoJson) {
  const std::string file = folder_ / "audit.geojson";
  EXPECT_EQ(audit({"--trajectory", folder_ / "drives/hit.csv", "--geojson", file}).status, 1);
  const Json json = Json::parse(bytes_of(file));
  EXPECT_EQ(json.at("type"), "FeatureCollection");
  std::vector<std::string> kinds;
  for (const Json& feature : json.at("features")) {
    kinds.push_back(feature.at("properties").at("kind"));
    if (kinds.back() != "witness") continue;
    const Json& ring = feature.at("geometry").at("coordinates").at(0);
    EXPECT_EQ(ring.at(0), ring.at(4));
    EXPECT_NEAR(ring.at(0).at(0).get<double>(), 10.0, 1e-6);
    EXPECT_NEAR(ring.at(0).at(1).get<double>(), 1.0, 1e-6);
  }
  EXPECT_THAT(kinds, testing::ElementsAre("stretch", "stretch", "stretch", "conflict", "witness"));
}

TEST_F(AuditCommand, WritesNoneOfItsFilesWhereOneDoesNotFit) {
  const std::string page = folder_ / "audit.html", saved = folder_ / "saved.csv";
  const std::vector<std::string> before = files_below(folder_.path());
  const FileSizeLimit limit(20'000);  // the page is larger, the drive is not
  const ProgramRun run =
      audit({"--trajectory", folder_ / "drives/hit.csv", "--save-drive", saved, "--report", page});
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.err, HasSubstr("audit.html: cannot be written: File too large"));
  EXPECT_EQ(files_below(folder_.path()), before);
}

TEST_F(AuditCommand, WritesAPageThatPlaysTheAudit) {
  const std::string page = folder_ / "audit.html";
  EXPECT_EQ(audit({"--trajectory", folder_ / "drives/hit.csv", "--report", page}).status, 1);
  const std::string html = bytes_of(page);
  EXPECT_THAT(html, HasSubstr("conflict: least clearance 0.00 m"));
  EXPECT_THAT(html, HasSubstr("conflict begins: occupied space, front"));
  EXPECT_THAT(html, HasSubstr("proven clearance"));
}

TEST_F(AuditCommand, DrawsACloseUpOfEachConflictWithALinkToItsTime) {
  const std::string page = folder_ / "near.html";
  const std::string drive = folder_ / "drives/near.csv";
  EXPECT_EQ(audit({"--trajectory", drive, "--report", page, "--clearance", "0.5"}).status, 1);
  const std::string html = bytes_of(page);
  EXPECT_THAT(html, HasSubstr("<h2>Close-ups</h2>"));
  EXPECT_THAT(html, HasSubstr("class=\"up-witness\""));
  EXPECT_THAT(html, HasSubstr("class=\"up-arrow\""));
  EXPECT_THAT(html, HasSubstr("0.195 m from occupied space"));
  EXPECT_THAT(html, testing::ContainsRegex("<figcaption><a href=\"#t=[0-9.]+\""));
}

TEST_F(AuditCommand, ListsTheDrivesOfAFolderOnOnePage) {
  const std::string page = folder_ / "all.html";
  EXPECT_EQ(audit({"--trajectory", drives_, "--report", page}).status, 1);
  const std::string html = bytes_of(page);
  EXPECT_THAT(html, HasSubstr("<h1>Audit of 4 drives</h1>"));
  EXPECT_THAT(html, HasSubstr("1 unusable, 2 clear, 1 conflict"));
  EXPECT_THAT(html, HasSubstr("<a href=\"#drive-3\">hit.csv</a></td><td class=\"bad\">conflict"));
  EXPECT_THAT(html, HasSubstr("class=\"up-witness\""));
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));  // asks nobody for anything
}

}  // namespace
}  // namespace roadbed::tests
