// The maps of Autoware's own validator: on each, the issues that its tests expect, and no others of
// the same rule.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/map/validate_file.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map::validation {
namespace {

std::vector<std::string> parts_of(const std::string& text, char between) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, between);) parts.push_back(part);
  return parts;
}

/// What Autoware's rules find in a file, by issue.
std::map<std::string, std::size_t> issues_in(const std::filesystem::path& file) {
  ValidateOptions options;
  options.choice.profile = Profile::autoware;
  std::map<std::string, std::size_t> issues;
  for (const Finding& finding : validate_file(file, options).findings) {
    if (!finding.autoware_issue.empty()) ++issues[finding.autoware_issue];
  }
  return issues;
}

/// The issues of one rule, and how many they are together.
std::pair<std::set<std::string>, std::size_t> of_rule(
    const std::map<std::string, std::size_t>& issues, const std::string& rule) {
  std::set<std::string> names;
  std::size_t count = 0;
  for (const auto& [issue, times] : issues) {
    if (!issue.starts_with(rule + "-")) continue;
    names.insert(issue);
    count += times;
  }
  return {names, count};
}

TEST(AutowareMaps, HaveTheIssuesThatAutowaresTestsExpect) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const auto of_validator = folder / "autoware/tier4+autoware_lanelet2_map_validator";
  std::ifstream table(of_validator / "expected.tsv");
  ASSERT_TRUE(table);
  std::map<std::string, std::map<std::string, std::size_t>> found;
  std::string line;
  std::getline(table, line);  // its head
  std::size_t lines = 0;
  while (std::getline(table, line)) {
    SCOPED_TRACE(line);
    const std::vector<std::string> cells = parts_of(line, '\t');
    ASSERT_EQ(cells.size(), 4u);
    if (!found.contains(cells[0])) found[cells[0]] = issues_in(of_validator / "maps" / cells[0]);
    const auto [names, count] = of_rule(found[cells[0]], cells[1]);
    std::set<std::string> expected;
    if (cells[2] != "none") {
      const auto named = parts_of(cells[2], ';');
      expected.insert(named.begin(), named.end());
    }
    EXPECT_EQ(names, expected);
    if (cells[3] != "?") {
      EXPECT_EQ(count, std::stoul(cells[3]));
    }
    ++lines;
  }
  EXPECT_EQ(lines, 121u);
}

TEST(AutowareMaps, OfAutowareItselfHaveTheIssuesThatAReaderAgreesWith) {
  // Maps that are older than most requirements. Each issue was looked up in the file: speed limits
  // of 60 and 70 km/h, turns without an area, lights whose bulbs name other lights, borders that
  // lie on each other as two ways, … All other rules have nothing to say.
  const std::map<std::string, std::set<std::string>> agreed = {
      {"2km_test.osm",
       {"Lane.CenterlineGeometry-001", "Lane.LaneChangeAttribute-001",
        "Lane.SpeedLimitValidity-002"}},
      {"intersection.osm",
       {"Crosswalk.MissingRegulatoryElements-001", "Intersection.IntersectionAreaSegmentType-001",
        "Intersection.IntersectionAreaTagging-001", "Intersection.IntersectionAreaTagging-004",
        "Intersection.RightOfWayWithTrafficLights-001",
        "Intersection.RightOfWayWithTrafficLights-004",
        "Intersection.RightOfWayWithTrafficLights-005",
        "Intersection.RightOfWayWithTrafficLights-006",
        "Intersection.RightOfWayWithoutTrafficLights-005", "Lane.BorderSharing-001",
        "Lane.BorderSharing-002", "Lane.LaneChangeAttribute-001", "Lane.RoadShoulder-003",
        "Lane.SpeedLimitValidity-002", "StopLine.MissingRegulatoryElements-001",
        "TrafficLight.LightBulbTagging-003", "TrafficLight.RegulatoryElementDetails-005",
        "TrafficLight.RegulatoryElementDetails-007"}},
      {"road_shoulder.osm",
       {"Intersection.IntersectionAreaTagging-004", "Intersection.TurnSignalDistanceOverlap-001",
        "Lane.BorderSharing-002", "Lane.LaneChangeAttribute-001", "Lane.LaneletGeometry-001",
        "Lane.RoadShoulder-003", "Lane.SpeedLimitValidity-002"}},
      {"vm_03_left_hand.osm",
       {"Area.BufferZoneValidity-001", "Crosswalk.MissingRegulatoryElements-001",
        "Intersection.IntersectionAreaSegmentType-001", "Intersection.IntersectionAreaTagging-001",
        "Intersection.IntersectionAreaTagging-004", "Intersection.RightOfWayWithTrafficLights-001",
        "Intersection.RightOfWayWithTrafficLights-004", "Intersection.TurnDirectionTagging-001",
        "Lane.LaneChangeAttribute-001", "Lane.RoadShoulder-003", "Lane.SpeedLimitValidity-002",
        "StopLine.MissingRegulatoryElements-001", "TrafficLight.LightBulbTagging-003",
        "TrafficLight.RegulatoryElementDetails-005", "TrafficLight.RegulatoryElementDetails-007"}},
  };
  ROADBED_REAL_DATA_OR_SKIP(folder);
  for (const auto& [name, expected] : agreed) {
    SCOPED_TRACE(name);
    std::set<std::string> found;
    for (const auto& [issue, times] :
         issues_in(folder / "lanelet2/autowarefoundation+autoware_core" / name)) {
      found.insert(issue);
    }
    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace roadbed::map::validation
