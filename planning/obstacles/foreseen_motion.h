#pragma once

#include <optional>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/primitives/pose2.h"

namespace roadbed::planning::inline obstacles {

/// What was seen of somebody until a time; the pose is that of its centre then, in the map.
struct SeenMotion {
  double t_s = 0.0;
  geometry::Pose2 pose;
  double speed_mps = 0.0;  ///< along its heading; negative if it backs up
  double acceleration_mps2 = 0.0;
  double curvature_per_m = 0.0;  ///< of its path, positive to the left
};

inline constexpr double kForeseen_s = 12.0, kForeseenStep_s = 0.2;

/// Speed some time after it was seen: nobody brakes for more than 2 s, nor speeds up for more than
/// 1 s; who brakes may well come to rest.
double foreseen_speed_mps(const SeenMotion& seen, double after_s);

/// Keeps its bend for two seconds, then goes straight on, over kForeseen_s; a point every
/// kForeseenStep_s, or one alone if it stands.
geometry::Trajectory foreseen_motion(const SeenMotion& seen);

/// What is foreseen of somebody from a time on, driven by one who keeps speeding up for 4 s as over
/// the first half of a second; none if that is by less than 0.5 m/s². To be kept clear of, not to
/// be expected: most speed up for a shorter time.
std::optional<geometry::Trajectory> speeding_on(const geometry::Trajectory& foreseen,
                                                double from_s);

}  // namespace roadbed::planning::obstacles
