#include "roadbed/planning/audit/surface/drive_level.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace roadbed::planning::inline audit {
namespace {

using map::LaneId;
using map::LaneMatch;
using map::RoadMap;

constexpr double kSameLevel_m = 2.0, kRise = 0.15;
constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

double height_m(const RoadMap& road_map, const LaneMatch& match) {
  return map::Lane::height_at(road_map.lane(match.place.lane).centre, match.place.s_m);
}

bool is_of_one_level(const RoadMap& road_map, const std::set<LaneId>& lanes) {
  double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
  for (const LaneId lane : lanes) {
    for (const double z_m : road_map.lane(lane).centre.z_m) {
      low_m = std::min(low_m, z_m);
      high_m = std::max(high_m, z_m);
    }
  }
  return !(high_m - low_m > kSameLevel_m);
}

/// The heights of a drive that begins at one of them, a pose each.
struct Level {
  std::vector<double> z_m;
  std::size_t on_lanes = 0;  ///< poses with a lane under them
};

class LevelFinder {
 public:
  LevelFinder(const RoadMap& road_map, const std::vector<geometry::Pose2>& poses)
      : road_map_(road_map), poses_(poses) {
    for (const geometry::Pose2& pose : poses) points_.push_back(pose.position());
    under_ = road_map.locate(points_, 0.0, kAll, false);
  }

  /// Empty where the drive is on no lane at all.
  std::vector<double> heights_m() const {
    Level best;
    for (const double start_m : starts_m()) {
      Level level = follow(start_m);
      if (level.on_lanes > best.on_lanes) best = std::move(level);
    }
    return best.z_m;
  }

  const std::vector<Eigen::Vector2d>& points() const { return points_; }

 private:
  // Those of lanes along the drive first.
  std::vector<double> starts_m() const {
    std::size_t first = 0;
    while (first < poses_.size() && under_.of(first).empty()) ++first;
    std::vector<double> starts;
    if (first == poses_.size()) return starts;
    for (const bool along : {true, false}) {
      for (const LaneMatch& match : under_.of(first)) {
        const double turned_rad =
            std::remainder(match.heading_rad - poses_[first].heading_rad, std::numbers::pi);
        if ((std::abs(turned_rad) < 0.25 * std::numbers::pi) != along) continue;
        const double z_m = height_m(road_map_, match);
        const auto is_same = [&](double other_m) { return std::abs(other_m - z_m) < kSameLevel_m; };
        if (std::ranges::none_of(starts, is_same)) starts.push_back(z_m);
      }
    }
    return starts;
  }

  Level follow(double z_m) const {
    Level level;
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      double next_m = z_m, least_m = kSameLevel_m;
      for (const LaneMatch& match : under_.of(i)) {
        const double off_m = std::abs(height_m(road_map_, match) - z_m);
        if (!(off_m < least_m)) continue;
        least_m = off_m;
        next_m = height_m(road_map_, match);
      }
      level.on_lanes += least_m < kSameLevel_m ? 1 : 0;
      z_m = next_m;
      level.z_m.push_back(z_m);
    }
    return level;
  }

  const RoadMap& road_map_;
  const std::vector<geometry::Pose2>& poses_;
  std::vector<Eigen::Vector2d> points_;
  map::LaneMatches under_;
};

}  // namespace

std::set<LaneId> lanes_on_level(const RoadMap& road_map, std::set<LaneId> lanes,
                                const std::vector<geometry::Pose2>& map_from_vehicle,
                                double within_m) {
  if (is_of_one_level(road_map, lanes)) return lanes;
  const LevelFinder finder(road_map, map_from_vehicle);
  const std::vector<double> heights_m = finder.heights_m();
  if (heights_m.empty()) return lanes;
  std::set<LaneId> on_level, off_level;
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    for (const LaneMatch& match : road_map.locate(finder.points()[i], within_m, false)) {
      const double allowed_m = kSameLevel_m + kRise * match.distance_m;
      const bool is_off = std::abs(height_m(road_map, match) - heights_m[i]) > allowed_m;
      (is_off ? off_level : on_level).insert(match.place.lane);
    }
  }
  std::erase_if(lanes,
                [&](LaneId lane) { return off_level.contains(lane) && !on_level.contains(lane); });
  return lanes;
}

}  // namespace roadbed::planning::audit
