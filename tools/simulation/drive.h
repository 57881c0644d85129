#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/planning/behaviour/pilot.h"
#include "roadbed/planning/lateral/plan.h"
#include "roadbed/tools/simulation/candidate_grid.h"

namespace roadbed::tools::inline simulation {

// What a closed-loop drive left behind, as plain data. Coordinates are the source's raw ones [m],
// times are seconds of the drive.

/// One planning cycle, every 0.1 s.
struct DriveCycle {
  double t_s = 0.0;
  planning::Behaviour behaviour = planning::Behaviour::cruise;
  std::string reason = {};        ///< "car p1 is 22.4 m ahead"
  bool from_measurement = false;  ///< replanned from the measured state: tracking was too far off
  std::optional<planning::Candidate> chosen =
      {};                                  ///< none: nothing feasible, the last path is kept
  planning::LateralState start = {};       ///< of the candidates
  std::optional<CandidateGrid> grid = {};  ///< if candidates are kept
  std::string plan_reason = {};            ///< why nothing was feasible
  double beyond_the_edge_m = 0.0;  ///< that the body may stick out of the corridor, if it has to
  std::vector<Eigen::Vector2d> path = {};  ///< planned, rear axle; empty without a candidate
  std::optional<planning::DriveLead> lead = {};
};

/// What is known at each row of the trajectory.
struct DriveSample {
  double t_s = 0.0;
  double s_m = 0.0;                    ///< station on the reference line
  double set_speed_mps = 0.0;          ///< what the cruise control is asked for
  double speed_limit_mps = 0.0;        ///< of the map
  double command_mps2 = 0.0;           ///< desired acceleration
  double cross_track_m = 0.0;          ///< e_fa, of the true state against the path, front axle
  double heading_error_rad = 0.0;      ///< θ_e
  double clearance_m = 0.0;            ///< to the nearest obstacle; infinite without any
  double throttle = 0.0, brake = 0.0;  ///< pedals, 0 to 1; 0 where the scenario has none
  double off_road_m = 0.0;  ///< of the body's worst corner, in steps of 0.1 m; 0 on the road
};

enum class EventLevel { info, warning, fault };

struct DriveEvent {
  double t_s = 0.0;
  EventLevel level = EventLevel::info;
  std::string text;
};

enum class Outcome { goal_reached, stopped, collision, timed_out };
std::string_view name(Outcome outcome);

struct DriveVerdict {
  Outcome outcome = Outcome::timed_out;
  double at_s = 0.0;
  std::string text;  ///< "goal reached after 41.2 s, 0.12 m from it"
};

struct Drive {
  geometry::Trajectory trajectory;   ///< true state, rear axle, every 0.1 s from t = 0
  std::vector<DriveSample> samples;  ///< one per row of the trajectory
  std::vector<DriveCycle> cycles;    ///< by time
  std::vector<DriveEvent> events;    ///< by time
  DriveVerdict verdict;

  /// Saturation of the cruise control at ±max_command, share of the control steps.
  double saturated_share = 0.0;
};

}  // namespace roadbed::tools
