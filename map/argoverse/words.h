#pragma once

#include <optional>
#include <string_view>

#include "roadbed/map/elements/border_mark.h"
#include "roadbed/map/elements/lane.h"
#include "roadbed/map/elements/participants.h"
#include "roadbed/map/elements/side.h"

/// Words of Argoverse 2 maps and what they mean here.
namespace roadbed::map::argoverse {

/// What a `lane_type` says; none if the word is not known.
struct LaneUse {
  LaneType type;
  Participants participants;
};
std::optional<LaneUse> lane_use(std::string_view word);

/// A `left_lane_mark_type` or `right_lane_mark_type`: none for UNKNOWN and for words that are not
/// known. Of two lines the word names that of the lane's own side first.
std::optional<BorderMark> border_mark(std::string_view word, Side side);

}  // namespace roadbed::map::argoverse
