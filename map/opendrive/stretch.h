#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// A value that holds along part of a road, from one station to another.
template <typename Value>
struct Stretch {
  double from_s_m = 0.0, to_s_m = 0.0;
  Value value{};
};

/// What records say along [from, to] of the road: the last one that begins at or before a station
/// holds, before the first one `without` does. Neighbouring equal values are one stretch.
/// @param records  in order of `s_m`; of those at the same station the last one holds.
/// @param value_of  of a record.
/// O(log N + records inside).
template <typename Record, typename Value, typename ValueOf>
std::vector<Stretch<Value>> stretches(const std::vector<Record>& records, double from_s_m,
                                      double to_s_m, const Value& without,
                                      const ValueOf& value_of) {
  std::vector<Stretch<Value>> found;
  const auto add = [&](double s_m, Value value) {
    if (!found.empty() && found.back().from_s_m >= s_m) found.pop_back();
    if (!found.empty() && found.back().value == value) return;
    found.push_back({s_m, to_s_m, std::move(value)});
  };
  auto record = std::upper_bound(records.begin(), records.end(), from_s_m,
                                 [](double s_m, const Record& r) { return s_m < r.s_m; });
  add(from_s_m, record == records.begin() ? without : value_of(*(record - 1)));
  for (; record != records.end() && record->s_m < to_s_m; ++record) {
    add(record->s_m, value_of(*record));
  }
  for (std::size_t i = 0; i + 1 < found.size(); ++i) found[i].to_s_m = found[i + 1].from_s_m;
  return found;
}

/// A lane's speed limit by road station: its own where it has one, else that of the road.
std::vector<Stretch<std::optional<double>>> speed_stretches(const RoadRecord& road,
                                                            const LaneRecord& lane, double from_s_m,
                                                            double to_s_m);

/// Who may use all of a lane: what its type says, narrowed or widened by its <access> records. At
/// one station "allow" lets in those named and nobody else, then "deny" keeps those named out.
Participants participants_along(const LaneRecord& lane);

/// The <access> records in words, by road station, "0 deny truck, 50 allow bus": they may name what
/// is no road user (autonomousTraffic, delivery) or change along the lane.
std::string access_in_words(const LaneRecord& lane);

/// The same marking from the other side, or seen against the road: double lines change places.
MarkType mirrored(MarkType type);

/// Markings of a lane's outer border (lane 0: of the middle) as lines follow each other from left
/// to right, seen along the road.
std::vector<Stretch<BorderMark>> border_marks(const LaneRecord& lane, double from_s_m,
                                              double to_s_m);

/// Where a lane's outer marking (lane 0: the one in the middle) may be crossed towards larger lane
/// ids, or smaller ones.
std::vector<Stretch<bool>> crossings(const LaneRecord& lane, bool to_larger_id, double from_s_m,
                                     double to_s_m);

}  // namespace roadbed::map::opendrive
