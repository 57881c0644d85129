#include "roadbed/geometry/polygons/polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/geometry/index/hilbert.h"
#include "roadbed/geometry/polygons/exact.h"
#include "roadbed/geometry/polygons/ring.h"
#include "roadbed/geometry/polygons/ring_crossings.h"
#include "roadbed/geometry/primitives/work_limit.h"

namespace roadbed::geometry::inline polygons {
namespace {

using Eigen::Vector2d;

bool all_finite(const Ring& ring) {
  return std::all_of(ring.begin(), ring.end(), [](const Vector2d& p) { return p.allFinite(); });
}

void check_finite(const Ring& ring, const char* function) {
  if (!all_finite(ring)) {
    throw std::invalid_argument(fmt::format("{}: a ring has a point that is not finite", function));
  }
}

/// Cuts a ring where it comes back to a point, so that each piece passes every point once.
std::vector<Ring> cut_at_repeats(const Ring& ring) {
  std::vector<Ring> pieces;
  Ring path;
  std::map<std::pair<double, double>, std::size_t> place;
  for (const Vector2d& point : ring) {
    const auto [found, is_new] = place.try_emplace({point.x(), point.y()}, path.size());
    if (is_new) {
      path.push_back(point);
      continue;
    }
    const auto start = path.begin() + static_cast<std::ptrdiff_t>(found->second);
    pieces.emplace_back(start, path.end());
    for (auto it = start + 1; it != path.end(); ++it) place.erase({it->x(), it->y()});
    path.erase(start + 1, path.end());
  }
  pieces.push_back(std::move(path));
  return pieces;
}

/// Without the vertices that lie exactly between their neighbours or form a spike.
Ring without_collinear(const Ring& ring) {
  Ring kept;
  for (const Vector2d& point : ring) {
    while (kept.size() > 1 && exact::turn(kept[kept.size() - 2], kept.back(), point) == 0) {
      kept.pop_back();
    }
    kept.push_back(point);
  }
  while (kept.size() > 2 && exact::turn(kept[kept.size() - 2], kept.back(), kept.front()) == 0) {
    kept.pop_back();
  }
  while (kept.size() > 2 && exact::turn(kept.back(), kept[0], kept[1]) == 0) {
    kept.erase(kept.begin());
  }
  return kept;
}

bool lexicographic(const Vector2d& a, const Vector2d& b) {
  return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
}

void start_at_lowest(Ring& ring) {
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), lexicographic), ring.end());
}

bool contains_all(const Ring& outer, const Ring& hole) {
  return std::all_of(hole.begin(), hole.end(), [&](const auto& p) { return contains(outer, p); });
}

/// Gives each hole to the smallest outer ring around it.
std::vector<Polygon> assemble(std::vector<Ring> outers, std::vector<Ring> holes) {
  std::stable_sort(outers.begin(), outers.end(), [](const Ring& a, const Ring& b) {
    return signed_area_m2(a) < signed_area_m2(b);
  });
  std::vector<Polygon> polygons;
  for (Ring& outer : outers) polygons.push_back({std::move(outer), {}});
  for (Ring& hole : holes) {
    const auto around = std::find_if(polygons.begin(), polygons.end(), [&](const Polygon& p) {
      return polygons.size() == 1 || contains_all(p.outer, hole);
    });
    if (around != polygons.end()) around->holes.push_back(std::move(hole));
  }
  return polygons;
}

std::vector<Polygon> part_polygons(const std::vector<Ring>& boundaries) {
  std::vector<Ring> outers, holes;
  for (const Ring& boundary : boundaries) {
    for (const Ring& piece : cut_at_repeats(boundary)) {
      Ring ring = without_collinear(piece);
      if (ring.size() < 3) continue;
      start_at_lowest(ring);
      (signed_area_m2(ring) > 0.0 ? outers : holes).push_back(std::move(ring));
    }
  }
  return assemble(std::move(outers), std::move(holes));
}

void sort_polygons(std::vector<Polygon>& polygons) {
  const auto ring_before = [](const Ring& a, const Ring& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), lexicographic);
  };
  for (Polygon& polygon : polygons) {
    std::sort(polygon.holes.begin(), polygon.holes.end(), ring_before);
  }
  std::sort(polygons.begin(), polygons.end(),
            [&](const Polygon& a, const Polygon& b) { return ring_before(a.outer, b.outer); });
}

/// The region that the rings together wind around, its corners rounded to doubles.
std::vector<Polygon> wound_region(const std::vector<Ring>& rings) {
  std::vector<Polygon> polygons;
  for (const exact::Boundaries& part : exact::wound_region(rings)) {
    for (Polygon& polygon : part_polygons(part)) polygons.push_back(std::move(polygon));
  }
  sort_polygons(polygons);
  return polygons;
}

std::vector<Ring> rings_of(std::span<const Polygon> polygons) {
  std::vector<Ring> rings;
  for (const Polygon& polygon : polygons) {
    rings.push_back(polygon.outer);
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
  }
  return rings;
}

/// The same with simple rings. Rounding an exact corner can push it across an edge that is one unit
/// in the last place away; then the rounded region is taken once more. Each pass removes features
/// thinner than the rounding, so two passes have been enough on all maps tried.
std::vector<Polygon> simple_region(std::vector<Ring> rings) {
  constexpr int kMostPasses = 8;
  std::vector<Polygon> polygons;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    polygons = wound_region(rings);
    rings = rings_of(polygons);
    if (std::all_of(rings.begin(), rings.end(), is_simple)) break;
  }
  return polygons;
}

Ring oriented(Ring ring, bool counter_clockwise) {
  if ((signed_area_m2(ring) > 0.0) != counter_clockwise) std::reverse(ring.begin(), ring.end());
  return ring;
}

std::vector<Ring> oriented_rings(std::span<const Polygon> polygons) {
  std::vector<Ring> rings;
  for (const Polygon& polygon : polygons) {
    rings.push_back(oriented(polygon.outer, true));
    for (const Ring& hole : polygon.holes) rings.push_back(oriented(hole, false));
  }
  return rings;
}

/// Welding can fold a ring; what it then winds around backwards must not cancel other rings.
std::vector<Ring> without_folds(const std::vector<Ring>& rings) {
  std::vector<Ring> result;
  for (const Ring& ring : rings) {
    if (ring.empty()) continue;
    if (is_simple(ring)) {
      result.push_back(ring);
      continue;
    }
    const bool is_outer = signed_area_m2(ring) > 0.0;
    for (const Polygon& piece : wound_region({ring})) {
      result.push_back(oriented(piece.outer, is_outer));
      for (const Ring& hole : piece.holes) result.push_back(oriented(hole, !is_outer));
    }
  }
  return result;
}

/// Mean width of what a ring encloses.
double mean_width_m(const Ring& ring) {
  return 2.0 * std::abs(signed_area_m2(ring)) / perimeter_m(ring);
}

/// Takes out pieces, and closes holes, that are thinner than the weld distance.
void drop_thin(std::vector<Polygon>& polygons, double weld_m) {
  const auto is_thin = [&](const Ring& ring) { return mean_width_m(ring) < weld_m; };
  std::erase_if(polygons, [&](const Polygon& polygon) { return is_thin(polygon.outer); });
  for (Polygon& polygon : polygons) std::erase_if(polygon.holes, is_thin);
}

United unite_at_once(std::span<const Polygon> polygons, double weld_m) {
  const Welded welded = weld(oriented_rings(polygons), weld_m);
  United united{simple_region(without_folds(welded.rings)), welded.moved_points,
                welded.most_moved_m};
  drop_thin(united.polygons, weld_m);
  return united;
}

std::vector<Polygon> in_order_of_place(std::span<const Polygon> polygons) {
  std::vector<Box> boxes;
  Box all;
  for (const Polygon& polygon : polygons) {
    boxes.push_back(box_around(polygon.outer));
    all.extend(boxes.back());
  }
  std::vector<std::uint32_t> keys;
  for (const Box& box : boxes) keys.push_back(hilbert_key(all, box.center()));
  std::vector<Polygon> ordered;
  for (const std::uint32_t i : order_of_keys(keys)) ordered.push_back(polygons[i]);
  return ordered;
}

United unite_by_halves(std::span<const Polygon> polygons, double weld_m) {
  constexpr std::size_t kFew = 8;
  if (polygons.size() <= kFew) return unite_at_once(polygons, weld_m);
  const std::size_t middle = polygons.size() / 2;
  United one = unite_by_halves(polygons.first(middle), weld_m);
  United other = unite_by_halves(polygons.subspan(middle), weld_m);
  std::ranges::move(other.polygons, std::back_inserter(one.polygons));
  if (!have_few_crossings(rings_of(one.polygons))) {
    throw TooMuchWork("so many areas cross each other that their outline has endless corners");
  }
  United united = unite_at_once(one.polygons, weld_m);
  united.moved_points += one.moved_points + other.moved_points;
  united.most_moved_m = std::max({united.most_moved_m, one.most_moved_m, other.most_moved_m});
  return united;
}

bool is_on_edge(const Vector2d& a, const Vector2d& b, const Vector2d& point) {
  const bool in_box = (point.array() >= a.cwiseMin(b).array()).all() &&
                      (point.array() <= a.cwiseMax(b).array()).all();
  return in_box && exact::turn(a, b, point) == 0;
}

/// Whether a ray from the point to the right crosses the edge; its upper end is not part of it.
bool is_right_of(const Vector2d& a, const Vector2d& b, const Vector2d& point) {
  if ((a.y() > point.y()) == (b.y() > point.y())) return false;
  return exact::turn(a, b, point) == (b.y() > a.y() ? 1 : -1);
}

bool is_on_ring(const Ring& ring, const Vector2d& point) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (is_on_edge(ring[i], ring[(i + 1) % ring.size()], point)) return true;
  }
  return false;
}

}  // namespace

Ring box_ring(const Vector2d& least, const Vector2d& most) {
  return {least, {most.x(), least.y()}, most, {least.x(), most.y()}};
}

double signed_area_m2(const Ring& ring) {
  double twice_m2 = 0.0;
  for (std::size_t i = 2; i < ring.size(); ++i) {
    const Vector2d a = ring[i - 1] - ring[0], b = ring[i] - ring[0];
    twice_m2 += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice_m2;
}

double area_m2(const Polygon& polygon) {
  double area_m2 = std::abs(signed_area_m2(polygon.outer));
  for (const Ring& hole : polygon.holes) area_m2 -= std::abs(signed_area_m2(hole));
  return area_m2;
}

double perimeter_m(const Ring& ring) {
  double sum_m = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    sum_m += (ring[(i + 1) % ring.size()] - ring[i]).norm();
  }
  return sum_m;
}

RayCrossing crossing(const Vector2d& from, const Vector2d& to, const Vector2d& point) {
  if (is_on_edge(from, to, point)) return RayCrossing::on_edge;
  return is_right_of(from, to, point) ? RayCrossing::crosses : RayCrossing::misses;
}

bool contains(const Ring& ring, const Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const RayCrossing met = crossing(ring[i], ring[(i + 1) % ring.size()], point);
    if (met == RayCrossing::on_edge) return true;
    if (met == RayCrossing::crosses) inside = !inside;
  }
  return inside;
}

bool contains(const Polygon& polygon, const Vector2d& point) {
  if (!contains(polygon.outer, point)) return false;
  // A point on a hole's ring belongs to the region: it must not be strictly inside the hole.
  return std::none_of(polygon.holes.begin(), polygon.holes.end(), [&](const Ring& hole) {
    return contains(hole, point) && !is_on_ring(hole, point);
  });
}

bool is_simple(const Ring& ring) {
  if (ring.size() < 3 || !all_finite(ring)) return false;
  return is_surely_simple(ring) || exact::has_simple_edges(ring);
}

std::vector<Polygon> make_simple(const Ring& ring) {
  check_finite(ring, "make_simple");
  const std::vector<Ring> cleaned = weld({ring}, 0.0).rings;
  if (is_simple(cleaned.front())) return {{oriented(cleaned.front(), true), {}}};
  if (!has_few_crossings(cleaned.front())) return {};
  return simple_region(cleaned);
}

United unite_and_report(std::span<const Polygon> polygons, double weld_m) {
  for (const Ring& ring : rings_of(polygons)) check_finite(ring, "unite");
  if (have_few_crossings(rings_of(polygons))) return unite_at_once(polygons, weld_m);
  return unite_by_halves(in_order_of_place(polygons), weld_m);
}

std::vector<Polygon> unite(std::span<const Polygon> polygons, double weld_m) {
  return unite_and_report(polygons, weld_m).polygons;
}

}  // namespace roadbed::geometry::polygons
