#include "roadbed/tests/support/made_argoverse.h"

#include <fmt/format.h>

namespace roadbed::tests {
namespace {

std::string line(const MadeSegment& segment, double y_m) {
  return fmt::format(R"([{{"x":{0},"y":{2}{3}}},{{"x":{1},"y":{2}{3}}}])", segment.from_x_m,
                     segment.to_x_m, y_m, segment.z);
}

std::string text_of(const MadeSegment& segment) {
  return fmt::format(
      R"("{0}":{{"id":{0},"is_intersection":{1},"lane_type":"{2}","left_lane_boundary":{3},)"
      R"("left_lane_mark_type":"{4}","right_lane_boundary":{5},"right_lane_mark_type":"{6}",)"
      R"("successors":[{7}],"predecessors":[{8}],"left_neighbor_id":{9},"right_neighbor_id":{10}}})",
      segment.id, segment.inside, segment.type, line(segment, segment.left_y_m), segment.left_mark,
      line(segment, segment.right_y_m), segment.right_mark, segment.successors,
      segment.predecessors, segment.left, segment.right);
}

}  // namespace

std::string made_argoverse(const std::vector<MadeSegment>& segments, const std::string& more) {
  std::string list;
  for (const MadeSegment& segment : segments) list += (list.empty() ? "" : ",") + text_of(segment);
  return R"({"lane_segments":{)" + list + "}" + more + "}";
}

}  // namespace roadbed::tests
