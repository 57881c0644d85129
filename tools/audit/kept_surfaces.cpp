#include "roadbed/tools/audit/kept_surfaces.h"

#include <algorithm>
#include <utility>

namespace roadbed::tools::inline audit {
namespace {

bool are_alike(const geometry::Polygon& a, const geometry::Polygon& b) {
  return a.outer == b.outer && a.holes == b.holes;
}

}  // namespace

std::shared_ptr<const planning::RoadSurface> KeptSurfaces::of(
    std::vector<geometry::Polygon> polygons, double seam_m) {
  if (auto surface = found(polygons, seam_m)) return surface;
  auto made = std::make_shared<const planning::RoadSurface>(
      planning::road_surface(polygons, seam_m));  // by several threads at a time
  const std::lock_guard lock(mutex_);
  kept_.push_front({std::move(polygons), seam_m, made});
  if (kept_.size() > kMost) kept_.pop_back();
  return made;
}

std::shared_ptr<const planning::RoadSurface> KeptSurfaces::found(
    const std::vector<geometry::Polygon>& polygons, double seam_m) {
  const std::lock_guard lock(mutex_);
  const auto kept = std::ranges::find_if(kept_, [&](const Kept& one) {
    return one.seam_m == seam_m && std::ranges::equal(one.polygons, polygons, are_alike);
  });
  if (kept == kept_.end()) return nullptr;
  kept_.splice(kept_.begin(), kept_, kept);
  return kept_.front().surface;
}

}  // namespace roadbed::tools::audit
