#include "roadbed/map/derived/covered_area.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/primitives/work_limit.h"
#include "roadbed/map/files/in_threads.h"

namespace roadbed::map::inline derived {
namespace {

using Eigen::Vector2d;
using geometry::Box;
using geometry::Ring;

/// A ring's part in a window: of three points or more, which belong to somebody else.
struct RingPart {
  const Ring* ring;
  Box box;
  std::uint32_t group = GroupedRing::kNoGroup;
};

/// An edge that is not level, from its lower end to its upper one.
struct Edge {
  Vector2d low, high;
  std::uint32_t piece = 0;

  double x_at(double y) const {
    return low.x() + (y - low.y()) / (high.y() - low.y()) * (high.x() - low.x());
  }
};

/// Where an edge passes a slab's lower and upper side.
struct Passage {
  double low_x, high_x;
  std::uint32_t piece;
  double middle() const { return 0.5 * (low_x + high_x); }
};

/// What threads together have left of the steps that may be taken; negative where work grew beyond
/// its bounds.
struct Budget {
  std::atomic<std::int64_t> left;

  void spend(std::size_t steps) { left -= static_cast<std::int64_t>(steps); }
  bool is_spent() const { return left < 0; }
};

CoveredArea operator+(const CoveredArea& a, const CoveredArea& b) {
  return {a.all_m2 + b.all_m2, a.groups_m2 + b.groups_m2};
}

/// Adds up what is covered between two heights between which no edge ends.
class Slab {
 public:
  /// @param group_of  of each piece, less than `groups` or none.
  Slab(std::span<const std::uint32_t> group_of, std::size_t groups)
      : group_of_(group_of), is_inside_(group_of.size()), inside_(groups) {}

  /// Leaves the edges in the order in which they pass the middle of the slab, or of its lower part.
  CoveredArea area(std::vector<Passage>& edges, double height_m, int depth, Budget& budget) {
    budget.spend(edges.size() + 1);
    if (budget.is_spent()) return {};
    sort(edges);
    constexpr int kDeepest = 40;
    const std::optional<double> fraction = crossing(edges);
    if (!fraction || depth == kDeepest) {
      const CoveredArea width = width_m(edges);
      return {width.all_m2 * height_m, width.groups_m2 * height_m};
    }
    std::vector<Passage> upper = edges;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double x = edges[i].low_x + *fraction * (edges[i].high_x - edges[i].low_x);
      edges[i].high_x = upper[i].low_x = x;
    }
    const CoveredArea below = area(edges, *fraction * height_m, depth + 1, budget);
    return below + area(upper, (1.0 - *fraction) * height_m, depth + 1, budget);
  }

 private:
  /// They are nearly in order: those of the slab below were.
  static void sort(std::vector<Passage>& edges) {
    constexpr std::size_t kMany = 64;
    if (edges.size() > kMany) {
      std::ranges::sort(edges, {}, &Passage::middle);
      return;
    }
    for (std::size_t i = 1; i < edges.size(); ++i) {
      const Passage moved = edges[i];
      std::size_t at = i;
      for (; at > 0 && edges[at - 1].middle() > moved.middle(); --at) edges[at] = edges[at - 1];
      edges[at] = moved;
    }
  }

  /// Share of the height at which two edges next to each other cross, the most even of several.
  static std::optional<double> crossing(const std::vector<Passage>& edges) {
    constexpr double kLeast = 1e-6;
    std::optional<double> most_even;
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
      const double low = edges[i + 1].low_x - edges[i].low_x;
      const double high = edges[i + 1].high_x - edges[i].high_x;
      if (low >= 0.0 && high >= 0.0) continue;
      const double fraction = low / (low - high);
      if (!(fraction > kLeast && fraction < 1.0 - kLeast)) continue;
      if (!most_even || std::abs(fraction - 0.5) < std::abs(*most_even - 0.5)) most_even = fraction;
    }
    return most_even;
  }

  /// Mean widths covered, from edges in order.
  CoveredArea width_m(const std::vector<Passage>& edges) {
    CoveredArea width;
    std::size_t all = 0, groups = 0;  // how many pieces and groups cover the place before an edge
    double before = 0.0;
    for (const Passage& edge : edges) {
      const double x = edge.middle();
      if (all > 0) width.all_m2 += x - before;
      width.groups_m2 += static_cast<double>(groups) * (x - before);
      before = x;
      const bool enters = !is_inside_[edge.piece];
      is_inside_[edge.piece] = enters;
      enters ? ++all : --all;
      const std::uint32_t group = group_of_[edge.piece];
      if (group == GroupedRing::kNoGroup) continue;
      const std::size_t was = inside_[group];
      inside_[group] = enters ? was + 1 : was - 1;
      if (enters && was == 0) ++groups;
      if (!enters && was == 1) --groups;
    }
    return width;
  }

  std::span<const std::uint32_t> group_of_;
  std::vector<char> is_inside_;      // of each piece; all false again behind the last edge
  std::vector<std::size_t> inside_;  // how many pieces of each group
};

/// Numbers the groups of some pieces from 0.
struct LocalGroups {
  std::vector<std::uint32_t> group_of;  ///< of each piece
  std::size_t groups = 0;

  explicit LocalGroups(std::span<const RingPart> pieces) {
    std::vector<std::uint32_t> known;
    for (const RingPart& piece : pieces) {
      if (piece.group == GroupedRing::kNoGroup) {
        group_of.push_back(GroupedRing::kNoGroup);
        continue;
      }
      const auto found = std::ranges::find(known, piece.group);
      group_of.push_back(static_cast<std::uint32_t>(found - known.begin()));
      if (found == known.end()) known.push_back(piece.group);
    }
    groups = known.size();
  }
};

std::vector<Edge> edges_of(std::span<const RingPart> pieces) {
  std::vector<Edge> edges;
  for (std::uint32_t p = 0; p < pieces.size(); ++p) {
    const Ring& ring = *pieces[p].ring;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vector2d &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
      if (a.y() < b.y()) edges.push_back({a, b, p});
      if (b.y() < a.y()) edges.push_back({b, a, p});
    }
  }
  std::ranges::sort(edges, {}, [](const Edge& edge) { return edge.low.y(); });
  return edges;
}

std::vector<double> heights_of(const std::vector<Edge>& edges) {
  std::vector<double> heights;
  for (const Edge& edge : edges) heights.insert(heights.end(), {edge.low.y(), edge.high.y()});
  std::ranges::sort(heights);
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  return heights;
}

CoveredArea swept(std::span<const RingPart> pieces, Budget& budget) {
  const std::vector<Edge> edges = edges_of(pieces);
  const std::vector<double> heights = heights_of(edges);
  const LocalGroups local(pieces);
  Slab slab(local.group_of, local.groups);
  CoveredArea sum;
  std::vector<Edge> active;
  std::vector<Passage> passages;
  std::size_t next = 0;
  for (std::size_t i = 0; i + 1 < heights.size() && !budget.is_spent(); ++i) {
    const double low = heights[i], high = heights[i + 1];
    std::erase_if(active, [&](const Edge& edge) { return edge.high.y() <= low; });
    for (; next < edges.size() && edges[next].low.y() <= low; ++next) active.push_back(edges[next]);
    passages.clear();
    for (const Edge& edge : active) {
      passages.push_back({edge.x_at(low), edge.x_at(high), edge.piece});
    }
    const CoveredArea here = slab.area(passages, high - low, 0, budget);
    sum.all_m2 += here.all_m2;
    sum.groups_m2 += here.groups_m2;
  }
  return sum;
}

/// What of a ring lies on one side of a line along an axis (Sutherland and Hodgman 1974,
/// doi:10.1145/360767.360802); where it leaves and comes back its edges go along the line twice,
/// which covers nothing.
Ring part_beside(const Ring& ring, int axis, double at, bool above) {
  Ring kept;
  kept.reserve(ring.size() + 2);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector2d &a = ring[i], &b = ring[i + 1 < ring.size() ? i + 1 : 0];
    const bool a_in = above ? a[axis] >= at : a[axis] <= at;
    const bool b_in = above ? b[axis] >= at : b[axis] <= at;
    if (a_in) kept.push_back(a);
    if (a_in == b_in) continue;
    Vector2d cut = a + (at - a[axis]) / (b[axis] - a[axis]) * (b - a);
    cut[axis] = at;
    kept.push_back(cut);
  }
  return kept;
}

/// Pieces on either side of a line along an axis; holds the rings that it cut.
struct Halves {
  std::vector<RingPart> below, above;

  Halves(const std::vector<RingPart>& pieces, int axis, double at) {
    const auto is_cut = [&](const RingPart& piece) {
      return piece.box.min()[axis] < at && piece.box.max()[axis] > at;
    };
    rings_.reserve(2 * static_cast<std::size_t>(std::ranges::count_if(pieces, is_cut)));
    for (const RingPart& piece : pieces) {
      if (is_cut(piece)) {
        keep(part_beside(*piece.ring, axis, at, false), piece.group, below);
        keep(part_beside(*piece.ring, axis, at, true), piece.group, above);
      } else {
        (piece.box.max()[axis] <= at ? below : above).push_back(piece);
      }
    }
  }

 private:
  void keep(Ring part, std::uint32_t group, std::vector<RingPart>& side) {
    if (part.size() < 3) return;
    const Ring& ring = rings_.emplace_back(std::move(part));
    side.push_back({&ring, geometry::box_around(ring), group});
  }

  std::vector<Ring> rings_;
};

/// Whether a ring of at most four points turns one way only, so that it cannot cross itself.
bool is_convex(const geometry::Ring& ring) {
  if (ring.size() > 4) return false;
  int left = 0, right = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d& corner = ring[(i + 1) % ring.size()];
    const Eigen::Vector2d in = corner - ring[i], out = ring[(i + 2) % ring.size()] - corner;
    const double turn = in.x() * out.y() - in.y() * out.x();
    (turn < 0.0 ? right : left) += turn != 0.0;
  }
  return left == 0 || right == 0;
}

CoveredArea alone(const RingPart& piece) {
  const double area_m2 = std::abs(geometry::signed_area_m2(*piece.ring));
  return {area_m2, piece.group == GroupedRing::kNoGroup ? 0.0 : area_m2};
}

CoveredArea area_of(const std::vector<RingPart>& pieces, Budget& budget, int threads) {
  Box window;
  std::size_t points = 0;
  for (const RingPart& piece : pieces) {
    window.extend(piece.box);
    points += piece.ring->size();
  }
  budget.spend(points);
  if (pieces.empty() || budget.is_spent()) return {};
  if (pieces.size() == 1 && is_convex(*pieces.front().ring)) return alone(pieces.front());
  const int axis = window.sizes().x() >= window.sizes().y() ? 0 : 1;
  const double middle = window.center()[axis];
  constexpr std::size_t kFew = 80, kFewEach = 10;
  constexpr double kSmall_m = 0.05;
  const bool is_small = points <= kFew || window.sizes()[axis] < kSmall_m;
  // Halving brings nothing where most pieces are short and would be in both halves.
  const auto straddles = [&](const RingPart& piece) {
    return piece.box.min()[axis] < middle && middle < piece.box.max()[axis];
  };
  const bool is_bundle =
      points <= kFewEach * pieces.size() &&
      2 * static_cast<std::size_t>(std::ranges::count_if(pieces, straddles)) > pieces.size();
  if (is_small || is_bundle) return swept(pieces, budget);
  const Halves halves(pieces, axis, middle);
  if (threads < 2) return area_of(halves.below, budget, 1) + area_of(halves.above, budget, 1);
  std::array<CoveredArea, 2> areas;
  in_threads(2, threads, [&](std::size_t half) {
    areas[half] = area_of(half == 0 ? halves.below : halves.above, budget, threads / 2);
  });
  return areas[0] + areas[1];
}

}  // namespace

std::optional<CoveredArea> covered_area(const std::vector<GroupedRing>& rings, int threads) {
  std::vector<RingPart> pieces;
  std::size_t points = 0;
  for (const auto& [ring, group] : rings) {
    points += ring->size();
    if (ring->size() >= 3) pieces.push_back({ring, geometry::box_around(*ring), group});
  }
  Budget budget{static_cast<std::int64_t>(geometry::most_steps(points))};
  const CoveredArea area = area_of(pieces, budget, threads);
  if (budget.is_spent()) return std::nullopt;
  return area;
}

}  // namespace roadbed::map::derived
