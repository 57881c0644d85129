#pragma once

#include <Eigen/Core>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline obstacles {

/// The corridor's edges along a stretch of a reference line, ready to be asked for many poses.
class RoadBorder {
 public:
  RoadBorder(const LineView& line, double from_s_m, double to_s_m);

  /// How far a vehicle's body sticks out of the corridor [m]; 0 or less inside. Its rear axle is
  /// beside station `near_s_m`. Each corner is held against the edge at its own
  /// station, so a front that swings out in a bend is seen. Exact to about a millimetre where
  /// the line's radius is 10 m.
  double excess_m(const geometry::Rectangle& body, double rear_overhang_m, double near_s_m) const;

  /// What the corridor has at least beside the line between two stations, and how the line bends.
  struct Room {
    double left_m, right_m;
    double least_curvature_per_m, most_curvature_per_m;
  };
  Room least_room(double from_s_m, double to_s_m) const;

 private:
  struct Sample {
    Eigen::Vector2d in_map, tangent;
    double left_m, right_m, curvature_per_m;
  };
  double excess_of_point_m(const Eigen::Vector2d& point, double near_s_m) const;
  std::size_t sample_before(const Eigen::Vector2d& point, double near_s_m) const;

  double from_s_m_;
  std::vector<Sample> samples_;
};

}  // namespace roadbed::planning::obstacles
