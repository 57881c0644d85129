#include "roadbed/geometry/polygons/polygon.h"

#include <algorithm>
#include <cmath>

#include "roadbed/geometry/polygons/exact.h"

namespace roadbed::geometry::inline polygons {
namespace {

std::optional<std::string> fault_of(const Ring& ring) {
  if (!std::all_of(ring.begin(), ring.end(), [](const auto& p) { return p.allFinite(); })) {
    return "a point is not finite";
  }
  if (ring.size() < 3) return "it has fewer than three different points";
  if (!is_simple(ring)) return "its edges cross or it passes a point twice";
  if (signed_area_m2(ring) == 0.0) return "it encloses nothing";
  return {};
}

Ring turned(const Ring& ring, bool counter_clockwise) {
  Ring result = ring;
  if ((signed_area_m2(ring) > 0.0) != counter_clockwise) {
    std::reverse(result.begin(), result.end());
  }
  return result;
}

/// Whether taking the holes out of the outer ring leaves the difference of their areas. A hole
/// that reaches outside, or over another one, is wound around the wrong way there and counts.
bool holes_fit(const Ring& outer, const std::vector<Ring>& holes) {
  std::vector<Ring> rings{outer};
  rings.insert(rings.end(), holes.begin(), holes.end());
  double expected_m2 = 0.0, found_m2 = 0.0;
  for (const Ring& ring : rings) expected_m2 += signed_area_m2(ring);
  for (const auto& part : exact::wound_region(rings)) {
    for (const Ring& ring : part) found_m2 += signed_area_m2(ring);
  }
  constexpr double relative = 1e-9;
  return std::abs(found_m2 - expected_m2) <= relative * signed_area_m2(outer);
}

}  // namespace

std::optional<PolygonFault> find_fault(const Polygon& polygon) {
  if (const auto what = fault_of(polygon.outer)) return PolygonFault{0, *what};
  std::vector<Ring> holes;
  for (std::size_t i = 0; i < polygon.holes.size(); ++i) {
    if (const auto what = fault_of(polygon.holes[i])) return PolygonFault{i + 1, *what};
    holes.push_back(turned(polygon.holes[i], false));
  }
  if (holes.empty()) return {};
  const Ring outer = turned(polygon.outer, true);
  if (holes_fit(outer, holes)) return {};
  for (std::size_t i = 0; i < holes.size(); ++i) {
    if (!holes_fit(outer, {holes[i]})) return PolygonFault{i + 1, "it lies outside the outer ring"};
    const auto before = holes.begin() + static_cast<std::ptrdiff_t>(i);
    if (!holes_fit(outer, {holes.begin(), before + 1})) {
      return PolygonFault{i + 1, "it overlaps another hole"};
    }
  }
  return PolygonFault{holes.size(), "it overlaps another hole"};
}

}  // namespace roadbed::geometry::polygons
