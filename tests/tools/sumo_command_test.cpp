// export -o x.nod.xml and x.net.xml.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/tools/town.h"

namespace roadbed::tests {
namespace {

/// Sets a variable of the environment for as long as it lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    const char* old = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): no threads here
    if (old != nullptr) old_ = old;
    ::setenv(name, value.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  }
  ~Variable() { ::setenv(name_, old_.c_str(), 1); }  // NOLINT(concurrency-mt-unsafe)
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::string old_;
};

/// A folder with a program that takes netconvert's place.
class FakeNetconvert : public TemporaryFolder {
 public:
  explicit FakeNetconvert(const std::string& script) {
    std::filesystem::create_directory(path() / "bin");
    const std::string file = write("bin/netconvert", "#!/bin/sh\n" + script);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
};

TEST(SumoCommand, PlainFilesStandBesideEachOther) {
  const TemporaryFolder folder;
  const ProgramRun run = run_roadbed({"export", kTown, "-o", folder / "a.b.nod.xml", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(files_below(folder.path()),
            (std::vector<std::string>{"a.b.con.xml", "a.b.edg.xml", "a.b.netccfg", "a.b.nod.xml",
                                      "a.b.tll.xml"}));
  EXPECT_NE(bytes_of(folder / "a.b.netccfg").find("\"a.b.edg.xml\""), std::string::npos);
  const auto document = nlohmann::json::parse(run.out);
  EXPECT_EQ(document["format"], "SUMO plain files");
  EXPECT_FALSE(document["lost"].empty());
  std::size_t bytes = 0;
  for (const std::string& name : files_below(folder.path()))
    bytes += bytes_of(folder / name).size();
  EXPECT_EQ(document["bytes"], bytes);
}

TEST(SumoCommand, NoneIsWrittenWhereOneIsInTheWay) {
  const TemporaryFolder folder;
  folder.write("a.tll.xml", "mine");
  EXPECT_EQ(run_roadbed({"export", kTown, "-o", folder / "a.nod.xml"}).status, 3);
  EXPECT_EQ(files_below(folder.path()), std::vector<std::string>{"a.tll.xml"});
  EXPECT_EQ(bytes_of(folder / "a.tll.xml"), "mine");
  EXPECT_EQ(run_roadbed({"convert", kTown, folder / "a.nod.xml", "-f"}).status, 0);
  EXPECT_NE(bytes_of(folder / "a.tll.xml"), "mine");
}

TEST(SumoCommand, SeveralFilesAreNoStandardOutput) {
  EXPECT_EQ(run_roadbed({"export", kTown, "-o", "-", "--format", "nod.xml"}).status, 2);
}

// Which its configuration lists with commas between.
TEST(SumoCommand, NamesWithCommasAreRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_roadbed({"export", kTown, "-o", folder / "a,b.nod.xml"}).status, 2);
  EXPECT_EQ(run_roadbed({"export", kTown, "-o", folder / "a,b.svg"}).status, 0);
}

TEST(SumoCommand, ASystemThatProjDoesNotKnowIsRefusedAsByAnyOutput) {
  const TemporaryFolder folder;
  for (const char* name : {"a.nod.xml", "a.svg", "a.geojson"}) {
    const ProgramRun run =
        run_roadbed({"export", kTown, "-o", folder / name, "--crs", "no system"});
    EXPECT_EQ(run.status, 3) << name;
    EXPECT_NE(run.err.find("PROJ cannot use it"), std::string::npos) << run.err;
  }
}

TEST(SumoCommand, SaysInALineWhatToDoWithoutNetconvert) {
  const TemporaryFolder folder;
  const Variable path("PATH", folder.path().string()), home("SUMO_HOME", "");
  const ProgramRun run = run_roadbed({"export", kTown, "-o", folder / "a.net.xml"});
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.err.find("install SUMO"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("-o x.nod.xml"), std::string::npos) << run.err;
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(SumoCommand, NetIsWhatNetconvertMakesButForTheTime) {
  const FakeNetconvert sumo(
      "cd $(dirname $2)\necho 'Warning: something' >&2\necho 'Warning: SUMO_HOME' >&2\n"
      "ls net.nod.xml net.edg.xml net.con.xml net.tll.xml >/dev/null || exit 1\n"
      "printf '<?xml version=\"1.0\"?>\\n<!-- made on %s -->\\n<net a=\"1\">\\n</net>\\n' $$ "
      "> net.net.xml\n");
  const TemporaryFolder folder;
  const Variable home("SUMO_HOME", sumo.path().string());
  const ProgramRun run =
      run_roadbed({"export", kTown, "-o", folder / "a.net.xml", "--json", "--quiet"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(bytes_of(folder / "a.net.xml"),
            "<?xml version=\"1.0\"?>\n<!-- roadbed, netconvert -->\n<net a=\"1\">\n</net>\n");
  EXPECT_EQ(nlohmann::json::parse(run.out)["notes"],
            nlohmann::json::array({"netconvert: something"}));
}

TEST(SumoCommand, NothingIsWrittenWhereNetconvertFails) {
  const FakeNetconvert sumo("echo 'Error: no such thing' >&2\nexit 1\n");
  const TemporaryFolder folder;
  const Variable home("SUMO_HOME", sumo.path().string());
  const ProgramRun run = run_roadbed({"export", kTown, "-o", folder / "a.net.xml"});
  EXPECT_EQ(run.status, 3);
  EXPECT_NE(run.err.find("no such thing"), std::string::npos) << run.err;
  EXPECT_TRUE(files_below(folder.path()).empty());
}

}  // namespace
}  // namespace roadbed::tests
