#include "roadbed/map/opendrive/write/close_joints.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "roadbed/map/opendrive/write/clothoid.h"
#include "roadbed/map/opendrive/write/end_roles.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kClosed_m = 5e-4;    // a gap that is none
constexpr double kSameLine_m = 1e-3;  // between lines across ends that are one
constexpr double kRampPerGap = 5.0;   // length over which a border is led to the other
constexpr double kShortestRamp_m = 0.5;

/// Where a border of a lane meets the line across its road's end.
struct BorderEnd {
  std::uint32_t end;
  BesideLine* line;
  Eigen::Vector2d point, across;     // on the line, and along it to the left
  const geometry::Polyline* source;  // what the map says of it

  bool is_last() const { return end % 2 == 1; }
};

class JointCloser {
 public:
  JointCloser(const RoadMap& road_map, const RoadPlan& plan, std::vector<PlacedRoad>& placed)
      : road_map_(road_map), plan_(plan), placed_(placed), ends_(find_end_roles(road_map, plan)) {}

  void close() {
    collect();
    std::stable_sort(pairs_.begin(), pairs_.end(),
                     [](const Pair& a, const Pair& b) { return a.gap_m < b.gap_m; });
    for (const Pair& pair : pairs_) unite(pair.from, pair.to);
    for (const std::vector<std::size_t>& meeting : meetings_) {
      const Eigen::Vector2d point = meeting_point(meeting);
      for (const std::size_t i : meeting) {
        const double by_m = (point - borders_[i].point).dot(borders_[i].across);
        if (std::abs(by_m) > kClosed_m) lead(borders_[i], by_m);
      }
    }
  }

 private:
  /// Borders that lead into each other.
  struct Pair {
    std::size_t from, to;
    double gap_m;
  };

  // A road of the map has its own ends.
  void collect() {
    for (const auto& [ends, lanes] : ends_.joints) {
      const auto [from, to] = ends;
      if (plan_.roads[from / 2].source || plan_.roads[to / 2].source) continue;
      for (const auto& [leaving, entering] : lanes) {
        for (const bool on_left : {true, false}) {
          const std::size_t a = add(from, leaving, on_left), b = add(to, entering, on_left);
          const Eigen::Vector2d gap = borders_[b].point - borders_[a].point;
          const Eigen::Vector2d& across = borders_[a].across;
          if ((gap - gap.dot(across) * across).norm() > kSameLine_m) continue;
          pairs_.push_back({a, b, gap.norm()});
        }
      }
    }
  }

  std::size_t add(std::uint32_t end, LaneId id, bool on_left) {
    const BorderPlace place = plan_.border_of(id, on_left);
    PlacedRoad& road = placed_[place.road];
    BesideLine* line = &road.borders[place.section][place.border];
    const auto [found, is_new] = numbers_.emplace(std::pair(line, end % 2), borders_.size());
    if (!is_new) return found->second;
    const Lane& lane = road_map_.lane(id);
    const bool last = end % 2 == 1;
    const Eigen::Vector2d along = unit(road.end_pose(last).heading_rad);
    borders_.push_back({end,
                        line,
                        road.end_point(last, place.border),
                        {-along.y(), along.x()},
                        &(on_left ? lane.left : lane.right).in_map});
    meetings_.push_back({found->second});
    meeting_of_.push_back(found->second);
    return found->second;
  }

  // Unless two borders of one road would meet there: a lane that leads to several beside each other
  // cannot meet them all.
  void unite(std::size_t a, std::size_t b) {
    const std::size_t kept = meeting_of_[a], other = meeting_of_[b];
    if (kept == other) return;
    auto &into = meetings_[kept], &from = meetings_[other];
    for (const std::size_t i : into) {
      for (const std::size_t k : from) {
        if (borders_[i].end == borders_[k].end) return;
      }
    }
    for (const std::size_t i : from) meeting_of_[i] = kept;
    into.insert(into.end(), from.begin(), from.end());
    from.clear();
  }

  // That of the road before a fork, else the one that is nearest to what the map says.
  Eigen::Vector2d meeting_point(const std::vector<std::size_t>& meeting) const {
    Eigen::Vector2d best(0, 0);
    double least_m = 1e300;
    for (const std::size_t i : meeting) {
      const Eigen::Vector2d& point = borders_[i].point;
      double off_m = 1e300;
      for (const std::size_t k : meeting) {
        off_m = std::min(off_m, std::abs(borders_[k].source->project(point).d_m));
      }
      if (ends_.roles[borders_[i].end] == EndRole::hub) return point;
      if (off_m >= least_m) continue;
      least_m = off_m;
      best = point;
    }
    return best;
  }

  static void lead(const BorderEnd& end, double by_m) {
    BesideLine& line = *end.line;
    const bool at_end = end.is_last();
    const double end_s_m = at_end ? line.back().s_m : line.front().s_m;
    const double length_m = line.back().s_m - line.front().s_m;
    const double ramp_m =
        std::min(0.5 * length_m, std::max(kShortestRamp_m, kRampPerGap * std::abs(by_m)));
    const double ramp_s_m = end_s_m + (at_end ? -ramp_m : ramp_m);
    const auto after =
        std::find_if(line.begin(), line.end(), [&](const auto& p) { return p.s_m >= ramp_s_m; });
    if (after != line.end() && after->s_m > ramp_s_m + 1e-3) {
      std::size_t hint = 0;
      line.insert(after, point_at(line, ramp_s_m, hint));
    }
    for (BesidePoint& point : line) {
      point.t_m += by_m * std::max(0.0, 1.0 - std::abs(point.s_m - end_s_m) / ramp_m);
    }
  }

  const RoadMap& road_map_;
  const RoadPlan& plan_;
  std::vector<PlacedRoad>& placed_;
  EndRoles ends_;
  std::map<std::pair<const BesideLine*, std::uint32_t>, std::size_t> numbers_;
  std::vector<BorderEnd> borders_;
  std::vector<Pair> pairs_;
  std::vector<std::vector<std::size_t>> meetings_;  // of borders, some empty
  std::vector<std::size_t> meeting_of_;             // by border
};

}  // namespace

void close_joints(const RoadMap& road_map, const RoadPlan& plan, std::vector<PlacedRoad>& placed) {
  JointCloser(road_map, plan, placed).close();
}

}  // namespace roadbed::map::opendrive
