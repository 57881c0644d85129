#include <algorithm>
#include <array>
#include <string_view>

#include "roadbed/map/opendrive/element_readers.h"
#include "roadbed/map/opendrive/stretch.h"

namespace roadbed::map::opendrive {
namespace {

MarkType mark_type(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, MarkType>, 12> words = {{
      {"", MarkType::none},
      {"none", MarkType::none},
      {"solid", MarkType::solid},
      {"broken", MarkType::broken},
      {"solid solid", MarkType::solid_solid},
      {"solid broken", MarkType::solid_broken},
      {"broken solid", MarkType::broken_solid},
      {"broken broken", MarkType::broken_broken},
      {"botts dots", MarkType::botts_dots},
      {"curb", MarkType::curb},
      {"grass", MarkType::grass},
      {"edge", MarkType::edge},
  }};
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.first == word; });
  return found == words.end() ? MarkType::other : found->second;
}

bool is_open(MarkType type) {
  return type == MarkType::none || type == MarkType::broken || type == MarkType::broken_broken ||
         type == MarkType::botts_dots;
}

void allow_by_type(RoadMark& mark) {
  // Lines are named from inside to outside, those of lane 0 from left to right: whoever crosses
  // outwards drives beside the first one.
  mark.outwards = is_open(mark.type) || mark.type == MarkType::broken_solid;
  mark.inwards = is_open(mark.type) || mark.type == MarkType::solid_broken;
}

void allow_by_word(std::string_view lane_change, int lane_id, RoadMark& mark) {
  const bool increase = lane_change == "both" || lane_change == "increase";
  const bool decrease = lane_change == "both" || lane_change == "decrease";
  mark.outwards = lane_id > 0 ? increase : decrease;
  mark.inwards = lane_id > 0 ? decrease : increase;
}

}  // namespace

RoadMark read_mark(const XmlDocument& xml, pugi::xml_node node, int lane_id, double s_m) {
  RoadMark mark;
  mark.s_m = s_m;
  mark.type = mark_type(node.attribute("type").value());
  const std::string_view lane_change = node.attribute("laneChange").value();
  if (lane_change.empty()) {
    allow_by_type(mark);
  } else {
    allow_by_word(lane_change, lane_id, mark);
  }
  mark.color = node.attribute("color").value();
  const auto width = xml.optional_number(node, "width");
  mark.width_m = width ? *width : xml.optional_number(node.child("type"), "width").value_or(0.0);
  return mark;
}

MarkType mirrored(MarkType type) {
  if (type == MarkType::solid_broken) return MarkType::broken_solid;
  if (type == MarkType::broken_solid) return MarkType::solid_broken;
  return type;
}

std::vector<Stretch<BorderMark>> border_marks(const LaneRecord& lane, double from_s_m,
                                              double to_s_m) {
  if (lane.marks.empty()) return {};
  // Left of the middle the inner line is the right one.
  const bool turn = lane.id > 0;
  return stretches(lane.marks, from_s_m, to_s_m, BorderMark{}, [&](const RoadMark& mark) {
    return BorderMark{0.0, turn ? mirrored(mark.type) : mark.type, mark.color, mark.width_m};
  });
}

std::vector<Stretch<bool>> crossings(const LaneRecord& lane, bool to_larger_id, double from_s_m,
                                     double to_s_m) {
  const bool outwards = (lane.id > 0) == to_larger_id;
  return stretches(lane.marks, from_s_m, to_s_m, true,
                   [&](const RoadMark& mark) { return outwards ? mark.outwards : mark.inwards; });
}

}  // namespace roadbed::map::opendrive
