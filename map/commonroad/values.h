#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/elements/border_mark.h"
#include "roadbed/map/elements/lane.h"
#include "roadbed/map/elements/participants.h"

/// Words of CommonRoad (XML formats 2018b and 2020a) and what they mean here.
namespace roadbed::map::commonroad {

/// `lineMarking`: none if the word says nothing ("unknown") or is not known.
std::optional<BorderMark> border_mark(std::string_view word);

/// The `lineMarking` of a mark; "unknown" where CommonRoad has no word for it.
std::string_view marking_word(const BorderMark& mark);

/// Who a `userOneWay` or `userBidirectional` is; empty if the word is not known.
Participants users(std::string_view word);

/// The fewest words that name these users, in the order of CommonRoad's documentation.
std::vector<std::string_view> user_words(Participants users);

/// What a lane is for, from its `laneletType`s and the users that it names (empty: none named).
LaneType lane_type(const std::vector<std::string>& type_words, Participants named_users);

/// Who may use a lane of that type where the file does not say.
Participants default_users(LaneType type);

/// The `laneletType` of a lane type; "unknown" where CommonRoad has no word for it.
std::string_view type_word(LaneType type);

/// "DEU" of the benchmark id "DEU_Flensburg-35_1_T-1" or "C-DEU_…"; empty if there is none.
std::string country_of(std::string_view benchmark_id);

/// Whether a `trafficSignID` is a speed limit in that country. Older files write Germany's number
/// everywhere.
bool is_speed_limit(std::string_view country, std::string_view sign_id);

/// A country by its two or three letters, as CommonRoad names it ("DEU"); empty if CommonRoad has
/// no signs of it.
std::string known_country(std::string_view code);

/// The `trafficSignID` of a speed limit in that country.
std::string_view speed_limit_id(std::string_view country);

}  // namespace roadbed::map::commonroad
