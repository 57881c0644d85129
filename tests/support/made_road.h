#pragma once

#include <filesystem>
#include <string>

#include "roadbed/map/model/road_map.h"

namespace roadbed::tests {

/// One made road of OpenDRIVE, in pieces of XML that a test replaces: straight along x from the
/// origin, 100 m long, 3.5 m driving lanes 1 and −1, unless it says otherwise.
struct MadeRoad {
  std::string id = "A";
  double length_m = 100.0;
  std::string attributes;  ///< more of <road>: rule="LHT"
  std::string link;        ///< children of <link>
  std::string type;        ///< <type> elements
  std::string plan_view;   ///< <geometry> elements; empty: the straight line
  std::string elevation;   ///< <elevation> elements
  std::string lateral;     ///< children of <lateralProfile>
  std::string lanes;       ///< children of <lanes>; empty: one section of lanes 1 and −1
  std::string rest;        ///< <objects>, <signals>
  double x_m = 0.0;        ///< where the straight line begins
};

/// The road's XML.
std::string made_road(const MadeRoad& road);

/// A lane of constant width. @param inside  more children: marks, speeds, link.
std::string made_lane(int id, const std::string& inside = {}, const std::string& type = "driving",
                      double width_m = 3.5);

/// A section. @param middle  children of lane 0.
std::string made_section(double s_m, const std::string& left, const std::string& right,
                         const std::string& middle = {}, const std::string& attributes = {});

/// A whole document around roads and junctions, read. @param header  children of <header>.
map::RoadMap made_map(const std::string& body, const std::string& header = {});
std::string made_document(const std::string& body, const std::string& header = {});

/// A file of one road in the tests' temporary folder, of this process.
std::filesystem::path made_file(const std::string& name, const MadeRoad& road);

/// The lane of that name. @throws std::bad_optional_access if there is none.
const map::Lane& lane_of(const map::RoadMap& road_map, const std::string& name);

/// Names of a lane's successors.
std::vector<std::string> successors_of(const map::RoadMap& road_map, const std::string& name);

/// Messages of all remarks of a rule.
std::vector<std::string> remarks_of(const map::RoadMap& road_map, const std::string& rule);

}  // namespace roadbed::tests
