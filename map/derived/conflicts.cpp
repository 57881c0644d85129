#include "roadbed/map/derived/conflicts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/derived/crowded.h"
#include "roadbed/map/derived/lane_piece.h"
#include "roadbed/map/index/road_map_index.h"

namespace roadbed::map::inline derived {
namespace {

using Eigen::Vector2d;
using geometry::Box;
using geometry::Ring;

/// Station of the cross-section through a point of the piece: the fraction u of the way with
/// (p − l(u)) × (r(u) − l(u)) = 0, where l and r go straight along the borders.
double station_of(const LanePiece& piece, const Vector2d& point) {
  const Vector2d to_point = point - piece.left_from, along = piece.left_to - piece.left_from;
  const Vector2d across = piece.right_from - piece.left_from;
  const Vector2d widening = piece.right_to - piece.left_to - across;
  const double a = -geometry::cross(along, widening);
  const double b = geometry::cross(to_point, widening) - geometry::cross(along, across);
  const double c = geometry::cross(to_point, across);
  const double root = std::sqrt(std::max(b * b - 4.0 * a * c, 0.0));
  const double q = -0.5 * (b + std::copysign(root, b));  // without cancellation
  const double one = a != 0.0 ? q / a : 0.5, other = q != 0.0 ? c / q : 0.5;
  const auto outside = [](double u) { return std::max({-u, u - 1.0, 0.0}); };
  const double fraction = std::clamp(outside(other) <= outside(one) ? other : one, 0.0, 1.0);
  return piece.range.from_s_m + fraction * (piece.range.to_s_m - piece.range.from_s_m);
}

using Triangle = std::array<Vector2d, 3>;

std::array<Triangle, 2> triangles(const LanePiece& piece) {
  std::array<Triangle, 2> both{{{piece.left_from, piece.right_from, piece.right_to},
                                {piece.left_from, piece.right_to, piece.left_to}}};
  for (Triangle& triangle : both) {
    const double turn = geometry::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    if (turn < 0.0) std::swap(triangle[1], triangle[2]);
  }
  return both;
}

/// What of a convex ring is to the left of a line (Sutherland and Hodgman 1974,
/// doi:10.1145/360767.360802).
Ring clipped(const Ring& ring, const Vector2d& from, const Vector2d& to) {
  Ring kept;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const double side_a = geometry::cross(to - from, a - from),
                 side_b = geometry::cross(to - from, b - from);
    if (side_a >= 0.0) kept.push_back(a);
    if ((side_a > 0.0 && side_b < 0.0) || (side_a < 0.0 && side_b > 0.0)) {
      kept.push_back(a + side_a / (side_a - side_b) * (b - a));
    }
  }
  return kept;
}

Ring intersection(const Triangle& one, const Triangle& other) {
  Ring ring(one.begin(), one.end());
  for (std::size_t i = 0; i < 3 && !ring.empty(); ++i) {
    ring = clipped(ring, other[i], other[(i + 1) % 3]);
  }
  return ring;
}

/// A connected overlap of two lanes while it is put together.
struct Overlap {
  StationRange on_one, on_other;
  double area_m2;
  Box box;
};

void extend(StationRange& range, const StationRange& by) {
  range.from_s_m = std::min(range.from_s_m, by.from_s_m);
  range.to_s_m = std::max(range.to_s_m, by.to_s_m);
}

bool touch(const StationRange& a, const StationRange& b) {
  constexpr double kRounding_m = 1e-6;
  return a.from_s_m <= b.to_s_m + kRounding_m && b.from_s_m <= a.to_s_m + kRounding_m;
}

/// Joins the new overlap with all those that it touches on both lanes.
void add_overlap(Overlap added, std::vector<Overlap>& overlaps) {
  const auto apart = std::partition(overlaps.begin(), overlaps.end(), [&](const Overlap& known) {
    return !touch(known.on_one, added.on_one) || !touch(known.on_other, added.on_other);
  });
  for (auto it = apart; it != overlaps.end(); ++it) {
    extend(added.on_one, it->on_one);
    extend(added.on_other, it->on_other);
    added.area_m2 += it->area_m2;
    added.box.extend(it->box);
  }
  overlaps.erase(apart, overlaps.end());
  overlaps.push_back(added);
}

void add_overlaps(const LanePiece& one, const LanePiece& other, std::vector<Overlap>& overlaps) {
  for (const Triangle& of_one : triangles(one)) {
    for (const Triangle& of_other : triangles(other)) {
      const Ring ring = intersection(of_one, of_other);
      const double area_m2 = geometry::signed_area_m2(ring);
      if (ring.size() < 3 || area_m2 <= 0.0) continue;
      const double s_one = station_of(one, ring[0]), s_other = station_of(other, ring[0]);
      Overlap overlap{{s_one, s_one}, {s_other, s_other}, area_m2, geometry::box_around(ring)};
      for (const Vector2d& point : ring) {
        const double on_one = station_of(one, point), on_other = station_of(other, point);
        extend(overlap.on_one, {on_one, on_one});
        extend(overlap.on_other, {on_other, on_other});
      }
      add_overlap(overlap, overlaps);
    }
  }
}

bool has(const std::vector<LaneId>& lanes, LaneId id) {
  return std::find(lanes.begin(), lanes.end(), id) != lanes.end();
}

bool are_linked(const LaneLinks& links, LaneId other) {
  const auto beside = [&](const std::optional<Neighbour>& neighbour) {
    return neighbour && neighbour->lane == other;
  };
  return has(links.successors, other) || has(links.predecessors, other) || beside(links.left) ||
         beside(links.right);
}

bool share_any(const std::vector<LaneId>& one, const std::vector<LaneId>& other) {
  return std::any_of(one.begin(), one.end(), [&](LaneId id) { return has(other, id); });
}

ConflictKind kind_of(const LaneLinks& one, const LaneLinks& other) {
  if (share_any(one.successors, other.successors)) return ConflictKind::merging;
  if (share_any(one.predecessors, other.predecessors)) return ConflictKind::diverging;
  return ConflictKind::crossing;
}

using OverlapsByPair = std::map<std::pair<LaneId, LaneId>, std::vector<Overlap>>;

/// Whether two lanes may be in conflict: neither follows the other, and they are not beside each
/// other. Links of real files are one-sided.
bool are_apart(const LaneGraph& graph, LaneId one, LaneId other) {
  return !are_linked(graph.of(one), other) && !are_linked(graph.of(other), one);
}

/// @param is_asked  which pairs of lanes to look at, the lesser first.
template <typename IsAsked>
OverlapsByPair overlaps_of(const LaneGraph& graph, const std::vector<LanePiece>& pieces,
                           double headroom_m, const IsAsked& is_asked) {
  std::vector<Box> boxes;
  boxes.reserve(pieces.size());
  for (const LanePiece& piece : pieces) boxes.push_back(piece.box());
  const geometry::BoxTree tree(boxes);
  OverlapsByPair overlaps;
  constexpr std::size_t kStepsOfPair = 5;  // it is kept, which takes some 300 bytes
  geometry::WorkBudget kept(geometry::most_steps(pieces.size()));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const LanePiece& one = pieces[i];
    tree.visit(boxes[i], [&](std::size_t index) {
      const LanePiece& other = pieces[index];
      if (other.lane <= one.lane || !is_asked(one.lane, other.lane)) return;
      if (!are_apart(graph, one.lane, other.lane)) return;
      if (std::abs(one.z_m - other.z_m) > headroom_m) return;
      const auto [pair, is_new] = overlaps.try_emplace({one.lane, other.lane});
      if (is_new && !kept.spend(kStepsOfPair)) {
        refuse_crowded("conflicts", "so many lanes lie over each other");
      }
      add_overlaps(one, other, pair->second);
    });
  }
  return overlaps;
}

std::vector<Conflict> conflicts_of(const LaneGraph& graph, OverlapsByPair by_pair,
                                   double least_width_m) {
  std::vector<Conflict> conflicts;
  for (auto& [pair, overlaps] : by_pair) {
    const auto& [one, other] = pair;
    std::sort(overlaps.begin(), overlaps.end(), [](const Overlap& a, const Overlap& b) {
      return a.on_one.from_s_m < b.on_one.from_s_m;
    });
    for (const Overlap& overlap : overlaps) {
      if (overlap.area_m2 < least_width_m * overlap.box.diagonal().norm()) continue;
      conflicts.push_back({one, other, kind_of(graph.of(one), graph.of(other)), overlap.on_one,
                           overlap.on_other, overlap.area_m2});
    }
  }
  return conflicts;
}

}  // namespace

std::vector<Conflict> find_conflicts(const RoadMap& road_map, const ConflictOptions& options) {
  const auto any = [](LaneId, LaneId) { return true; };
  return conflicts_of(
      road_map.graph(),
      overlaps_of(road_map.graph(), drivable_pieces(road_map), options.headroom_m, any),
      options.least_width_m);
}

std::vector<Conflict> find_conflicts_of(const RoadMap& road_map, LaneId lane,
                                        const ConflictOptions& options) {
  if (road_map.lane(lane).polygon.empty()) return {};
  const Box box = geometry::box_around(road_map.lane(lane).polygon);
  const std::vector<LanePiece> pieces = drivable_pieces(
      road_map, road_map.index().lanes.in_box(box.min(), box.max(), LaneTypes::drivable()));
  const auto with_lane = [&](LaneId one, LaneId other) { return one == lane || other == lane; };
  return conflicts_of(road_map.graph(),
                      overlaps_of(road_map.graph(), pieces, options.headroom_m, with_lane),
                      options.least_width_m);
}

}  // namespace roadbed::map::derived
