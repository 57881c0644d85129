#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/behaviour/planner_types.h"
#include "roadbed/planning/route/route_place.h"
#include "roadbed/planning/task/driving_task.h"
#include "roadbed/planning/tracking/perceived_traffic.h"
#include "roadbed/planning/tracking/tracker.h"

namespace roadbed::planning::inline pilot {

/// Where to drive, and how. All poses are in the map's frame.
struct PilotSetup {
  std::shared_ptr<const map::RoadMap> road_map;
  RoutePlace goal;
  geometry::VehicleShape vehicle = {};
  DrivingOptions driving = {};
  PlannerOptions planner = {};
  TrackerOptions tracker = {};
  std::shared_ptr<const map::ClearanceField> occupied = {};  ///< to be kept clear of; may be none
  /// How far objects are measured, and only what others do not hide; none: all are.
  std::optional<double> sight_m = {};
};

/// A light of the map as it is seen now.
struct SeenLight {
  std::string signal;  ///< source id
  LightColour colour = LightColour::red;
};

/// What is seen at one time.
struct PilotView {
  double t_s = 0.0;
  VehicleState ego;
  std::vector<Detection> objects;
  /// False: nobody looked for objects; those known are believed to go on, for 10 s at most.
  bool has_objects = true;
  std::vector<SeenLight> lights;  ///< one keeps what it showed; never named, it is dark
};

/// What to do until the next time, and if there is none.
struct PilotAnswer {
  geometry::Trajectory trajectory;  ///< of the rear axle, from now to a stop
  double acceleration_mps2 = 0.0;   ///< desired, now
  double steering_rad = 0.0;        ///< desired, now
  PlannerCommand decision;          ///< behaviour, reason, lead, what lost and why
  bool is_at_goal = false;          ///< it stands within a metre of it
};

/// The planner for who has a vehicle or a simulation of their own: measured objects are tracked and
/// foreseen, the planner decides, and what it decides comes back as a trajectory.
///
///     view ─▶ PerceivedTraffic ─▶ Planner ─▶ trajectory that ends in a stop
///      │                             ▲  └──▶ acceleration (LQG), steering (Stanley)
///      └── ego, lights ──────────────┘
///
/// The route is found at the first view; anew where the vehicle has been taken more than 12 m away
/// from its line, or the road is blocked. To be asked every 0.1 s, as its controllers expect. For
/// one thread.
class Pilot {
 public:
  /// @throws std::invalid_argument if there is no map, or an option or the goal is not usable.
  explicit Pilot(PilotSetup setup);
  ~Pilot();
  Pilot(Pilot&&) noexcept;
  Pilot& operator=(Pilot&&) noexcept;

  /// @throws std::invalid_argument if time does not increase, a number is not finite, or two
  ///         objects have one id; nothing is changed then.
  PilotAnswer step(const PilotView& view);

  /// Objects as they are believed to be now, and what each of them may do; of the last step.
  const PerceivedTraffic& others() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbed::planning::pilot
