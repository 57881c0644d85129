#pragma once

#include <Eigen/Core>

#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// Places beside a road: (s, t, h) of its reference line, leaning with the superelevation, as
/// signals and objects give them (ASAM OpenDRIVE 1.8, section 7.6).
class RoadFrame {
 public:
  RoadFrame(const RoadRecord& road, const geometry::PlanView& plan_view)
      : road_(&road), plan_view_(&plan_view) {}

  const RoadRecord& road() const { return *road_; }

  Eigen::Vector3d at(double s_m, double t_m, double h_m) const;
  double heading_rad(double s_m) const { return plan_view_->at(s_m).pose.heading_rad; }

  /// How far the lanes reach: least and greatest t of any border at s.
  std::pair<double, double> reach_m(double s_m) const;

 private:
  const RoadRecord* road_;
  const geometry::PlanView* plan_view_;
};

/// Index of the lane section that holds at s.
std::size_t section_index_at(const RoadRecord& road, double s_m);

/// Whether it is a place that a map can hold.
bool is_placeable(const Eigen::Vector3d& in_map);

}  // namespace roadbed::map::opendrive
