// Every command on input that it cannot use: exit status 3, one line on stderr that names the file,
// nothing on stdout, nothing written.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/tools/line_of.h"
#include "roadbed/tests/tools/town.h"

namespace roadbed::tests {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "'" << from << "' is not in the text";
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Content that no reader of maps can use.
struct BadMap {
  std::string name;
  std::string bytes;
};

std::vector<BadMap> bad_maps() {
  const std::string town = town_bytes();
  return {
      {"empty.xodr", ""},
      {"truncated.xodr", town.substr(0, town.size() / 2)},
      {"not_xml.xodr", "lane,x,y\n1,2,3\n"},
      {"wrong_format.xodr", "<?xml version=\"1.0\"?>\n<kml><Document/></kml>\n"},
      {"nan.xodr", replaced(town, "hdg=\"3.141592653589793\"", "hdg=\"nan\"")},
      {"zeros.rbm", std::string(4096, '\0')},
  };
}

void expect_refused(const ProgramRun& run, const std::string& culprit, int status = 3) {
  EXPECT_EQ(run.status, status) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_EQ(run.err.rfind("roadbed: ", 0), 0U) << run.err;
  EXPECT_NE(run.err.find(culprit), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("internal error"), std::string::npos) << run.err;
  EXPECT_EQ(run.out, "");
}

/// Every command that reads a map; "MAP" stands for the map, "OUT" for an output without suffix.
std::vector<std::vector<std::string>> commands_on_a_map() {
  return {
      {"import", "MAP", "-o", "OUT.rbm"}, {"info", "MAP"},
      {"info", "MAP", "--json"},          {"export", "MAP", "-o", "OUT.geojson"},
      {"export", "MAP", "-o", "OUT.svg"}, {"export", "MAP", "-o", "OUT.csv"},
  };
}

std::vector<std::string> filled_in(std::vector<std::string> words, const std::string& map,
                                   const std::string& out) {
  for (std::string& word : words) {
    if (word == "MAP") word = map;
    if (word.rfind("OUT", 0) == 0) word.replace(0, 3, out);
  }
  return words;
}

TEST(BadInput, MapThatCannotBeUsedIsRefusedByEveryCommandAndLeavesNoOutput) {
  for (const BadMap& map : bad_maps()) {
    const TemporaryFolder folder;
    const std::string file = folder.write(map.name, map.bytes);
    for (const auto& command : commands_on_a_map()) {
      const auto words = filled_in(command, file, folder / "out");
      SCOPED_TRACE(line_of(words));
      expect_refused(run_roadbed(words), map.name);
    }
    EXPECT_EQ(files_below(folder.path()), std::vector<std::string>{map.name});
  }
}

TEST(BadInput, MissingMapIsNamedByEveryCommand) {
  const TemporaryFolder folder;
  for (const auto& command : commands_on_a_map()) {
    const auto words = filled_in(command, folder / "no.xodr", folder / "out");
    SCOPED_TRACE(line_of(words));
    expect_refused(run_roadbed(words), "no.xodr");
  }
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(BadInput, FolderInPlaceOfAMapIsNamedByEveryCommand) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "map.xodr");
  for (const auto& command : commands_on_a_map()) {
    const auto words = filled_in(command, folder / "map.xodr", folder / "out");
    SCOPED_TRACE(line_of(words));
    expect_refused(run_roadbed(words), "map.xodr");
  }
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(BadInput, StartThatIsOffTheRoadOrNoPlaceIsNamed) {
  const TemporaryFolder folder;
  const std::string town = data_folder() / "town.xodr";
  for (const std::string start : {"0,0", "1e9,0", "lane:no", "lane:1/3/1@1e6"}) {
    SCOPED_TRACE(start);
    expect_refused(run_roadbed({"route", town, "--from", start, "--to", "lane:7/0/1"}), start);
    expect_refused(run_roadbed({"reference", town, "--from", start, "--to", "lane:7/0/1", "-o",
                                folder / "out.csv"}),
                   start);
  }
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(BadInput, UnreachableGoalIsAnAnswerWithAReason) {
  const TemporaryFolder folder;
  const std::string town = data_folder() / "town.xodr";
  const std::vector<std::string> closed{"--from",     "lane:1/3/1", "--to",
                                        "lane:7/0/1", "--avoid",    "lane:2102/0/-1"};
  std::vector<std::string> words{"route", town};
  words.insert(words.end(), closed.begin(), closed.end());
  expect_refused(run_roadbed(words), "no route", 1);

  words.emplace_back("--json");
  const ProgramRun run = run_roadbed(words);
  EXPECT_EQ(run.status, 1);
  const auto answer = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_TRUE(answer.is_object()) << run.out;
  EXPECT_EQ(answer.at("found"), false);
  EXPECT_FALSE(answer.at("reason").get<std::string>().empty());

  words = {"reference", town, "-o", folder / "out.csv"};
  words.insert(words.end(), closed.begin(), closed.end());
  expect_refused(run_roadbed(words), "no route", 1);
  EXPECT_TRUE(files_below(folder.path()).empty());
}

/// Content that no reader of clouds can use.
std::vector<BadMap> bad_clouds() {
  const std::string scan = bytes_of(data_folder() / "scans" / "scan_00.pcd");
  const std::string header = scan.substr(0, scan.find("DATA binary"));
  return {
      {"empty.pcd", ""},
      {"header_only.pcd", header},
      {"truncated.pcd", scan.substr(0, scan.size() - 5)},
      {"too_many.pcd", replaced(scan, "\nPOINTS ", "\nPOINTS 99999999")},
      {"not_a_cloud.pcd", "lane,x,y\n1,2,3\n"},
      {"nan.xyz", "nan nan nan\nnan 1 2\n"},
      {"empty.bt", ""},
      {"ones.bt", std::string(4096, '\xff')},
  };
}

TEST(BadInput, CloudThatCannotBeUsedIsRefusedAndLeavesNoOutput) {
  for (const BadMap& cloud : bad_clouds()) {
    SCOPED_TRACE(cloud.name);
    const TemporaryFolder folder;
    const std::string file = folder.write(cloud.name, cloud.bytes);
    expect_refused(run_roadbed({"occupancy", "build", file, "-o", folder / "out.bt"}), cloud.name);
    EXPECT_EQ(files_below(folder.path()), std::vector<std::string>{cloud.name});
  }
}

TEST(BadInput, ScenarioThatCannotBeUsedIsRefusedAndLeavesNoFolder) {
  const std::string good = bytes_of(data_folder() / "scenarios" / "parked_car.json");
  const std::string town = data_folder() / "town.xodr";
  const std::string here = replaced(good, "../town.xodr", town);
  const std::vector<BadMap> scenarios{
      {"empty.json", ""},
      {"truncated.json", good.substr(0, good.size() / 2)},
      {"unknown_key.json", replaced(here, "\"goal\"", "\"gaol\": 1, \"goal\"")},
      {"no_map.json", replaced(good, "../town.xodr", "no_such.xodr")},
      {"off_road.json", replaced(here, "lane:1/3/1@6", "0,0")},
  };
  for (const BadMap& scenario : scenarios) {
    SCOPED_TRACE(scenario.name);
    const TemporaryFolder folder;
    const std::string file = folder.write(scenario.name, scenario.bytes);
    const ProgramRun run = run_roadbed({"simulate", file, "-o", folder / "out"});
    expect_refused(run, "");
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }
}

TEST(BadInput, GoalBehindAClosedRoadIsANoWithItsReason) {
  std::string closed = bytes_of(data_folder() / "scenarios" / "closed_road.json");
  closed = replaced(closed, "../town.xodr", data_folder() / "town.xodr");
  closed = replaced(closed, "\"duration_s\": 150.0", "\"duration_s\": 50.0");
  closed = replaced(closed, "lane:2202/0/-1@9.2", "lane:2/3/1@30");
  closed = replaced(closed, "\"width_m\": 4.2", "\"width_m\": 9.0");
  const std::vector<BadMap> scenarios{
      {"far_behind.json", closed},
      {"right_behind.json", replaced(closed, "lane:1/3/-1@60", "lane:2/3/1@32")},
      {"within.json", replaced(closed, "lane:1/3/-1@60", "lane:2/3/1@30")},
  };
  for (const BadMap& scenario : scenarios) {
    SCOPED_TRACE(scenario.name);
    const TemporaryFolder folder;
    const std::string file = folder.write(scenario.name, scenario.bytes);
    const ProgramRun run = run_roadbed({"simulate", file, "-o", folder / "out", "--quiet"});
    EXPECT_EQ(run.status, 1) << run.err;
    EXPECT_EQ(std::ranges::count(run.out, '\n'), 1) << run.out;
    EXPECT_NE(run.out.find("the road is blocked: barrier road works has not moved for 10 s; no "
                           "other route: no lane sequence leads from lane 2/3/1"),
              std::string::npos)
        << run.out;
  }
}

TEST(BadInput, DriveThatCannotBeUsedIsRefusedByAudit) {
  const TemporaryFolder folder;
  const std::string walls = folder / "walls.bt";
  const std::string cloud = data_folder() / "scenarios" / "narrow_gap.pcd";
  ASSERT_EQ(run_roadbed({"occupancy", "build", cloud, "-o", walls, "--quiet"}).status, 0);
  const std::string header = "t_s,x_m,y_m,heading_rad\n";
  const std::vector<BadMap> drives{
      {"empty.csv", ""},
      {"no_rows.csv", header},
      {"nan.csv", header + "0,160,nan,0\n1,161,198,0\n"},
      {"backwards.csv", header + "1,160,198,0\n0,161,198,0\n"},
      {"no_heading.csv", "t_s,x_m,y_m\n0,160,198\n"},
  };
  for (const BadMap& drive : drives) {
    SCOPED_TRACE(drive.name);
    const std::string file = folder.write(drive.name, drive.bytes);
    expect_refused(run_roadbed({"audit", "--occupancy", walls, "--trajectory", file}), drive.name);
  }
}

TEST(BadInput, DamagedCompiledMapIsRefusedWhereverItIsCutOrChanged) {
  const TemporaryFolder folder;
  const std::string good = folder / "town.rbm";
  const std::string town = data_folder() / "town.xodr";
  ASSERT_EQ(run_roadbed({"import", town, "-o", good, "--quiet"}).status, 0);
  const std::string bytes = bytes_of(good);
  for (const double fraction : {0.0, 0.001, 0.3, 0.7, 0.999}) {
    SCOPED_TRACE(fraction);
    const auto at = static_cast<std::size_t>(fraction * static_cast<double>(bytes.size()));
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    for (const std::string& damaged : {bytes.substr(0, at), changed}) {
      const std::string file = folder.write("damaged.rbm", damaged);
      expect_refused(run_roadbed({"import", file, "-o", folder / "out.rbm"}), "damaged.rbm");
    }
  }
  EXPECT_EQ(files_below(folder.path()), (std::vector<std::string>{"damaged.rbm", "town.rbm"}));
}

TEST(BadInput, OutputThatCannotBeWrittenIsRefusedBeforeTheWork) {
  const TemporaryFolder folder;
  const std::string town = data_folder() / "town.xodr";
  expect_refused(run_roadbed({"import", town, "-o", folder / "no/such/out.rbm"}), "out.rbm");
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(BadInput, ExistingOutputStaysAsItIsWithoutForce) {
  const TemporaryFolder folder;
  const std::string town = data_folder() / "town.xodr";
  const std::string out = folder.write("out.rbm", "mine");
  expect_refused(run_roadbed({"import", town, "-o", out}), "--force");
  EXPECT_EQ(bytes_of(out), "mine");
  EXPECT_EQ(run_roadbed({"import", town, "-o", out, "--force", "--quiet"}).status, 0);
  EXPECT_NE(bytes_of(out), "mine");
}

TEST(BadInput, WrongUsageHasAStatusOfItsOwn) {
  EXPECT_EQ(run_roadbed({}).status, 2);
  EXPECT_EQ(run_roadbed({"no-such-command"}).status, 2);
  EXPECT_EQ(run_roadbed({"import"}).status, 2);
  EXPECT_EQ(run_roadbed({"import", "--no-such-option"}).status, 2);
}

/// Neither a loop of links nor a name beyond the system's limit can be looked at.
TEST(BadInput, WhatCannotBeLookedAtIsOneLine) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "scenarios");
  for (const char* name : {"loop", "scenarios/loop.json"}) {
    std::filesystem::create_symlink(std::filesystem::path(name).filename(), folder / name);
  }
  const std::string loop = folder / "loop", town = data_folder() / "town.xodr", out = folder / "o";
  const std::string drive =
      folder.write("drive.csv", "t_s,x_m,y_m,heading_rad\n0,0,0,0\n1,9,0,0\n");
  for (const std::string& file : {loop, std::string(5000, 'a')}) {
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"simulate", file, "-o", out},
             {"plan", file, "-o", out},
             {"audit", "--trajectory", file, "--occupancy", town},
             {"audit", "--trajectory", drive, "--occupancy", file},
             {"audit", "--trajectory", drive, "--map", town, "--on", "drivable", "--obstacles",
              file},
             {"report", "drive", file, "-o", out + ".html"},
             {"report", "compare", file, file},
             {"validate", town, "--only", file},
             {"map", "transform", town, "--elevation", file, "-o", out + ".xodr"}}) {
      const ProgramRun run = run_roadbed(words);
      EXPECT_TRUE(run.status == 2 || run.status == 3) << words[0] << " " << run.status << run.err;
      EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err.substr(0, 300);
      EXPECT_EQ(run.err.find("internal error"), std::string::npos) << run.err.substr(0, 300);
    }
  }
  const ProgramRun of_folder = run_roadbed({"simulate", folder / "scenarios", "-o", out});
  EXPECT_EQ(of_folder.status, 1);
  EXPECT_NE(of_folder.out.find("loop.json: no such file"), std::string::npos) << of_folder.out;
}

}  // namespace
}  // namespace roadbed::tests
