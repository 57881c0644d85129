#include "roadbed/map/lanelet2/write/shared_borders.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "roadbed/geometry/index/line_distance.h"

namespace roadbed::map::lanelet2 {
namespace {

using Line3 = std::vector<Eigen::Vector3d>;

// Sets of equal things, each named by its smallest member; `flipped` tells whether a thing runs
// against the one that names its set.
class Classes {
 public:
  struct Member {
    std::uint32_t name;
    bool flipped;
  };

  explicit Classes(std::size_t size) : up_(size), flipped_(size, false) {
    std::iota(up_.begin(), up_.end(), 0U);
  }

  Member find(std::uint32_t thing) {
    std::uint32_t name = thing;
    bool flipped = false;
    while (up_[name] != name) {
      flipped = flipped != flipped_[name];
      name = up_[name];
    }
    // Hang all that were passed from the name itself, so that the next search is short.
    bool rest = flipped;
    while (thing != name) {
      const bool own = flipped_[thing];
      flipped_[thing] = rest;
      rest = rest != own;
      thing = std::exchange(up_[thing], name);
    }
    return {name, flipped};
  }

  void unite(std::uint32_t a, std::uint32_t b, bool opposite) {
    Member x = find(a), y = find(b);
    if (x.name == y.name) return;
    if (y.name < x.name) std::swap(x, y);
    up_[y.name] = x.name;
    flipped_[y.name] = (x.flipped != y.flipped) != opposite;
  }

 private:
  std::vector<std::uint32_t> up_;
  std::vector<bool> flipped_;
};

Line3 line_of(const LaneLine& line) {
  Line3 points;
  points.reserve(line.z_m.size());
  for (std::size_t i = 0; i < line.z_m.size(); ++i) {
    points.emplace_back(line.in_map.points()[i].x(), line.in_map.points()[i].y(), line.z_m[i]);
  }
  return points;
}

// The number of lane `id`'s left (0) or right (1) line.
std::uint32_t line_number(LaneId id, int side) {
  return 2 * id.index + static_cast<std::uint32_t>(side);
}

bool equal_in_plan(const Line3& a, const Line3& b, bool reversed) {
  const std::size_t n = a.size();
  if (b.size() != n) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (a[i].head<2>() != b[reversed ? n - 1 - i : i].head<2>()) return false;
  }
  return true;
}

class Sharer {
 public:
  Sharer(const RoadMap& road_map, const SharingOptions& options)
      : road_map_(road_map), options_(options), classes_(2 * road_map.lanes().size()) {
    for (const Lane& lane : road_map.lanes()) {
      lines_.push_back(line_of(lane.left));
      lines_.push_back(line_of(lane.right));
    }
  }

  SharedBorders fraction() {
    unite_equal_lines();
    unite_neighbours();
    number_lines();
    join_ends();
    lay_points();
    count_links();
    return std::move(shared_);
  }

 private:
  void unite_equal_lines() {
    using Key = std::tuple<double, double, double, double, std::size_t>;
    std::vector<std::pair<Key, std::uint32_t>> keys;
    for (std::uint32_t i = 0; i < lines_.size(); ++i) {
      Eigen::Vector3d a = lines_[i].front(), b = lines_[i].back();
      if (std::pair(b.x(), b.y()) < std::pair(a.x(), a.y())) std::swap(a, b);
      keys.push_back({{a.x(), a.y(), b.x(), b.y(), lines_[i].size()}, i});
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 1; i < keys.size(); ++i) {
      // Of lines with equal ends each is compared with those before it, until one is equal.
      for (std::size_t k = i; k-- > 0 && keys[k].first == keys[i].first;) {
        if (unite_if_equal(keys[k].second, keys[i].second)) break;
      }
    }
  }

  bool unite_if_equal(std::uint32_t a, std::uint32_t b) {
    for (const bool reversed : {false, true}) {
      if (!equal_in_plan(lines_[a], lines_[b], reversed)) continue;
      classes_.unite(a, b, reversed);
      return true;
    }
    return false;
  }

  void unite_neighbours() {
    for (const Lane& lane : road_map_.lanes()) {
      const LaneLinks& links = road_map_.graph().of(lane.id);
      if (links.left) unite_across(lane.id, 0, *links.left);
      if (links.right) unite_across(lane.id, 1, *links.right);
    }
  }

  // The other lane's line is its other side if it has the same direction, else its same side.
  void unite_across(LaneId lane, int side, const Neighbour& neighbour) {
    const std::uint32_t a = line_number(lane, side);
    const std::uint32_t b = line_number(neighbour.lane, neighbour.same_direction ? 1 - side : side);
    if (classes_.find(a).name == classes_.find(b).name) return;
    const double apart_m = std::max(geometry::farthest_m(polyline(a), polyline(b)),
                                    geometry::farthest_m(polyline(b), polyline(a)));
    if (apart_m <= options_.same_line_m) classes_.unite(a, b, !neighbour.same_direction);
  }

  const geometry::Polyline& polyline(std::uint32_t line) const {
    const Lane& lane = road_map_.lane(LaneId{line / 2});
    return line % 2 == 0 ? lane.left.in_map : lane.right.in_map;
  }

  void number_lines() {
    std::vector<std::uint32_t> number_of(lines_.size());
    for (std::uint32_t i = 0; i < lines_.size(); ++i) {
      if (classes_.find(i).name != i) continue;
      number_of[i] = static_cast<std::uint32_t>(kept_.size());
      kept_.push_back(i);
    }
    shared_.lanes.resize(road_map_.lanes().size());
    for (std::uint32_t i = 0; i < lines_.size(); ++i) {
      const Classes::Member member = classes_.find(i);
      shared_.lanes[i / 2][i % 2] = {number_of[member.name], member.flipped};
    }
  }

  // Number of the point that a side begins (or ends) with, in driving direction: two per line.
  static std::uint32_t end_of(const SharedBorders::Side& side, bool at_end) {
    return 2 * side.line + (at_end != side.reversed ? 1U : 0U);
  }

  const Eigen::Vector3d& end_point(std::uint32_t end) const {
    const Line3& line = lines_[kept_[end / 2]];
    return end % 2 == 0 ? line.front() : line.back();
  }

  /// The direction from a line's end into the line; zero if it has none.
  Eigen::Vector2d inwards(std::uint32_t end) const {
    const Line3& line = lines_[kept_[end / 2]];
    const std::size_t last = line.size() - 1;
    const Eigen::Vector3d& next = end % 2 == 0 ? line[1] : line[last - 1];
    return (next - end_point(end)).head<2>().normalized();
  }

  /// Whether the way from a joint to an end of a line leads into the line or aside.
  bool leads_on(std::uint32_t joint, std::uint32_t end) const {
    constexpr double kBack_m = 0.1;
    return (end_point(end) - end_point(joint)).head<2>().dot(inwards(end)) >= -kBack_m;
  }

  /// The same of both lines that meet.
  bool is_step(std::uint32_t end, std::uint32_t start) const {
    return leads_on(start, end) && leads_on(end, start);
  }

  double apart_m(std::uint32_t end, std::uint32_t other) const {
    return (end_point(other) - end_point(end)).head<2>().norm();
  }

  void join_ends() {
    Classes ends(2 * kept_.size());
    for (const Lane& from : road_map_.lanes()) {
      for (const LaneId to : road_map_.graph().of(from.id).successors) {
        const auto& a = shared_.lanes[from.id.index];
        const auto& b = shared_.lanes[to.index];
        const std::array<std::pair<std::uint32_t, std::uint32_t>, 2> pairs = {
            std::pair(end_of(a[0], true), end_of(b[0], false)),
            std::pair(end_of(a[1], true), end_of(b[1], false))};
        const bool can_join = std::all_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
          const auto [end, start] = pair;
          return apart_m(end, start) <= (is_step(end, start) ? options_.step_m : options_.move_m);
        });
        if (!can_join) continue;
        for (const auto& [x, y] : pairs) ends.unite(x, y, false);
      }
    }
    for (std::uint32_t end = 0; end < 2 * kept_.size(); ++end) {
      end_names_.push_back(ends.find(end).name);
    }
  }

  void lay_points() {
    std::vector<std::uint32_t> point_of_end(end_names_.size());
    const auto lay = [&](const Eigen::Vector3d& at) {
      shared_.points.push_back(at);
      return static_cast<std::uint32_t>(shared_.points.size() - 1);
    };
    for (std::uint32_t end = 0; end < end_names_.size(); ++end) {
      const std::uint32_t name = end_names_[end];  // never larger than `end`
      point_of_end[end] = name == end ? lay(end_point(end)) : point_of_end[name];
    }
    for (std::uint32_t i = 0; i < kept_.size(); ++i) {
      const Line3& line = lines_[kept_[i]];
      std::vector<std::uint32_t> points{point_of_end[2 * i]};
      if (keeps_own_end(2 * i)) points.push_back(lay(line.front()));
      for (std::size_t k = 1; k + 1 < line.size(); ++k) points.push_back(lay(line[k]));
      if (keeps_own_end(2 * i + 1)) points.push_back(lay(line.back()));
      points.push_back(point_of_end[2 * i + 1]);
      shared_.lines.push_back(std::move(points));
    }
  }

  /// Whether a line has its own end behind the joint; else its end moves there.
  bool keeps_own_end(std::uint32_t end) {
    const std::uint32_t joint = end_names_[end];
    const double from_joint_m = apart_m(joint, end);
    const bool keeps = from_joint_m > options_.join_m && leads_on(joint, end);
    double& largest_m = keeps ? shared_.largest_step_m : shared_.largest_move_m;
    largest_m = std::max(largest_m, from_joint_m);
    return keeps;
  }

  void count_links() {
    using Gate = std::pair<std::uint32_t, std::uint32_t>;
    const auto gate = [&](LaneId id, bool at_end) {
      const auto& sides = shared_.lanes[id.index];
      return Gate(end_names_[end_of(sides[0], at_end)], end_names_[end_of(sides[1], at_end)]);
    };
    std::vector<std::pair<Gate, LaneId>> starts;
    const auto counts = [&](const Lane& lane) { return !options_.counts || options_.counts(lane); };
    for (const Lane& lane : road_map_.lanes()) {
      if (counts(lane)) starts.emplace_back(gate(lane.id, false), lane.id);
    }
    std::sort(starts.begin(), starts.end());
    for (const Lane& lane : road_map_.lanes()) {
      if (!counts(lane)) continue;
      const std::vector<LaneId>& list = road_map_.graph().of(lane.id).successors;
      std::set<LaneId> wanted(list.begin(), list.end());
      const Gate end = gate(lane.id, true);
      auto at = std::lower_bound(starts.begin(), starts.end(), std::pair(end, LaneId{0}));
      for (; at != starts.end() && at->first == end; ++at) {
        if (wanted.erase(at->second) == 0 && at->second != lane.id) ++shared_.unwanted_links;
      }
      shared_.lost_links += static_cast<std::size_t>(
          std::ranges::count_if(wanted, [&](LaneId to) { return counts(road_map_.lane(to)); }));
    }
  }

  const RoadMap& road_map_;
  const SharingOptions options_;
  std::vector<Line3> lines_;         // two per lane
  Classes classes_;                  // of lines
  std::vector<std::uint32_t> kept_;  // the lines that are kept, as numbers in lines_
  std::vector<std::uint32_t> end_names_;
  SharedBorders shared_;
};

}  // namespace

SharedBorders share_borders(const RoadMap& road_map, const SharingOptions& options) {
  return Sharer(road_map, options).fraction();
}

}  // namespace roadbed::map::lanelet2
