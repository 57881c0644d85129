#include "roadbed/map/argoverse/words.h"

#include <algorithm>
#include <array>
#include <string>

namespace roadbed::map::argoverse {
namespace {

/// How a border is painted, by the side of the lane that it is on.
struct Paint {
  std::string_view word;
  MarkType on_left, on_right;
};

constexpr std::array<Paint, 6> kPaints = {{
    {"SOLID", MarkType::solid, MarkType::solid},
    {"DASHED", MarkType::broken, MarkType::broken},
    {"DOUBLE_SOLID", MarkType::solid_solid, MarkType::solid_solid},
    {"DOUBLE_DASH", MarkType::broken_broken, MarkType::broken_broken},
    {"SOLID_DASH", MarkType::broken_solid, MarkType::solid_broken},
    {"DASH_SOLID", MarkType::solid_broken, MarkType::broken_solid},
}};

std::string color_of(std::string_view word) {
  if (word == "WHITE") return "white";
  if (word == "YELLOW") return "yellow";
  return word == "BLUE" ? "blue" : "";
}

}  // namespace

std::optional<LaneUse> lane_use(std::string_view word) {
  if (word == "VEHICLE") return LaneUse{LaneType::driving, Participants::vehicles()};
  if (word == "BIKE") return LaneUse{LaneType::biking, {Participant::bicycle}};
  if (word == "BUS") return LaneUse{LaneType::bus, {Participant::bus, Participant::emergency}};
  return {};
}

std::optional<BorderMark> border_mark(std::string_view word, Side side) {
  BorderMark mark;
  if (word == "NONE") return mark;
  const std::size_t last = word.rfind('_');
  if (last == std::string_view::npos) return {};
  const auto* paint = std::ranges::find(kPaints, word.substr(0, last), &Paint::word);
  mark.color = color_of(word.substr(last + 1));
  if (paint == kPaints.end() || mark.color.empty()) return {};
  mark.type = side == Side::left ? paint->on_left : paint->on_right;
  return mark;
}

}  // namespace roadbed::map::argoverse
