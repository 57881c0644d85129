#pragma once

#include <string>
#include <vector>

namespace roadbed::tests {

/// A lane segment of a made map, straight along x.
struct MadeSegment {
  int id = 1;
  double from_x_m = 0.0, to_x_m = 10.0, left_y_m = 3.0, right_y_m = 0.0;
  std::string type = "VEHICLE", left_mark = "NONE", right_mark = "NONE";
  std::string successors = "", predecessors = "";  ///< ids, commas between
  std::string left = "null", right = "null";
  std::string inside = "false";
  std::string z = R"(,"z":1.5)";  ///< of all points, with its comma
};

/// An Argoverse 2 map of these lane segments, and what else stands in its object.
std::string made_argoverse(const std::vector<MadeSegment>& segments, const std::string& more = "");

}  // namespace roadbed::tests
