#include "roadbed/map/opendrive/road_frame.h"

#include <algorithm>
#include <cmath>

#include "roadbed/map/opendrive/lane_borders.h"

namespace roadbed::map::opendrive {

Eigen::Vector3d RoadFrame::at(double s_m, double t_m, double h_m) const {
  const geometry::Pose2 pose = plan_view_->at(s_m).pose;
  const double roll_rad = road_->superelevation.cubic.at(s_m).value;
  const double sideways_m = t_m * std::cos(roll_rad) - h_m * std::sin(roll_rad);
  const double up_m = t_m * std::sin(roll_rad) + h_m * std::cos(roll_rad);
  return {pose.x_m - sideways_m * std::sin(pose.heading_rad),
          pose.y_m + sideways_m * std::cos(pose.heading_rad),
          road_->elevation.cubic.at(s_m).value + up_m};
}

std::pair<double, double> RoadFrame::reach_m(double s_m) const {
  const double offset_m = road_->lane_offset.cubic.at(s_m).value;
  double least_m = offset_m, greatest_m = offset_m;
  if (road_->sections.empty()) return {least_m, greatest_m};
  const std::size_t section = section_index_at(*road_, s_m);
  for (const int sign : {1, -1}) {
    double t_m = offset_m;
    for (const LaneRecord* lane : section_side(*road_, section, sign).lanes) {
      const double value_m = lane->outer().at(s_m).value;
      const bool by_width = lane->goes_by_width();
      t_m = by_width ? t_m + sign * value_m : offset_m + value_m;
      least_m = std::min(least_m, t_m);
      greatest_m = std::max(greatest_m, t_m);
    }
  }
  return {least_m, greatest_m};
}

std::size_t section_index_at(const RoadRecord& road, double s_m) {
  const auto after =
      std::upper_bound(road.sections.begin(), road.sections.end(), s_m,
                       [](double s, const LaneSection& section) { return s < section.s_m; });
  return after == road.sections.begin()
             ? 0
             : static_cast<std::size_t>(after - road.sections.begin()) - 1;
}

bool is_placeable(const Eigen::Vector3d& in_map) {
  return in_map.allFinite() && in_map.cwiseAbs().maxCoeff() < 1e8;
}

}  // namespace roadbed::map::opendrive
