#pragma once

#include <string>
#include <string_view>

namespace roadbed::planning::inline behaviour {

/// What the decision layer does; few and readable.
enum class Behaviour {
  cruise,     ///< the road ahead is free: hold the set speed
  pass,       ///< beside the reference line, because something stands or moves on it
  follow,     ///< behind a lead
  yield,      ///< waits at a light or sign, or for those who have the right of way
  stop,       ///< comes to rest: at the goal, because no candidate is left, or the road is blocked
  emergency,  ///< the safety layer brakes harder than the cruise control may
};
inline std::string_view to_string(Behaviour behaviour) {
  switch (behaviour) {
    case Behaviour::cruise:
      return "cruise";
    case Behaviour::pass:
      return "pass";
    case Behaviour::follow:
      return "follow";
    case Behaviour::yield:
      return "yield";
    case Behaviour::stop:
      return "stop";
    case Behaviour::emergency:
      return "emergency";
  }
  return "";
}

/// The vehicle ahead that the cruise control follows.
struct DriveLead {
  std::string id;
  double gap_m = 0.0;  ///< true, bumper to bumper along the path
  double speed_mps = 0.0;
};

}  // namespace roadbed::planning::behaviour
