#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <vector>

#include "roadbed/geometry/polygons/ring.h"
#include "roadbed/planning/audit/surface/road_surface.h"

namespace roadbed::tools::inline audit {

/// Surfaces that were made last. Drives along one way have the same polygons around them, and a
/// union takes longer than the audit on it. Threads may ask at the same time.
class KeptSurfaces {
 public:
  static constexpr std::size_t kMost = 8;

  /// As `planning::road_surface`, whose result depends on nothing else. Throws as it does.
  std::shared_ptr<const planning::RoadSurface> of(std::vector<geometry::Polygon> polygons_in_source,
                                                  double seam_m);

 private:
  struct Kept {
    std::vector<geometry::Polygon> polygons;
    double seam_m;
    std::shared_ptr<const planning::RoadSurface> surface;
  };

  std::shared_ptr<const planning::RoadSurface> found(const std::vector<geometry::Polygon>& polygons,
                                                     double seam_m);

  std::mutex mutex_;
  std::list<Kept> kept_;  // the last used first
};

}  // namespace roadbed::tools::audit
