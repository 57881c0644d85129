#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "roadbed/planning/speed/st_picture.h"

namespace roadbed::planning::inline behaviour {

/// What a hypothesis does to those who are in the way.
enum class Maneuver {
  keep_lane,         ///< as the lateral planner chooses among all its candidates
  pass_within_lane,  ///< the same at the speed of the free road, past somebody slower
  pass_in_lane,      ///< past slower traffic, in the next lane of the own direction
  overtake,          ///< the same through the lane of oncoming traffic
  merge,             ///< along the next lane, from the own one into a gap there
  beside,            ///< the path ends beside the line, or on another line
};
inline std::string_view to_string(Maneuver maneuver) {
  switch (maneuver) {
    case Maneuver::keep_lane:
      return "keep lane";
    case Maneuver::pass_within_lane:
      return "pass within the lane";
    case Maneuver::pass_in_lane:
      return "pass in the next lane";
    case Maneuver::overtake:
      return "overtake";
    case Maneuver::merge:
      return "merge";
    case Maneuver::beside:
      return "beside";
  }
  return "";
}

/// What became of a hypothesis of one cycle. Of those that are asked for one after the other none
/// is left once one is good, so what would have been asked for after that one is not among them.
struct HypothesisOutcome {
  Maneuver maneuver = Maneuver::keep_lane;
  std::optional<double> end_d_m = {}, end_l_m = {};  ///< of its path; none where there is none
  std::optional<double> path_cost = {};              ///< of the candidate (eq. 12)
  std::optional<double> drive_cost = {};  ///< of what the search found; the cruise law has none
  bool is_driven = false;
  std::string reason = {};  ///< why it is not driven; empty for the one that is
  StPicture st = {};        ///< what it was judged by; empty where no path was asked for
};

}  // namespace roadbed::planning::behaviour
