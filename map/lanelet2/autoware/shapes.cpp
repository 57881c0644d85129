#include "roadbed/map/lanelet2/autoware/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/map/derived/covered_area.h"

namespace roadbed::map::lanelet2::autoware {
namespace {

using Eigen::Vector2d;
using geometry::Ring;

bool may_compare(const VectorMap& map, std::size_t one, std::size_t other) {
  return map.budget().spend(one * other);
}

/// Where the segment from → to crosses edges of the ring, as shares of its length in order; 0 and 1
/// are among them.
std::vector<double> crossings(const Vector2d& from, const Vector2d& to, const Ring& ring) {
  std::vector<double> shares{0.0, 1.0};
  const Vector2d along = to - from;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d& a = ring[i];
    const Vector2d edge = ring[(i + 1) % ring.size()] - a;
    const double turn = geometry::cross(along, edge);
    if (turn == 0.0) continue;
    const double share = geometry::cross(a - from, edge) / turn;
    const double on_edge = geometry::cross(a - from, along) / turn;
    if (share > 0.0 && share < 1.0 && on_edge >= 0.0 && on_edge <= 1.0) shares.push_back(share);
  }
  std::ranges::sort(shares);
  return shares;
}

bool are_neighbours(const VectorMap& map, const Lanelet& lanelet, const Lanelet& other) {
  for (const Side side : {Side::left, Side::right}) {
    if (std::ranges::count(map.neighbours(lanelet, side), &other) > 0) return true;
  }
  return false;
}

bool follow_each_other(const Lanelet& one, const Lanelet& other) {
  return one.text->end == other.text->start || other.text->end == one.text->start;
}

}  // namespace

Line2 plan_of(const VectorMap& map, const Way& way) {
  Line2 plan;
  for (const std::uint32_t node : way.nodes) {
    plan.emplace_back(map.document().nodes[node].in_map.head<2>());
  }
  if (is_area(way) && way.nodes.size() > 1 && way.nodes.front() == way.nodes.back()) {
    plan.pop_back();
  }
  return plan;
}

double overlap_m2(const VectorMap& map, const Ring& a, const Ring& b) {
  if (!geometry::box_around(a).intersects(geometry::box_around(b))) return 0.0;
  if (!map.budget().spend(16 * (a.size() + b.size()))) return 0.0;
  // Each ring is a group of its own, so that the groups' sum counts what both cover twice.
  const auto area = derived::covered_area({{&a, 0}, {&b, 1}});
  return area ? std::max(area->groups_m2 - area->all_m2, 0.0) : 0.0;
}

double covered_share(const VectorMap& map, const Surface& lanelet, const Ring& ring) {
  return lanelet.area_m2 > 0.0 ? overlap_m2(map, lanelet.ring, ring) / lanelet.area_m2 : 0.0;
}

std::vector<std::pair<Vector2d, Vector2d>> parts_inside(const VectorMap& map, const Line2& line,
                                                        const Ring& ring) {
  std::vector<std::pair<Vector2d, Vector2d>> parts;
  if (ring.size() < 3 || !may_compare(map, line.size(), ring.size())) return parts;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector2d& from = line[i - 1];
    const Vector2d along = line[i] - from;
    const std::vector<double> shares = crossings(from, line[i], ring);
    for (std::size_t j = 1; j < shares.size(); ++j) {
      const double middle = 0.5 * (shares[j - 1] + shares[j]);
      if (!geometry::contains(ring, from + middle * along)) continue;
      parts.emplace_back(from + shares[j - 1] * along, from + shares[j] * along);
    }
  }
  return parts;
}

double share_inside(const VectorMap& map, const Line2& line, const Ring& ring) {
  double inside_m = 0.0, length_m = 0.0;
  for (const auto& [from, to] : parts_inside(map, line, ring)) inside_m += (to - from).norm();
  for (std::size_t i = 1; i < line.size(); ++i) length_m += (line[i] - line[i - 1]).norm();
  return length_m > 0.0 ? inside_m / length_m : 0.0;
}

bool touch(const VectorMap& map, const Line2& line, const Ring& ring) {
  if (ring.size() < 3 || !may_compare(map, line.size(), ring.size())) return false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (geometry::contains(ring, line[i])) return true;
    if (i > 0 && crossings(line[i - 1], line[i], ring).size() > 2) return true;
  }
  return false;
}

Line2 closed(Ring ring) {
  if (!ring.empty()) ring.push_back(ring.front());
  return ring;
}

double distance_m(const Vector2d& point, const Line2& line) {
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vector2d from = line[i == 0 ? 0 : i - 1], along = line[i] - from;
    const double length2 = along.squaredNorm();
    const double share =
        length2 > 0.0 ? std::clamp((point - from).dot(along) / length2, 0.0, 1.0) : 0.0;
    least_m = std::min(least_m, (point - from - share * along).norm());
  }
  return least_m;
}

double way_length_m(const Surface& lanelet) {
  double borders_m = 0.0;
  for (const auto* line : {&lanelet.left, &lanelet.right}) {
    for (std::size_t i = 1; i < line->size(); ++i)
      borders_m += ((*line)[i] - (*line)[i - 1]).norm();
  }
  return 0.5 * borders_m;
}

bool on_other_level(const Surface& a, const Surface& b) {
  constexpr double kHeadroom_m = 2.5;
  return a.least_z_m > b.greatest_z_m + kHeadroom_m || b.least_z_m > a.greatest_z_m + kHeadroom_m;
}

std::vector<std::pair<const Lanelet*, double>> conflicts(const VectorMap& map,
                                                         const Lanelet& lanelet) {
  // Surfaces that only touch overlap by rounding.
  constexpr double kLeast_m2 = 1e-4;
  std::vector<std::pair<const Lanelet*, double>> found;
  if (!lanelet.surface) return found;
  const Surface& surface = *lanelet.surface;
  for (const Lanelet* other : map.near(surface.box)) {
    if (other == &lanelet || !is_for_vehicles(*other) || on_other_level(surface, *other->surface) ||
        follow_each_other(lanelet, *other) || are_neighbours(map, lanelet, *other)) {
      continue;
    }
    const double area_m2 = overlap_m2(map, surface.ring, other->surface->ring);
    if (area_m2 > kLeast_m2) found.emplace_back(other, area_m2 / surface.area_m2);
  }
  return found;
}

std::optional<std::string> region_fault(const VectorMap& map, const Way& way) {
  if (way.references > way.nodes.size()) return {};  // some of its nodes are nowhere
  Line2 ring = plan_of(map, way);
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  if (ring.size() < 3) return "it has fewer than three corners";
  const auto fault = geometry::find_fault({ring, {}});
  if (!fault) return {};
  return fault->what;
}

}  // namespace roadbed::map::lanelet2::autoware
