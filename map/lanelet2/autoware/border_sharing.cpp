#include "roadbed/map/lanelet2/autoware/border_sharing.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/lanelet2/autoware/shapes.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

/// Lanelets that lie beside one, by their place among the map's lanelets.
using Beside = std::map<const Lanelet*, std::set<const Lanelet*>>;

/// How far another lanelet's border may be from this one's surface to lie beside it [m].
double reach_m(const Surface& surface) {
  constexpr double kShare = 0.05;  // of the mean of the widths at both ends
  const double start_m = (surface.left.front() - surface.right.front()).head<2>().norm();
  const double end_m = (surface.left.back() - surface.right.back()).head<2>().norm();
  return 0.5 * kShare * (start_m + end_m);
}

/// Whether vertices and middles of a line are nowhere further from the surface than that.
bool stays_near(const VectorMap& map, const std::vector<Eigen::Vector3d>& line,
                const Surface& surface, double reach_m) {
  if (!map.budget().spend(2 * line.size() * surface.ring.size())) return false;
  const Line2 edge = closed(surface.ring);
  const auto is_near = [&](const Eigen::Vector2d& point) {
    return geometry::contains(surface.ring, point) || distance_m(point, edge) <= reach_m;
  };
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector2d at = line[i].head<2>();
    if (!is_near(at)) return false;
    if (i > 0 && !is_near(0.5 * (at + line[i - 1].head<2>()))) return false;
  }
  return true;
}

bool is_inside(const std::vector<Eigen::Vector3d>& line, const geometry::Box& box) {
  return std::ranges::all_of(
      line, [&](const Eigen::Vector3d& point) { return box.contains(point.head<2>()); });
}

/// Whether two lanelets are as they should be, so that nothing is asked of their borders.
bool are_related(const VectorMap& map, const Lanelet& one, const Lanelet& other) {
  if (one.text->end == other.text->start || other.text->end == one.text->start) return true;
  if (on_other_level(*one.surface, *other.surface)) return true;
  for (const Side side : {Side::left, Side::right}) {
    if (std::ranges::count(map.neighbours(one, side), &other) > 0) return true;
  }
  return false;
}

bool overlap_widely(const VectorMap& map, const Surface& one, const Surface& other) {
  constexpr double kShare = 0.05;  // of what either covers
  const double both_m2 = overlap_m2(map, one.ring, other.ring);
  return both_m2 > kShare * (one.area_m2 + other.area_m2 - both_m2);
}

Beside find_beside(const VectorMap& map) {
  Beside beside;
  for (const Lanelet& lanelet : map.lanelets()) {
    if (!lanelet.surface || map.budget().is_spent()) continue;
    const Surface& surface = *lanelet.surface;
    const double reach = reach_m(surface);
    geometry::Box box = surface.box;
    box.extend(Eigen::Vector2d(box.min().array() - reach));
    box.extend(Eigen::Vector2d(box.max().array() + reach));
    for (const Lanelet* other : map.near(box)) {
      if (other == &lanelet || are_related(map, lanelet, *other)) continue;
      const Surface& theirs = *other->surface;
      const auto lies_beside = [&](const std::vector<Eigen::Vector3d>& border) {
        return map.budget().spend(border.size()) && is_inside(border, box) &&
               stays_near(map, border, surface, reach);
      };
      if (!lies_beside(theirs.left) && !lies_beside(theirs.right)) continue;
      if (!overlap_widely(map, surface, theirs)) beside[&lanelet].insert(other);
    }
  }
  return beside;
}

}  // namespace

void border_sharing(const VectorMap& map, const validation::ValidateOptions&,
                    validation::Report& report) {
  const Beside beside = find_beside(map);
  for (const Lanelet& lanelet : map.lanelets()) {
    const auto others = beside.find(&lanelet);
    if (others == beside.end()) continue;
    std::vector<std::int64_t> smaller;
    for (const Lanelet* other : others->second) {
      const auto theirs = beside.find(other);
      if (theirs == beside.end() || !theirs->second.contains(&lanelet)) {
        smaller.push_back(other->id());
        continue;
      }
      add_issue(report, map, 1, lanelet,
                fmt::format("lies beside lanelet {} and does not share a border with it; give both "
                            "the same way",
                            other->id()));
    }
    if (smaller.empty()) continue;
    add_issue(report, map, 2, lanelet,
              fmt::format("lies beside lanelets {} and does not share borders with them; divide it "
                          "as they are, and give both sides the same ways",
                          ids_text(smaller)));
  }
}

}  // namespace roadbed::map::lanelet2::autoware
