#include "roadbed/planning/audit/deepest_overlap.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline audit {
namespace {

constexpr double kMomentsApart_m = 0.1;
constexpr double kMostMoments = 100.0, kMostInAll = 5000.0;

geometry::Ring ring_of(const geometry::Rectangle& rectangle) {
  const auto corners = rectangle.corners();
  return {corners.begin(), corners.end()};
}

geometry::Ring ring_of(const map::Box2& box) {
  return geometry::box_ring(box.min_in_source, box.max_in_source);
}

}  // namespace

const ObstacleInSource* find_mover(std::span<const ObstacleInSource> moving,
                                   const std::string& id) {
  if (id.empty()) return nullptr;
  const auto found = std::ranges::find(moving, id, &ObstacleInSource::id);
  return found == moving.end() ? nullptr : &*found;
}

DeepestOverlapSearch::DeepestOverlapSearch(const map::ClearanceField& field,
                                           const ClearanceProbe& probe,
                                           const geometry::BodyPart& part,
                                           std::vector<map::ObstacleKind> kinds,
                                           std::span<const ObstacleInSource> moving,
                                           std::size_t conflicts)
    : field_(field),
      probe_(probe),
      part_(part),
      kinds_(std::move(kinds)),
      moving_(moving),
      most_moments_(
          std::clamp(kMostInAll / static_cast<double>(std::max<std::size_t>(1, conflicts)), 1.0,
                     kMostMoments)) {}

// The moment at which the conflict is least clear is one of them; of what moves, the others are as
// far apart in time, as the body may stand.
std::vector<double> DeepestOverlapSearch::moments_s(const Conflict& conflict) const {
  const double from_m = probe_.moved_at_m(conflict.from_s), to_m = probe_.moved_at_m(conflict.to_s);
  const bool moves = !conflict.obstacle.empty();
  const double count =
      moves ? most_moments_
            : std::min(most_moments_, std::ceil((to_m - from_m) / kMomentsApart_m) + 1.0);
  std::vector<double> moments{conflict.at.t_s};
  for (double i = 0.0; i < count; ++i) {
    const double fraction = count > 1.0 ? i / (count - 1.0) : 0.5;
    if (moves) {
      moments.push_back(conflict.from_s + fraction * (conflict.to_s - conflict.from_s));
    } else {
      const auto [segment, of_segment] = probe_.place_moved(from_m + fraction * (to_m - from_m));
      moments.push_back(probe_.time_at(segment, of_segment));
    }
  }
  return moments;
}

geometry::Overlap DeepestOverlapSearch::with_cells(const geometry::TrajectoryPoint& state) const {
  const geometry::Ring body = part_.outline_at(state.pose());
  geometry::Overlap all;
  for (const map::ObstacleKind kind : kinds_) {
    for (const map::Box2& box : field_.boxes_at(part_.box_at(state.pose()), kind)) {
      const geometry::Overlap one = geometry::convex_overlap(body, ring_of(box));
      all.depth_m = std::max(all.depth_m, one.depth_m);
      all.area_m2 += one.area_m2;
    }
  }
  return all;
}

geometry::Overlap DeepestOverlapSearch::with(const ObstacleInSource& mover,
                                             const geometry::TrajectoryPoint& state) const {
  return geometry::convex_overlap(part_.outline_at(state.pose()),
                                  ring_of(rectangle_at(mover, state.t_s)));
}

DeepestOverlap DeepestOverlapSearch::of(const Conflict& conflict) const {
  const ObstacleInSource* mover = find_mover(moving_, conflict.obstacle);
  DeepestOverlap deepest{.overlap = {}, .at_s = conflict.at.t_s};
  for (const double t_s : moments_s(conflict)) {
    const geometry::TrajectoryPoint state = probe_.state_at_time(t_s);
    const geometry::Overlap overlap = mover ? with(*mover, state) : with_cells(state);
    if (overlap.depth_m > deepest.overlap.depth_m) deepest = {overlap, t_s};
  }
  return deepest;
}

}  // namespace roadbed::planning::audit
