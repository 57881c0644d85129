#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/elements/attributes.h"

namespace roadbed::map::commonroad {

/// A value that the file gives exactly (both ends equal) or as an interval.
template <typename Number>
struct Range {
  Number least{}, most{};
  bool is_exact() const { return least == most; }
  bool operator==(const Range&) const = default;
};

struct RectangleShape {
  double length_m = 0.0, width_m = 0.0;
  double heading_rad = 0.0;  ///< of its length
  Eigen::Vector2d centre_m{0, 0};
};
struct CircleShape {
  double radius_m = 0.0;
  Eigen::Vector2d centre_m{0, 0};
};
struct PolygonShape {
  geometry::Ring corners_m;  ///< as the file has them, a repeated last corner too
};

/// One shape or a group of several. An obstacle's is relative to its position and heading; that of
/// a place is in source coordinates.
using Shape = std::vector<std::variant<RectangleShape, CircleShape, PolygonShape>>;

/// What is known of a vehicle at one time, or asked of it. Coordinates are the source's.
struct State {
  Range<long> time_step;
  std::optional<Eigen::Vector2d> position_m;  ///< where it is one point
  Shape region;                               ///< where it is a region
  std::vector<std::string> lanelets;          ///< where it is on one of these lanes, by name
  std::optional<Range<double>> heading_rad, speed_mps, acceleration_mps2;
  /// Everything else, by the name of the file's element: "yawRate", "slipAngle", …
  std::vector<std::pair<std::string, Range<double>>> others;
};

/// The area that an obstacle takes during some time steps.
struct Occupancy {
  Range<long> time_step;
  Shape region;
};

enum class ObstacleRole { fixed, dynamic, environment, phantom };

struct Obstacle {
  std::string id;
  std::string type;  ///< the file's word: "car", "parkedVehicle", …; empty if it says nothing
  ObstacleRole role = ObstacleRole::fixed;
  Shape shape;  ///< of an environment obstacle in source coordinates, else its own
  std::optional<State> initial_state;
  std::vector<State> trajectory;         ///< recorded, one per time step after the initial one
  std::vector<Occupancy> occupancy_set;  ///< in place of a trajectory
};

/// From where to where the ego vehicle has to go.
struct PlanningProblem {
  std::string id;
  State initial_state;
  std::vector<State> goals;  ///< reaching one of them is enough
};

/// A piece of a light's cycle.
struct LightPhase {
  std::string colour;  ///< the file's word: "red", "redYellow", "green", "yellow", "inactive"
  double duration_steps = 0.0;  ///< 0 where the file has no number
};

/// What a traffic light shows; the map's signal of this id is where it stands.
struct TrafficLight {
  std::string id;
  std::vector<LightPhase> cycle;  ///< over and over again
  double offset_steps = 0.0;      ///< time step at which the cycle begins
  bool is_active = true;
};

/// What a CommonRoad file says beyond its road network.
struct Scenario {
  std::string benchmark_id, version;  ///< "DEU_Flensburg-35_1_T-1", "2020a"
  Attributes attributes;              ///< author, affiliation, source, date, …
  std::vector<std::string> tags;      ///< "highway", …
  double time_step_s = 0.0;
  std::vector<Obstacle> obstacles;
  std::vector<PlanningProblem> planning_problems;
  std::vector<TrafficLight> lights;
};

/// Obstacles and planning problems of a CommonRoad file (XML formats 2018b and 2020a).
/// @param name  stands for the file in messages.
/// @throws InputError with the place in the file if one of them is unusable.
Scenario parse_scenario(const std::string& bytes, const std::string& name);

}  // namespace roadbed::map::commonroad
