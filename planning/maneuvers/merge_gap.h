#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace roadbed::planning::inline maneuvers {

/// Somebody in the lane that is merged into.
struct MergeMover {
  std::size_t obstacle = 0;  ///< index
  double behind_m = 0.0;     ///< of its centre to the vehicle's front; less than 0: it is ahead
  double half_length_m = 0.0;
  double speed_mps = 0.0;
};

/// The vehicle before the places where it may merge.
struct MergingVehicle {
  std::vector<double> to_enter_m = {};  ///< of its front bumper, to each of them, at least one
  double length_m = 4.5;
  double speed_mps = 0.0;
  double free_mps = 0.0;                                      ///< at most, up to there
  double within_s = std::numeric_limits<double>::infinity();  ///< a gap that comes later is none
  double bears_m = 2.0;  ///< that may be missing of a gap that was taken, before it is given up
};

/// The gap between two who follow on one another, or before the first, or behind the last.
struct MergeGap {
  std::optional<std::size_t> ahead = {}, behind = {};  ///< obstacles; none: nobody
  double speed_mps = 0.0;   ///< to drive at for now; that of the free road if nothing hinders
  double to_enter_m = 0.0;  ///< of the front bumper, to the merging point
  double after_s = 0.0;     ///< until there
  double missing_m = 0.0;   ///< room that there is too little, ahead and behind together
  bool is_good = false;     ///< nothing is missing; or little, of a gap that was taken
  bool lacks_ahead = false, lacks_behind = false;
};

/// Room bumper to bumper that merging behind somebody takes: 1 m, half a second, and what braking
/// from a greater speed by 1.5 m/s² takes.
double room_ahead_m(double own_mps, double ahead_mps);

/// Room before somebody who then has to brake by 2 m/s² at most, as drivers do (Improved
/// Intelligent Driver Model with a headway of 1.2 s; the safety criterion of MOBIL, Kesting,
/// Treiber and Helbing 2007, doi:10.3141/1999-10).
double room_behind_m(double own_mps, double behind_mps);

/// The gap that comes first, each m/s that is lost by then counted as 0.3 s. Everybody keeps the
/// speed of now; the vehicle changes its speed by +0.9 or −1.5 m/s², keeps it, and then takes on
/// that of the gap up to the merging point, braking by 0.8 m/s² at most. A gap that was taken
/// stays, as long as it can be had. If none is safe, the one in which the fewest metres are
/// missing. O(places · speeds · gaps).
/// @param movers  by behind_m, the foremost first.
MergeGap choose_merge_gap(const MergingVehicle& vehicle, const std::vector<MergeMover>& movers,
                          const std::optional<MergeGap>& taken);

}  // namespace roadbed::planning::maneuvers
