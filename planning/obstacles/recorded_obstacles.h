#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline obstacles {

/// What time steps of a CommonRoad file are in seconds of a drive.
struct RecordingClock {
  long start_step = 0;  ///< second 0
  double step_s = 0.0;

  double seconds(long step) const { return step_s * static_cast<double>(step - start_step); }
};

/// An obstacle of a CommonRoad file as the smallest rectangle along its heading that holds its
/// shape, for a simulation: it may reach beyond that where the file gives regions or intervals,
/// whose middles it is at. What moves is there from its first to its last recorded time step; what
/// does not, always.
///
/// An occupancy set is one obstacle for each part and time step, all of the same id: the least
/// rectangle of that part, there until the next step's, which it moves towards.
/// @pre it has an initial state and a shape.
std::vector<ObstacleInSource> recorded_obstacles(const map::commonroad::Obstacle& from,
                                                 const RecordingClock& clock);

/// The initial time step of the first planning problem; none without one.
std::optional<long> initial_step(const map::commonroad::Scenario& scenario);

/// The obstacles of a CommonRoad file as boxes over time that hold all that the file says of them,
/// for a proof.
///
/// A trajectory is one box along its heading, linear between its states, there from the first to
/// the last; without a prediction it stands for ever. Each part of an occupancy stands from the
/// start of its first time step to the end of its last, and the initial state before it for its
/// own. An environment obstacle stands for ever. A polygon is held by the least rectangle along one
/// of its edges, a circle by its square. Of several boxes the ids get numbers: 42.1, 42.2.
/// @param start_step  that is second 0.
/// @param name        stands for the file in messages.
/// @throws InputError if an obstacle cannot be held so: a state that gives regions or intervals,
///         states that do not follow each other, nothing that says where it is.
std::vector<ObstacleInSource> recorded_boxes(const map::commonroad::Scenario& scenario,
                                             long start_step, const std::string& name);

/// A rectangle of CommonRoad, in the frame that it is given in.
geometry::Rectangle rectangle_of(const map::commonroad::RectangleShape& shape);

/// The least box around all parts of a shape; empty for a shape without any.
Eigen::AlignedBox2d bounds_of(const map::commonroad::Shape& shape);

}  // namespace roadbed::planning::obstacles
