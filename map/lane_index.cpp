#include "roadbed/map/lane_index.h"

#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace roadbed::map {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::point<double, 2, bg::cs::cartesian>;
using Box = bg::model::box<Point>;

// A few segments of a lane's centreline: [first, last) segment indices.
struct Stretch {
  LaneId lane;
  std::size_t first = 0, last = 0;
};
using Entry = std::pair<Box, Stretch>;

constexpr std::size_t kSegmentsPerStretch = 16;

// How far the borders reach from the centreline's points of the same station.
double reach_m(const Lane& lane) {
  double reach = 0.0;
  for (const LaneLine* line : {&lane.left, &lane.right}) {
    for (std::size_t i = 0; i < line->station_m.size(); ++i) {
      const Eigen::Vector2d centre = lane.centre.in_map.at(line->station_m[i]);
      reach = std::max(reach, (line->in_map.points()[i] - centre).norm());
    }
  }
  return reach;
}

void add_stretches(const Lane& lane, std::vector<Entry>& entries) {
  const auto& points = lane.centre.in_map.points();
  const double margin_m = reach_m(lane) + 1e-3;
  for (std::size_t first = 0; first + 1 < points.size(); first += kSegmentsPerStretch) {
    const std::size_t last = std::min(first + kSegmentsPerStretch, points.size() - 1);
    Eigen::Vector2d low = points[first], high = points[first];
    for (std::size_t i = first; i <= last; ++i) {
      low = low.cwiseMin(points[i]);
      high = high.cwiseMax(points[i]);
    }
    entries.push_back({Box(Point(low.x() - margin_m, low.y() - margin_m),
                           Point(high.x() + margin_m, high.y() + margin_m)),
                       Stretch{lane.id, first, last}});
  }
}

double squared_distance(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                        const Eigen::Vector2d& point, double& share) {
  const Eigen::Vector2d along = b - a;
  const double squared = along.squaredNorm();
  share = squared > 0.0 ? std::clamp((point - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (point - a - share * along).squaredNorm();
}

struct Foot {
  double squared_m2 = std::numeric_limits<double>::infinity();
  std::size_t segment = 0;
  double share = 0.0;
};

void improve(Foot& best, const Lane& lane, const Stretch& stretch, const Eigen::Vector2d& point) {
  const auto& points = lane.centre.in_map.points();
  for (std::size_t i = stretch.first; i < stretch.last; ++i) {
    double share = 0.0;
    const double squared = squared_distance(points[i], points[i + 1], point, share);
    if (squared < best.squared_m2) best = {squared, i, share};
  }
}

double distance_to_ring_m(const geometry::Ring& ring, const Eigen::Vector2d& point) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    double share = 0.0;
    best = std::min(best, squared_distance(ring[i], ring[(i + 1) % ring.size()], point, share));
  }
  return std::sqrt(best);
}

LaneMatch match(const Lane& lane, const Foot& foot, const Eigen::Vector2d& point) {
  const auto& points = lane.centre.in_map.points();
  const auto& stations = lane.centre.in_map.stations_m();
  const Eigen::Vector2d along = points[foot.segment + 1] - points[foot.segment];
  const Eigen::Vector2d to_point = point - points[foot.segment];
  const double side = along.x() * to_point.y() - along.y() * to_point.x() < 0.0 ? -1.0 : 1.0;
  const double s_m =
      stations[foot.segment] + foot.share * (stations[foot.segment + 1] - stations[foot.segment]);
  const bool inside = geometry::contains(lane.polygon, point);
  return {{lane.id, s_m, side * std::sqrt(foot.squared_m2)},
          inside ? 0.0 : distance_to_ring_m(lane.polygon, point),
          std::atan2(along.y(), along.x())};
}

}  // namespace

struct LaneIndex::Tree {
  bg::index::rtree<Entry, bg::index::quadratic<16>> boxes;
};

LaneIndex::LaneIndex(const std::vector<Lane>& lanes) {
  std::vector<Entry> entries;
  for (const Lane& lane : lanes) {
    if (lane.polygon.size() >= 3) add_stretches(lane, entries);
  }
  tree_ = std::make_unique<const Tree>(
      Tree{bg::index::rtree<Entry, bg::index::quadratic<16>>(entries)});
}

LaneIndex::~LaneIndex() = default;
LaneIndex::LaneIndex(LaneIndex&&) noexcept = default;
LaneIndex& LaneIndex::operator=(LaneIndex&&) noexcept = default;

std::vector<LaneMatch> LaneIndex::near(const std::vector<Lane>& lanes,
                                       const Eigen::Vector2d& point_in_map, double radius_m,
                                       const std::function<bool(const Lane&)>& filter) const {
  const Box around(Point(point_in_map.x() - radius_m, point_in_map.y() - radius_m),
                   Point(point_in_map.x() + radius_m, point_in_map.y() + radius_m));
  std::map<LaneId, Foot> feet;
  for (auto it = tree_->boxes.qbegin(bg::index::intersects(around)); it != tree_->boxes.qend();
       ++it) {
    const Lane& lane = lanes[it->second.lane.index];
    if (filter(lane)) improve(feet[lane.id], lane, it->second, point_in_map);
  }
  std::vector<LaneMatch> matches;
  for (const auto& [id, foot] : feet) {
    const LaneMatch found = match(lanes[id.index], foot, point_in_map);
    if (found.distance_m <= radius_m) matches.push_back(found);
  }
  return matches;
}

}  // namespace roadbed::map
