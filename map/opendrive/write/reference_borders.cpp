#include "roadbed/map/opendrive/write/reference_borders.h"

#include <deque>
#include <optional>

#include "roadbed/map/opendrive/write/end_roles.h"
#include "roadbed/map/opendrive/write/road_lines.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kSameEnd_m = 0.05;  // between ends of borders that go on in each other

class BorderChooser {
 public:
  BorderChooser(const RoadMap& road_map, const RoadPlan& plan)
      : road_map_(road_map), plan_(plan), ends_(find_end_roles(road_map, plan)) {
    chosen_.resize(plan.roads.size());
  }

  std::vector<std::size_t> choose() {
    for (const bool both_ways : {true, false}) {
      for (std::uint32_t road = 0; road < plan_.roads.size(); ++road) {
        if (!chosen_[road] && plan_.roads[road].has_both_ways() == both_ways) spread_from(road);
      }
    }
    std::vector<std::size_t> borders;
    for (const auto& border : chosen_) borders.push_back(*border);
    return borders;
  }

 private:
  void spread_from(std::uint32_t root) {
    chosen_[root] = plan_.roads[root].sections.front().left_lanes;
    std::deque<std::uint32_t> open{root};
    while (!open.empty()) {
      const std::uint32_t road = open.front();
      open.pop_front();
      for (const std::uint32_t end : {2 * road, 2 * road + 1}) {
        if (ends_.roles[end] != EndRole::plain) continue;
        const std::uint32_t other = ends_.partner[end];
        if (chosen_[other / 2]) continue;
        chosen_[other / 2] = matching(other, end_point(end, *chosen_[road]));
        open.push_back(other / 2);
      }
    }
  }

  Eigen::Vector2d end_point(std::uint32_t end, std::size_t border) const {
    const RoadBorder line = reference_along(road_map_, plan_.roads[end / 2], border);
    return line.points[end % 2 == 0 ? line.own_from : line.own_to].head<2>();
  }

  std::size_t matching(std::uint32_t end, const Eigen::Vector2d& point) const {
    const PlannedSection& section = plan_.roads[end / 2].sections.front();
    if (!plan_.roads[end / 2].source) {
      for (std::size_t i = 0; i <= section.lanes.size(); ++i) {
        if ((end_point(end, i) - point).norm() < kSameEnd_m) return i;
      }
    }
    return section.left_lanes;
  }

  const RoadMap& road_map_;
  const RoadPlan& plan_;
  EndRoles ends_;
  std::vector<std::optional<std::size_t>> chosen_;
};

}  // namespace

std::vector<std::size_t> reference_borders(const RoadMap& road_map, const RoadPlan& plan) {
  return BorderChooser(road_map, plan).choose();
}

}  // namespace roadbed::map::opendrive
