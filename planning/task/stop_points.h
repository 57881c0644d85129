#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/route/route.h"

namespace roadbed::planning::inline task {

enum class LightColour { green, yellow, red };
inline std::string_view to_string(LightColour colour) {
  switch (colour) {
    case LightColour::green:
      return "green";
    case LightColour::yellow:
      return "yellow";
    case LightColour::red:
      return "red";
  }
  return "";
}

/// None for any other word.
inline std::optional<LightColour> light_colour(std::string_view word) {
  for (const LightColour colour : {LightColour::green, LightColour::yellow, LightColour::red}) {
    if (word == to_string(colour)) return colour;
  }
  return std::nullopt;
}

struct LightPhase {
  LightColour colour = LightColour::red;
  double duration_s = 0.0;  ///< positive
};

/// Signals that show the same, and what they show: phase after phase, over and over.
struct LightCycle {
  std::vector<std::string> signals;  ///< source ids of the map's signals
  std::string pointer;               ///< JSON pointer of the light in its file
  double offset_s = 0.0;             ///< the first phase begins then
  std::vector<LightPhase> phases;    ///< at least one
};

/// What a light shows at a time.
LightColour colour_at(const LightCycle& light, double t_s);

enum class StopKind {
  light,      ///< of the scenario
  stop_sign,  ///< come to rest, then as give_way
  give_way,   ///< to everybody whose way crosses
  turn,       ///< across the lane of oncoming traffic
};

/// A place on a reference line before which the vehicle may have to wait, and for what.
struct StopPoint {
  StopKind kind = StopKind::give_way;
  double s_m = 0.0;        ///< station that the front bumper does not pass while waiting
  double clear_s_m = 0.0;  ///< station at which the rear bumper has left what is crossed
  std::string name;        ///< "light 4"
  std::optional<std::size_t> light = {};  ///< index in the scenario's; of kind light only
};

/// All places on a route, by station, as far as the map says so:
/// - signals that change, if the scenario says what they show; at their stop line if they have one;
///   several at one line are several places, and all have to be green;
/// - signs "stop" and "give way" (German 206 and 205, R1-1 and R1-2 of the Vienna convention's
///   American counterpart), and regulations "right_of_way" by which a lane yields;
/// - joins of two lanes at which the route's one gives way (lane_join.h): ramps;
/// - turns in a junction, where they cross the lane of oncoming traffic: to the
///   left where one drives on the right, to the right where one drives on the left.
/// O(legs · rules of a lane), and the map's conflicts once if there is a turn.
std::vector<StopPoint> stop_points(const map::RoadMap& road_map, const Route& route,
                                   const ReferenceLine& line, std::span<const LightCycle> lights);

}  // namespace roadbed::planning::task
