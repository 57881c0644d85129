// Files of every version of every format: read, or refused where that is meant; newer ones are
// refused with one line; and what commands print says its version. The rule is in tools/README.md.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/occupancy/octree/tiles_index.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"
#include "roadbed/tools/audit/certificate_json.h"
#include "roadbed/tools/batch/job.h"
#include "roadbed/tools/commands/commands.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/vehicle_file.h"
#include "roadbed/tools/report/drive_record.h"
#include "roadbed/tools/simulation/planner_options.h"
#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;
using Read = std::function<void(const std::string& bytes, const std::string& name)>;

void read_noise(const std::string& bytes, const std::string& name) {
  const TemporaryFolder folder;
  tools::read_noise_json(folder.write(name, bytes));
}

/// A format's readers, and how it is refused that a file is of a newer version.
struct VersionedFormat {
  std::vector<std::string> files, refused;  ///< of all versions; of those that are meant to be
  Read read;
  std::string version, newer;  ///< what stands in the last of `files`, and would in a newer one
};

std::vector<VersionedFormat> formats() {
  const auto job = [](const std::string& bytes, const std::string&) {
    tools::parse_job(bytes.substr(0, bytes.find('\n')), tools::job_kinds());
  };
  return {
      {{"map_3.rbm"},
       {"map_1.rbm"},
       [](const std::string& bytes, const std::string& name) {
         map::verify_compiled_map(bytes, name);
       },
       "map v003",
       "map v004"},
      {{"certificate_2.json"},
       {"certificate_1.json"},
       tools::parse_certificate_json,
       "certificate 2",
       "certificate 3"},
      {{"tiles_2.json"}, {"tiles_1.json"}, map::parse_tiles_index, "tiles 2", "tiles 3"},
      {{"drive_1.json"},
       {},
       tools::parse_drive_record,
       "\"roadbed_drive\": 1",
       "\"roadbed_drive\": 2"},
      {{"scenario_1.json"},
       {},
       tools::parse_scenario,
       "\"roadbed_scenario\": 1",
       "\"roadbed_scenario\": 2"},
      {{"vehicle_unsaid.json", "vehicle_1.json"},
       {},
       tools::parse_vehicle,
       "\"roadbed_vehicle\": 1",
       "\"roadbed_vehicle\": 2"},
      {{"options_1.json"},
       {},
       tools::parse_planner_options,
       "\"roadbed_options\": 1",
       "\"roadbed_options\": 2"},
      {{"noise_1.json"}, {}, read_noise, "\"roadbed_noise\": 1", "\"roadbed_noise\": 2"},
      {{"jobs_1.jsonl"}, {}, job, "\"roadbed_job\":1", "\"roadbed_job\":2"},
  };
}

std::string format_file(const std::string& name) {
  const std::string bytes = bytes_of(data_folder() / "formats" / name);
  EXPECT_FALSE(bytes.empty()) << name;
  return bytes;
}

std::string refusal_of(const Read& read, const std::string& bytes, const std::string& name) {
  return tests::refusal_of([&] { read(bytes, name); });
}

TEST(FormatVersions, AreReadOrRefusedWithAReason) {
  for (const VersionedFormat& format : formats()) {
    for (const std::string& name : format.files) {
      EXPECT_EQ(refusal_of(format.read, format_file(name), name), "accepted");
    }
    for (const std::string& name : format.refused) {
      const std::string reason = refusal_of(format.read, format_file(name), name);
      EXPECT_THAT(reason, HasSubstr(name)) << reason;
      EXPECT_THAT(reason, HasSubstr(", needs ")) << reason;
    }
  }
}

TEST(FormatVersions, ThatAreNewerAreRefusedInOneLineThatNamesThem) {
  for (const VersionedFormat& format : formats()) {
    const std::string name = format.files.back();
    SCOPED_TRACE(name);
    std::string bytes = format_file(name);
    const std::size_t at = bytes.find(format.version);
    ASSERT_NE(at, std::string::npos);
    bytes.replace(at, format.version.size(), format.newer);
    if (!name.ends_with(".rbm") && !name.starts_with("certificate")) {
      bytes.insert(bytes.find('{') + 1, "\"a_key_of_tomorrow\": 1, ");
    }
    const std::string reason = refusal_of(format.read, bytes, name);
    EXPECT_THAT(reason, HasSubstr(format.newer.substr(format.newer.size() - 1))) << reason;
    EXPECT_THAT(reason, HasSubstr("needs ")) << reason;
    EXPECT_THAT(reason, testing::Not(HasSubstr("a_key_of_tomorrow")));
    EXPECT_EQ(reason.find('\n'), std::string::npos);
  }
}

TEST(FormatVersions, OfEveryDocumentThatACommandPrintsStandFirst) {
  const TemporaryFolder folder;
  const std::string town = data_folder() / "town.xodr", walls = data_folder() / "town.bt";
  const std::string from = "lane:1/0/-1@10", to = "lane:7/0/1@35";
  const std::string pairs = folder.write("pairs.csv", "from,to\n" + from + "," + to + "\n");
  const std::string jobs =
      folder.write("jobs.jsonl", R"({"job":"validate","inputs":[")" + town + "\"]}\n");
  const std::string drive =
      folder.write("drive.csv", "t_s,x_m,y_m,heading_rad\n0,150,198,0\n1,155,198,0\n");
  std::filesystem::create_directory(folder / "drives");
  std::filesystem::copy(drive, folder / "drives/a.csv");
  const std::string scene = data_folder() / "scenarios/parked_car.json";
  const std::string run = folder / "run", proof = folder / "proof.json";
  const std::vector<std::pair<std::string, std::vector<std::string>>> documents{
      {"import", {"import", town, "-o", folder / "town.rbm"}},
      {"info", {"info", town}},
      {"findings", {"validate", town}},
      {"map_diff", {"map", "diff", town, town}},
      {"map_clip", {"map", "clip", town, "--bbox=0,0,200,300", "-o", folder / "part.xodr"}},
      {"map_merge", {"map", "merge", town, town, "-o", folder / "merged.xodr"}},
      {"map_transform", {"map", "transform", town, "--turn=1", "-o", folder / "turned.xodr"}},
      {"map_stats", {"map", "stats", town}},
      {"map_fix", {"map", "fix", town}},
      {"locate", {"locate", town, "--at", "150,198"}},
      {"route", {"route", town, "--from", from, "--to", to}},
      {"route", {"route", town, "--from", from, "--to", to, "--avoid", "road:7"}},
      {"routes", {"route", town, "--batch", pairs}},
      {"reach", {"reach", town, "--from", from, "--within", "60s"}},
      {"plan", {"plan", scene, "-o", folder / "plan"}},
      {"control_design", {"control", "design"}},
      {"drive_info", {"drive", "info", drive}},
      {"metrics", {"simulate", scene, "-o", run}},
      {"plan", {"plan", run + "@1", "-o", folder / "again"}},
      {"comparison", {"report", "compare", run, run}},
      {"occupancy_info", {"occupancy", "info", walls}},
      {"audit", {"audit", "--occupancy", walls, "--trajectory", drive, "--certificate", proof}},
      {"audits", {"audit", "--occupancy", walls, "--trajectory", folder / "drives"}},
      {"certificate_check", {"audit", "--check", proof}},
      {"batch", {"batch", jobs, "-o", folder / "results"}},
  };
  for (auto [kind, words] : documents) {
    SCOPED_TRACE(testing::PrintToString(words));
    words.insert(words.end(), {"--json", "--quiet"});
    const ProgramRun printed = run_roadbed(words);
    const auto document = tools::Json::parse(printed.out, nullptr, false);
    ASSERT_TRUE(document.is_object()) << printed.out << printed.err;
    EXPECT_EQ(document.begin().key(), "roadbed_" + kind);
    EXPECT_EQ(document.begin().value(), 1);
  }
}

}  // namespace
}  // namespace roadbed::tests
