#include "roadbed/map/elements/lane_ring.h"

#include <algorithm>
#include <vector>

namespace roadbed::map::inline elements {
geometry::Ring simple_ring(geometry::Ring ring) {
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  if (ring.size() < 3) return {};
  if (geometry::signed_area_m2(ring) < 0.0) std::reverse(ring.begin(), ring.end());
  if (geometry::signed_area_m2(ring) > 0.0 && geometry::is_simple(ring)) return ring;
  geometry::Ring largest;
  for (geometry::Polygon& part : geometry::make_simple(ring)) {
    if (largest.empty() ||
        geometry::signed_area_m2(part.outer) > geometry::signed_area_m2(largest)) {
      largest = std::move(part.outer);
    }
  }
  return largest;
}

geometry::Ring lane_ring(const geometry::Polyline& left_in_map,
                         const geometry::Polyline& right_in_map) {
  geometry::Ring ring = right_in_map.points();
  ring.insert(ring.end(), left_in_map.points().rbegin(), left_in_map.points().rend());
  return simple_ring(std::move(ring));
}

}  // namespace roadbed::map::elements
