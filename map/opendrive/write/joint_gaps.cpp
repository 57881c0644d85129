#include "roadbed/map/opendrive/write/joint_gaps.h"

#include <map>

namespace roadbed::map::opendrive {
namespace {

constexpr double kLetBe_m = 5e-3;

}  // namespace

JointGaps::JointGaps(const RoadMap& road_map, const RoadPlan& plan,
                     std::span<const EndJoints::value_type* const> joints) {
  std::map<std::pair<std::uint32_t, std::size_t>, std::size_t> numbers;
  const auto number = [&](std::uint32_t end, LaneId lane, bool on_left) {
    const BorderPlace place = plan.border_of(lane, on_left);
    const auto [found, is_new] = numbers.emplace(std::pair(end, place.border), borders_.size());
    if (is_new) {
      const PlannedSection& section = plan.roads[place.road].sections[place.section];
      borders_.push_back({end, place.border, border_along(road_map, section, place.border)});
    }
    return found->second;
  };
  for (const EndJoints::value_type* joint : joints) {
    const auto [from, to] = joint->first;
    if (plan.roads[from / 2].source || plan.roads[to / 2].source) continue;
    Pairs& pairs = joints_.emplace_back();
    for (const auto& [leaving, entering] : joint->second) {
      for (const bool on_left : {true, false}) {
        const std::size_t a = number(from, leaving, on_left), b = number(to, entering, on_left);
        pairs.emplace_back(a, b);
      }
    }
  }
}

double JointGaps::sum_m(const std::function<Eigen::Vector2d(const BorderEnd&)>& point_of) const {
  std::vector<Eigen::Vector2d> points;
  for (const BorderEnd& border : borders_) points.push_back(point_of(border));
  double sum_m = 0.0;
  for (const Pairs& pairs : joints_) {
    double gap_m = 0.0;
    for (const auto& [a, b] : pairs) gap_m += (points[b] - points[a]).norm();
    sum_m += gap_m > kLetBe_m ? gap_m : 0.0;
  }
  return sum_m;
}

}  // namespace roadbed::map::opendrive
