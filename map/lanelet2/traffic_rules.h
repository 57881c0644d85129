#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "roadbed/map/elements/attributes.h"
#include "roadbed/map/elements/border_mark.h"
#include "roadbed/map/elements/lane.h"
#include "roadbed/map/elements/participants.h"
#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::lanelet2 {

/// Who may use a lanelet or area: its `participant:*` tags if it has any, else what its subtype
/// means (Lanelet2, LaneletAndAreaTagging).
Participants participants(Tags tags);

/// Whether it is used in one direction only, by the kind of road user it is mainly for: its
/// `one_way*` tags; without any, only ways for pedestrians are open in both.
bool is_one_way(Tags tags, const Participants& users);

/// The lane type that a subtype and its users come nearest to.
LaneType lane_type(std::string_view subtype, const Participants& users);

/// Which way a line may be crossed, seen in its own direction.
struct CrossingRule {
  bool to_left = false, to_right = false;
};

/// By the line's `lane_change*` tags, else by its type: for vehicles and bicycles a dashed line, on
/// its dashed side, for bicycles and pedestrians also a low curbstone.
CrossingRule crossing_rule(Tags line_tags, const Participants& users);

/// What is painted or built along a line, seen against its direction if `reversed`; none if the
/// file does not say.
std::optional<BorderMark> border_mark(Tags line_tags, bool reversed);

/// "50", "50 km/h", "30 mph", "10 m/s" in m/s; a bare number is in km/h.
std::optional<double> speed_mps(std::string_view text);

/// The speed that a traffic sign's code limits to (Germany's 274 and 310), or a plain speed.
std::optional<double> sign_speed_mps(std::string_view code);

/// The limit that `speed_limit*` tags give to cars, or to those whom the lanelet is for.
std::optional<double> tagged_speed_mps(Tags tags, const Participants& users);

/// Value of a key; empty if it is missing.
std::string_view value_of(Tags tags, std::string_view key);

/// yes/true/1 or no/false/0; none for everything else.
std::optional<bool> truth_of(std::string_view value);

}  // namespace roadbed::map::lanelet2
