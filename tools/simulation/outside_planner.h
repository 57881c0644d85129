#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

// A planner of the user's in place of roadbed's: it is told what is seen, answers with a
// trajectory, and the loop follows that (trajectory_follower.h). All coordinates are the source's.

/// Another road user, or a thing in the way, as it is at one time.
struct SeenObstacle {
  std::string id, kind;
  double length_m = 0.0, width_m = 0.0;
  geometry::Pose2 pose;  ///< of its centre
  double speed_mps = 0.0;
};

/// What a planner gets to see at one cycle.
struct Observation {
  double t_s = 0.0;
  geometry::TrajectoryPoint ego;  ///< as measured, rear axle
  std::vector<SeenObstacle> obstacles;
  Eigen::Vector2d goal{0, 0};
  double s_m = 0.0, d_m = 0.0;  ///< of the ego on the scenario's reference line
  const Scenario& scenario;
  const World& world;
};

Observation observe(const Scenario& scenario, const World& world, double t_s,
                    const planning::VehicleState& measured);

/// What it wants driven.
struct OutsidePlan {
  geometry::Trajectory trajectory;  ///< from now on, in scenario time; empty: the last one holds
  std::string reason = {};          ///< one line, for the report
};

/// Called once a cycle, every 0.1 s.
/// @throws whatever ends the drive.
using OutsidePlanner = std::function<OutsidePlan(const Observation&)>;

/// What is seen as one JSON document; see README.md. The first of a drive tells of the scene too.
Json observation_json(const Observation& seen, bool with_scene);

/// The answer to it: `{"trajectory":[[t_s,x_m,y_m,heading_rad,speed_mps,…],…],"reason":"…"}`, with
/// up to the eight columns of a trajectory's file.
/// @throws InputError; `name` stands for the planner in messages.
OutsidePlan parse_outside_plan(std::string_view bytes, const std::string& name);

/// A process that answers a line of such JSON with another: `command` is the shell's.
/// It is started by the first question. Signals of broken pipes have to be off (NoPipeSignal).
/// @param limit_s  wall clock that one answer may take.
/// @throws InputError where it gives no answer, or none that is a trajectory.
OutsidePlanner planner_process(const std::string& command, double limit_s);

}  // namespace roadbed::tools::simulation
