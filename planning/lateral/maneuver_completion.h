#pragma once

#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/lateral/candidates.h"
#include "roadbed/planning/lateral/collision.h"
#include "roadbed/planning/lateral/planned_speed.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline lateral {

/// A stretch of the line that some candidates may be on, or go on along later.
struct LineStretch {
  geometry::Rectangle cover;  ///< holds the body of each of them that is on it
  double from_t_s;            ///< nobody is there before
};

/// A path beside a line: d, d′ and d″ at a station of it; may be empty.
using LateralPath = std::function<LateralState(double s_m)>;

/// A path, and where and when it is driven from.
struct DrivenPath {
  const LineView& line;
  const LateralPath& path;
  const geometry::VehicleShape& vehicle;
  double start_s_m = 0.0, start_t_s = 0.0;
};

/// The drive along a path at a constant deceleration; from its stop it stands for `until_s` after
/// the start, or longer. A sample every 0.05 s.
geometry::Trajectory stopping_drive(const DrivenPath& driven, double speed_mps,
                                    double deceleration_mps2, double until_s);

/// Between samples of passing_drive(), along the line.
inline constexpr double kPassStep_m = 1.0;

/// The drive along a path up to a station, at a planned speed by the length driven; its last sample
/// is the first one over `until_s` after the start. A sample every kPassStep_m of the line.
geometry::Trajectory passing_drive(const DrivenPath& driven, const PlannedSpeed& speed,
                                   double end_s_m, double until_s);

/// Whether a maneuver that a candidate begins among moving traffic can be completed: the candidate
/// looks ahead only as far as it reaches, and overtaking takes longer. An end offset has a
/// fail-safe continuation if, over `horizon_s`, one of these keeps clear of everything that moves:
///   - a stop along the path to that offset,
///   - passing: that path, on at the offset to one of four stations, then back to the line.
///
///     d ▲      ╭───────────────────╮   on to such a station
///       │     ╱   back over 30 m    ╲
///     ──●────╯─────────────────────────╰────── ▶ s
///
/// The offset is reached at the next multiple of 5 m of the line's station, and left at a multiple
/// of 20 m: what was a continuation in one cycle is still among those that are looked at in the
/// next. To begin, two such multiples in a row have to do, so that there is a way back all the
/// while between them; what the last plan led to already is gone on with for one. What happens
/// after the return is a matter of speed, as behind any vehicle; what is behind the vehicle now
/// keeps its own distance.
class ManeuverCompletion {
 public:
  struct Options {
    double horizon_s, deceleration_mps2, clearance_m, recovery_m;
    int circles;
  };

  /// Standing obstacles of the scene are left out: the way round them is not decided yet.
  /// @param context, vehicle  kept by reference.
  ManeuverCompletion(const CycleContext& context, const CollisionScene& scene,
                     const geometry::VehicleShape& vehicle, const Options& options);

  /// What moves ahead, as CollisionChecker::things().
  std::vector<std::size_t> things() const;

  /// Whether one of them surely is far from where a body may be until a stop. Where all are, there
  /// is a continuation. `false` says nothing.
  /// @param stretches  of some ends, over stop_m() and more.
  bool keeps_clear(std::size_t thing, const std::vector<LineStretch>& stretches) const;

  /// How far the stop goes along the line, at most.
  double stop_m() const;

  /// Of an end state. Each offset is looked at once per station that it is reached at.
  bool exists(double end_d_m, double end_l_m);

  /// Whether it was asked for, and there is none.
  bool is_known_to_fail(double end_d_m, double end_l_m) const;

 private:
  using Place = std::pair<double, double>;  // end offset and station

  Place place_of(double end_d_m, double end_l_m) const;
  bool find(double end_d_m, double end_s_m) const;
  double free_until_m(const LateralPath& hold, double end_s_m) const;
  bool is_begun(double end_d_m, double end_s_m) const;
  bool passes(const LateralPath& hold, double end_d_m, double back_from_m) const;
  DrivenPath along(const LateralPath& path) const;

  const CycleContext& context_;
  const geometry::VehicleShape& vehicle_;
  Options options_;
  double start_t_s_;
  CollisionChecker checker_;
  std::map<Place, bool> known_;
  bool some_end_ = false;
};

}  // namespace roadbed::planning::lateral
