#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/planning/behaviour/lateral_replanner.h"
#include "roadbed/planning/behaviour/planner_types.h"
#include "roadbed/planning/lateral/candidate_grid.h"
#include "roadbed/planning/lateral/plan_types.h"
#include "roadbed/tools/simulation/collision.h"
#include "roadbed/tools/simulation/outside_planner.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

// What a closed-loop drive left behind, as plain data. Coordinates are the source's raw ones [m],
// times are seconds of the drive.

/// A motion that is foreseen of an obstacle.
struct ForeseenMotion {
  std::size_t obstacle = 0;  ///< index in the world
  double probability = 1.0;
  std::vector<Eigen::Vector2d> points = {};  ///< of its middle, every half a second from now
};

/// How well others are known, where they are measured.
struct TrackingQuality {
  std::size_t measurements = 0;
  double measured_m2 = 0.0, tracked_m2 = 0.0;  ///< sums of squared distances to the true place
  std::size_t identity_swaps = 0;              ///< a track goes on as somebody else's
};

/// One planning cycle, every 0.1 s.
struct DriveCycle {
  double t_s = 0.0;
  planning::Behaviour behaviour = planning::Behaviour::cruise;
  std::string reason = {};        ///< "car p1 is 22.4 m ahead"
  bool is_news = false;           ///< the reason is worth an event
  bool from_measurement = false;  ///< replanned from the measured state: tracking was too far off
  std::optional<planning::Candidate> chosen =
      {};                   ///< none: nothing feasible, the last path is kept
  bool is_outside = false;  ///< the path is that of a planner of the user's, without candidates
  planning::LateralState start = {};                 ///< of the candidates
  std::optional<planning::CandidateGrid> grid = {};  ///< if candidates are kept
  std::string plan_reason = {};                      ///< why nothing was feasible
  double beyond_the_edge_m = 0.0;  ///< that the body may stick out of the corridor, if it has to
  std::vector<Eigen::Vector2d> path = {};  ///< planned, rear axle; empty without a candidate
  std::optional<planning::DriveLead> lead = {};
  std::vector<planning::HypothesisOutcome> hypotheses = {};
  std::vector<ForeseenMotion> foreseen = {};  ///< empty where the future is known

  bool has_plan() const { return chosen.has_value() || is_outside; }
};

/// What is known at each row of the trajectory.
struct DriveSample {
  double t_s = 0.0;
  double s_m = 0.0;  ///< station on the reference line; it goes on where another route is taken
  double set_speed_mps = 0.0;          ///< what the cruise control is asked for
  double speed_limit_mps = 0.0;        ///< of the map
  double command_mps2 = 0.0;           ///< desired acceleration
  double cross_track_m = 0.0;          ///< e_fa, of the true state against the path, front axle
  double heading_error_rad = 0.0;      ///< θ_e
  double clearance_m = 0.0;            ///< to the nearest obstacle; infinite without any
  double throttle = 0.0, brake = 0.0;  ///< pedals, 0 to 1; 0 where the scenario has none
  double off_road_m = 0.0;  ///< of the body's farthest point, until the next row; 0 on the road
};

enum class EventLevel { info, warning, fault };

struct DriveEvent {
  double t_s = 0.0;
  EventLevel level = EventLevel::info;
  std::string text;
};

enum class Outcome { goal_reached, stopped, collision, timed_out, left_road };
std::string_view to_string(Outcome outcome);
std::string_view to_string(EventLevel level);

struct DriveVerdict {
  Outcome outcome = Outcome::timed_out;
  double at_s = 0.0;
  std::string text;  ///< "goal reached after 41.2 s, 0.12 m from it"
};

/// A route that was given up for another one, as far as it was driven, and its line.
struct GivenUpRoute {
  double until_s = 0.0;
  planning::Route route;
  planning::ReferenceLine line;
};

struct Drive {
  geometry::Trajectory trajectory;   ///< true state, rear axle, every 0.1 s from t = 0
  std::vector<DriveSample> samples;  ///< one per row of the trajectory
  std::vector<DriveCycle> cycles;    ///< by time
  std::vector<DriveEvent> events;    ///< by time
  DriveVerdict verdict;
  std::vector<GivenUpRoute> given_up;  ///< by time; the world's is the last route
  double last_line_from_s_m = 0.0;     ///< station of the samples where that one's line begins

  /// Ratio of control steps in which the cruise control saturates at ±max_command.
  double saturated_ratio = 0.0;

  std::optional<Collision> collision = {};  ///< that ended it

  /// Where others are measured.
  std::optional<TrackingQuality> tracking = {};

  /// The task as the planner knew it, where others are measured.
  std::shared_ptr<planning::DrivingTask> believed = nullptr;

  /// What the last cycle was decided on, if the loop was asked for it; it sees the world's lines
  /// and occupied space, or those of what was believed.
  std::shared_ptr<const planning::ExplainedPlan> explained = nullptr;
};

/// Which of the drive's lines was driven along: those of routes that were given up, then the
/// world's.
std::size_t line_at(const Drive& drive, double t_s);

/// What is worth telling of a cycle after the one before it: nothing feasible, an emergency,
/// another lead, …
/// @param last  none before the first cycle.
std::vector<DriveEvent> events_of(const DriveCycle& cycle, const DriveCycle* last);

/// Bounds of the loop; the scenario's own options come on top.
struct LoopOptions {
  double goal_tolerance_m = 1.0;  ///< the vehicle stops this near to the goal's station, or nearer
  planning::PlannerOptions planner = {};
  /// Others are measured, tracked and foreseen; otherwise the planner knows what they will do.
  bool predicts = true;
  std::function<void(double cycle_ms)> on_cycle = {};  ///< wall clock of each planning cycle
  /// The drive is left, without a verdict, when this cycle is planned; what it was decided on is
  /// kept. Until then all is as it would be without.
  std::optional<std::size_t> last_cycle = {};
  OutsidePlanner outside_planner = {};  ///< if any, it plans in place of roadbed's
};

/// Drives a scenario: plans every 0.1 s, controls every 0.01 s, until the goal is reached, an
/// obstacle is touched, or the time is up. Deterministic: same scenario, same drive.
/// @param world  the motions of its drivers become what they did; route, line and stop points those
///               of the last route that was taken.
Drive drive(const Scenario& scenario, World& world, const LoopOptions& options = {});

/// A drive as a CommonRoad solution (KS model, vehicle 2, cost function SM1): the states of the
/// vehicle's centre at the scenario's time steps.
std::string solution_xml(const CommonRoadDrive& problem, const Drive& drive);

}  // namespace roadbed::tools::simulation
