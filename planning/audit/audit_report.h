#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/polygons/convex_overlap.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/verdict.h"

namespace roadbed::planning::inline audit {

/// What space that was never measured counts as. `report`: it is no obstacle, but a drive near it
/// is not clear.
enum class UnknownPolicy { free, occupied, report };
std::string_view to_string(UnknownPolicy policy);

/// What is asked of a drive.
struct AuditOptions {
  double clearance_m = 0.0;  ///< less than this is a conflict, an overlap always; < horizon / 2
  double inflate_m = 0.0;    ///< localisation margin added around the vehicle
  UnknownPolicy unknown = UnknownPolicy::report;
  double tolerance_m = 0.02;  ///< bound on the error of the least clearance
  /// Less of the space that the body sweeps over having been measured, 0 … 1, leaves the whole
  /// drive unknown, whatever unknown space counts as.
  double least_measured = 0.0;
};

/// A time at which nothing that was measured lies this near to the body was not looked at: it is
/// unknown whatever unknown space counts as.
inline constexpr double kObservedWithin_m = 10.0;

/// A part of the drive by time.
struct Stretch {
  double from_s = 0.0, to_s = 0.0;
};

/// A time all through which a measured column of a part's heights lies within `kObservedWithin_m`
/// of it: its distance then, and all that the part may move until the end, are no more than that.
struct ObservedTime {
  double from_s = 0.0, to_s = 0.0;
  Eigen::Vector2d column_in_source{0, 0};  ///< its middle
};

/// A time at which there is none.
struct UnobservedStretch {
  double from_s = 0.0, to_s = 0.0;
  std::string part = {};    ///< of the vehicle
  std::string reason = {};  ///< for users, with what to do
};

/// The deepest overlap of a conflict: of moments 0.1 m of motion apart, a hundred at most.
struct DeepestOverlap {
  geometry::Overlap overlap = {};  ///< the depth with one cell or thing, the area with all; 0: none
  double at_s = 0.0;
};

/// A stretch of time in which the vehicle is too near to something.
struct Conflict {
  double from_s = 0.0, to_s = 0.0;
  double least_clearance_m = 0.0;  ///< within tolerance
  geometry::TrajectoryPoint at;    ///< state at the least clearance; of equal ones, the first
  map::Box2 witness;               ///< the nearest cell then, or the box around what moves
  std::string obstacle = {};       ///< id of what moves; empty: a cell
  /// Of the vehicle that is nearest then: "front left corner", of one with more than its body
  /// "left mirror, front left corner"; a circle's name.
  std::string part = {};
  DeepestOverlap deepest = {};
};

/// What was found of it: the verdict of all, and every stretch that speaks against `clear`.
struct AuditReport {
  Verdict verdict = Verdict::undecided;

  /// Distance at `least_clearance_at_s`; no time of the drive has less than `proven_clearance_m`,
  /// and the two are at most the tolerance apart.
  double least_clearance_m = 0.0;
  double proven_clearance_m = 0.0;
  double least_clearance_at_s = 0.0;
  std::optional<map::Box2> witness;  ///< as of a conflict; none beyond the horizon
  std::string obstacle = {};         ///< the same
  std::string part = {};             ///< of the vehicle that is nearest then; empty without witness
  bool beyond_horizon = false;       ///< nothing within the field's horizon: a lower bound only

  double unknown_fraction = 0.0;    ///< mean over poses half a metre apart
  double least_measured = 0.0;      ///< as was asked
  std::vector<Conflict> conflicts;  ///< in order of time
  std::vector<Stretch> unknown;     ///< space within the clearance was not measured, or the like:
  std::vector<UnobservedStretch> unobserved;  ///< nothing was measured near, so unknown as well
  std::vector<Stretch> between_poses;  ///< nobody says where the vehicle was, so unknown as well
  std::vector<ObservedTime> observed;  ///< of one part: what says that the rest is not so
  std::vector<Stretch> undecided;      ///< nearer to the limit than the proof can tell (1 mm)

  struct Sample {
    double t_s, clearance_m;
  };
  std::vector<Sample> profile;  ///< clearance at samples; beyond 5 m a lower bound of it

  bool is_measured_enough() const { return 1.0 - unknown_fraction >= least_measured; }
};

/// The report of a drive, judged: all of it is unknown where too little was measured.
AuditReport judged(AuditReport report, const geometry::Trajectory& drive);

/// The report of a drive of which nobody says where it was in these stretches.
/// @pre they lie in the drive, in order of time.
AuditReport judged_between_poses(AuditReport report, const std::vector<Stretch>& between_poses);

/// Stretches in order of time; those that meet become one.
std::vector<Stretch> joined(std::vector<Stretch> stretches);

/// A part of a drive with one verdict.
struct JudgedStretch {
  double from_s = 0.0, to_s = 0.0;
  Verdict verdict = Verdict::undecided;
};

/// The whole drive, stretch by stretch, in order of time and without a gap. Where several verdicts
/// meet, the graver one counts: conflict, then unknown, then undecided, then clear.
std::vector<JudgedStretch> judged_stretches(const AuditReport& report, double start_s,
                                            double end_s);

}  // namespace roadbed::planning::audit
