// What is wrong with maps made by others: errors and warnings by rule, several of each looked up in
// the files. A finding that is no fault of its file is a fault of the rule.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "roadbed/map/validate_file.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map::validation {
namespace {

/// "geometry.gap 2, link.self 1": how often each rule finds an error or a warning in these files.
std::string faults_of(const std::vector<std::filesystem::path>& files) {
  std::map<std::string, int> count;
  for (const auto& file : files) {
    for (const Finding& finding : validate_file(file).findings) {
      if (finding.severity != Severity::info) ++count[finding.rule];
    }
  }
  std::string text;
  for (const auto& [rule, times] : count) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", rule, times);
  }
  return text;
}

struct Read {
  std::string file, faults;
};

// Kinks: both borders turn, too. Slopes that jump and bends that are tight are measured in the
// files' own points. The rest of what is looked at is named in its line.
const std::vector<Read> kLanelet2 = {
    {"autowarefoundation+autoware_core/2km_test.osm", ""},
    {"autowarefoundation+autoware_core/intersection.osm", "geometry.kink 10"},
    // A border that steps back 5 cm at lanelet 6309; nodes 12097, 11927, 12253 beside others.
    {"autowarefoundation+autoware_core/road_shoulder.osm",
     "geometry.fold 1, geometry.kink 5, geometry.tight-bend 11, lanelet2.unshared-border 3"},
    {"autowarefoundation+autoware_core/vm_03_left_hand.osm",
     "geometry.kink 1, lanelet2.short-way 1"},
    {"fzi-forschungszentrum-informatik+Lanelet2/mapping_example.osm",
     "geometry.kink 35, geometry.self-intersection 1, geometry.tight-bend 1, "
     "lanelet2.unshared-border 1, lanelet2.unused-regulation 1"},
};

const std::vector<Read> kOpenDrive = {
    {"BerkeleyLearnVerify+Scenic/Town01.xodr", ""},
    {"BerkeleyLearnVerify+Scenic/Town04.xodr", ""},
    {"BerkeleyLearnVerify+Scenic/Town10HD.xodr", ""},
    {"esmini+esmini/curves_elevation.xodr", ""},
    {"esmini+esmini/direct_junction_simple.xodr", ""},
    {"esmini+esmini/fabriksgatan_traffic_lights.xodr", ""},
    // Connections name lanes that lead out of the junction as well.
    {"esmini+esmini/highway_example_with_merge_and_split.xodr", "junction.outgoing-lane-link 12"},
    {"esmini+esmini/lane_width_and_offset.xodr", "link.zero-width-start 1"},
    // Eleven signals have the id 0.
    {"esmini+esmini/multi_intersections.xodr",
     "geometry.gap 2, id.duplicate 11, link.lane-one-sided 2"},
    // Road 7 is linked as if it lay between roads 2 and 1, but lies elsewhere.
    {"esmini+esmini/soderleden.xodr",
     "link.ambiguous 2, link.contact-point-off 2, link.lane-one-sided 3, link.road-one-sided 2, "
     "link.zero-width-end 1"},
    {"esmini+esmini/two_plus_one.xodr", ""},
    {"esmini+esmini/velodrome.xodr", ""},
    // Arcs of 4 m radius joined to lines that are metres off.
    {"huawei-noah+SMARTS/od_newmarket.xodr",
     "curve.gap 42, elevation.slope-jump 38, elevation.steep 12, elevation.step 1, "
     "geometry.elevation-step 20, geometry.fold 14, geometry.gap 142, geometry.kink 7, "
     "geometry.self-intersection 4, geometry.slope-jump 34, geometry.tight-bend 101, "
     "id.dangling-connection 3, id.dangling-road-link 1, link.dead-end 3, link.unreachable 3"},
    // Turns with a lane offset of 3.2 m that the roads which they join do not have.
    {"ivsg-psu+PathPlanning_MapTools_ParseXODR/WBeaverAve.xodr",
     "curve.kink 100, curve.param-poly3-length 317, curve.road-length 2, curve.zero-length 1, "
     "geometry.fold 11, geometry.gap 280, geometry.kink 10, geometry.tight-bend 24, "
     "id.dangling-road-link 4, import.link 1, link.reversed 3, signal.validity-unknown 14"},
    {"maliput+maliput_malidrive/Figure8.xodr", ""},
    {"maliput+maliput_malidrive/GapInLaneWidthDrivableLane.xodr", "width.step 1"},
    {"maliput+maliput_malidrive/ParametricCubicCurveComplexRoad.xodr",
     "curve.param-poly3-start 4, geometry.fold 4"},
    {"maliput+maliput_malidrive/RoadWithStopLine.xodr", ""},
    {"maliput+maliput_malidrive/Roundabout.xodr", ""},
    {"maliput+maliput_malidrive/SShapeSuperelevatedRoad.xodr", ""},
    {"maliput+maliput_malidrive/SingleRoadNanValues.xodr",
     "elevation.step 1, import.refused 1, schema.not-a-number 26"},
    {"maliput+maliput_malidrive/SingleRoadNegativeWidth.xodr", "width.negative 1"},
    {"maliput+maliput_malidrive/SingleRoadTinyGeometry.xodr", ""},
    {"maliput+maliput_malidrive/TwoRoadsWithTrafficLights.xodr", ""},
    // Road 29 names road 28 before it, whose end is linked to a junction.
    {"maliput+maliput_malidrive/cloverleaf.xodr",
     "elevation.slope-jump 1, link.lane-one-sided 11, link.road-one-sided 1"},
};

// Lanes in intersections that no lane of the file leads to, nor any outside.
const std::vector<Read> kArgoverse = {
    {"log_map_archive_0a1e6f0a-1817-4a98-b02e-db8c9327d151.json", "geometry.kink 3"},
    {"log_map_archive_adcf7d18-0510-35b0-a2fa-b4cea13a6d76____PIT_city_57819.json",
     "geometry.kink 23, link.unreachable 6"},
    {"7fab2350/map/log_map_archive_7fab2350-7eaf-3b7e-a39d-6937a4c1bede____PIT_city_47896.json",
     "geometry.kink 22, geometry.slope-jump 5, geometry.tight-bend 5"},
};

void expect_read(const std::filesystem::path& folder, const std::vector<Read>& maps) {
  for (const Read& read : maps)
    EXPECT_EQ(faults_of({folder / read.file}), read.faults) << read.file;
}

TEST(RealMaps, Lanelet2HasTheFaultsThatWereReadInItsFiles) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  expect_read(folder / "lanelet2", kLanelet2);
}

TEST(RealMaps, OpenDriveHasTheFaultsThatWereReadInItsFiles) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  expect_read(folder / "opendrive", kOpenDrive);
}

TEST(RealMaps, ArgoverseHasTheFaultsThatWereReadInItsFiles) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  expect_read(folder / "argoverse2/argoverse+av2-api", kArgoverse);
}

// Thirty scenarios, cut from larger maps: lanes that lead into their intersection and end there,
// neighbours of BEL_Putte-3 that are 2.4 m apart.
TEST(RealMaps, CommonRoadHasTheFaultsThatWereReadInItsFiles) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(
           folder / "commonroad/CommonRoad+commonroad-reachable-set")) {
    if (entry.path().extension() == ".xml") files.push_back(entry.path());
  }
  EXPECT_EQ(faults_of(files),
            "geometry.fold 19, geometry.kink 7, geometry.tight-bend 16, link.dead-end 17, "
            "neighbour.apart 8");
}

}  // namespace
}  // namespace roadbed::map::validation
