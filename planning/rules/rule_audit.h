#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/task/stop_points.h"

namespace roadbed::planning::inline rules {

/// Traffic rules that a drive may break.
enum class TrafficRule {
  markings,   ///< the body is over a marking that is solid from where it comes, not in junctions
  direction,  ///< the rear axle moves against the lane that it is in
  speed,      ///< it is faster than the lane's limit
  lights,     ///< its front passes a light that is red
};
inline constexpr std::array kTrafficRules{TrafficRule::markings, TrafficRule::direction,
                                          TrafficRule::speed, TrafficRule::lights};
std::string_view to_string(TrafficRule rule);

/// A stretch of time in which a rule is broken.
struct Violation {
  double from_s = 0.0, to_s = 0.0;
  geometry::TrajectoryPoint at;  ///< where it is worst, or begins
  std::string lane = {};         ///< that the rule is of
  std::string text = {};         ///< for users: "53.2 km/h, limit 50.0 km/h"
  double over = 0.0;             ///< of speed: over the limit [m/s]; else 0
};

/// What was found of one rule.
struct RuleReport {
  TrafficRule rule = TrafficRule::markings;
  Verdict verdict = Verdict::clear;  ///< conflict, unknown or clear
  std::vector<Violation> violations;
  std::vector<Stretch> unknown;  ///< the map does not say what holds
  std::string reason = {};       ///< of what is unknown
};

/// What is known beside the map.
struct RuleInputs {
  const map::RoadMap* road_map = nullptr;
  std::span<const LightCycle> lights = {};  ///< in the drive's time
};

/// One report for each rule, in their order. The drive is looked at at moments 0.2 m of way apart,
/// or at each of its rows where these are farther apart: what is told is no proof.
///
/// Lanes are those that the rear axle, the body's front and its rear are in and along; where lanes
/// overlap, a rule is broken only if it is by all of them.
/// @throws std::invalid_argument if the drive is empty.
std::vector<RuleReport> audit_rules(const RuleInputs& inputs,
                                    const geometry::Trajectory& drive_in_source,
                                    const geometry::BodyPart& body);

}  // namespace roadbed::planning::rules
