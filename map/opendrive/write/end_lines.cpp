#include "roadbed/map/opendrive/write/end_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "roadbed/map/opendrive/write/clothoid.h"
#include "roadbed/map/opendrive/write/end_roles.h"
#include "roadbed/map/opendrive/write/facing_ends.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kShort_m = 0.15;   // ends of borders that say nothing of a direction
constexpr double kSkew_rad = 0.12;  // from square, of a line through the ends
constexpr double kMostSkew_rad = 1.1;
constexpr double kDirection_m = 3.0;    // of a lane's direction at its end
constexpr double kOffLine_m = 0.15;     // of an end from that line
constexpr double kSamePlace_m = 0.005;  // of lines across an end
constexpr double kMostCut_m = 8.0;      // off a road for a square end
constexpr double kMostShare = 0.3;      // the same, of its length

/// Where borders end, and which way their lanes go on along s.
struct EndPoints {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d along{0, 0};

  void add(const EndPoints& others, bool turned) {
    points.insert(points.end(), others.points.begin(), others.points.end());
    along += (turned ? -1.0 : 1.0) * others.along;
  }

  double heading_rad() const { return std::atan2(along.y(), along.x()); }

  Eigen::Vector2d middle() const {
    Eigen::Vector2d sum(0, 0);
    for (const Eigen::Vector2d& point : points) sum += point;
    return sum / static_cast<double>(points.size());
  }

  // How far the points are before a line.
  std::vector<double> offsets_m(const EndLine& line) const {
    std::vector<double> off_m;
    for (const Eigen::Vector2d& point : points) {
      off_m.push_back(unit(line.heading_rad).dot(point - line.in_map));
    }
    return off_m;
  }

  // Least and greatest distance of the points before a line.
  std::pair<double, double> before_m(const EndLine& line) const {
    const auto [least_m, most_m] = std::ranges::minmax(offsets_m(line));
    return {least_m, most_m};
  }

  // The same of all, each place once.
  std::vector<double> places_m(const EndLine& line) const {
    std::vector<double> off_m = offsets_m(line);
    std::ranges::sort(off_m);
    const auto is_same = [](double a, double b) { return b - a < kSamePlace_m; };
    off_m.erase(std::unique(off_m.begin(), off_m.end(), is_same), off_m.end());
    return off_m;
  }

  // The principal axis of the points.
  EndLine through() const {
    const Eigen::Vector2d centre = middle();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    for (const Eigen::Vector2d& point : points) {
      spread += (point - centre) * (point - centre).transpose();
    }
    if (spread.trace() < 2.0 * kShort_m * kShort_m) return {centre, heading_rad()};
    const double across_rad = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
    return {centre,
            heading_rad() + std::remainder(across_rad - 0.5 * std::numbers::pi - heading_rad(),
                                           std::numbers::pi)};
  }
};

class EndLineFinder {
 public:
  EndLineFinder(const RoadMap& road_map, const RoadPlan& plan) : road_map_(road_map), plan_(plan) {
    const EndRoles ends = find_end_roles(road_map, plan);
    groups_ = ends.groups;
    unite_facing_ends(road_map, plan, groups_);
    const std::size_t count = 2 * plan.roads.size();
    together_.resize(count);
    hubs_.resize(count);
    rims_.resize(count);
    std::vector<int> ends_of(count);
    for (const std::uint32_t group : groups_) ++ends_of[group];
    is_free_.resize(count);
    for (std::uint32_t end = 0; end < count; ++end) {
      own_.push_back(points_at(plan.roads[end / 2], end % 2 == 1));
      EndPoints& group = together_[groups_[end]];
      group.add(own_[end], group.along.dot(own_[end].along) < 0.0);
      const EndRole role = ends.roles[end];
      if (role == EndRole::hub) hubs_[groups_[end]] = end;
      if (role == EndRole::free) is_free_[groups_[end]] = true;
      if (role == EndRole::free && ends_of[groups_[end]] == 1) rims_[groups_[end]] = end;
    }
  }

  EndLines find() {
    EndLines lines;
    lines.group_of_end.resize(own_.size());
    std::vector<std::optional<std::uint32_t>> number(own_.size());
    for (std::uint32_t end = 0; end < own_.size(); ++end) {
      // A road of the map has its own straight ends.
      const bool is_alone = plan_.roads[end / 2].source.has_value();
      auto& known = number[groups_[end]];
      if (is_alone || !known) {
        lines.choices.push_back(is_alone ? std::vector{own_[end].through()}
                                         : choices(groups_[end]));
        if (!is_alone) known = static_cast<std::uint32_t>(lines.choices.size() - 1);
      }
      lines.group_of_end[end] =
          is_alone ? static_cast<std::uint32_t>(lines.choices.size() - 1) : *known;
      lines.along_of_end.push_back(own_[end].along);
    }
    return lines;
  }

 private:
  EndPoints points_at(const PlannedRoad& road, bool last) const {
    EndPoints ends;
    const PlannedSection& section = last ? road.sections.back() : road.sections.front();
    for (const PlannedLane& planned : section.lanes) {
      const Lane& lane = road_map_.lane(planned.lane);
      const bool lane_end = planned.forward == last;
      for (const LaneLine* line : {&lane.left, &lane.right}) {
        const auto& points = line->in_map.points();
        ends.points.push_back(lane_end ? points.back() : points.front());
      }
      const double reach_m = std::min(kDirection_m, 0.5 * lane.length_m());
      const double from_m = lane_end ? lane.length_m() - reach_m : 0.0;
      const Eigen::Vector2d ahead =
          lane.centre.in_map.at(from_m + reach_m) - lane.centre.in_map.at(from_m);
      ends.along += (planned.forward ? 1.0 : -1.0) * ahead.normalized();
    }
    // A lane's middle may lead back in a bend of the map that is narrower than the lane.
    if (road.source) ends.along = along_reference(road, last);
    return ends;
  }

  Eigen::Vector2d along_reference(const PlannedRoad& road, bool last) const {
    const RoadBorder line = reference_along(road_map_, road, road.sections.front().left_lanes);
    const std::size_t most = line.own_to - line.own_from;
    const auto from_end = [&](std::size_t i) {
      return Eigen::Vector2d(line.points[last ? line.own_to - i : line.own_from + i].head<2>());
    };
    std::size_t i = 1;
    while (i < most && (from_end(i) - from_end(0)).norm() < kShort_m) ++i;
    return (last ? -1.0 : 1.0) * (from_end(i) - from_end(0)).normalized();
  }

  // Through the ends where they are in line, square to the road, and half-way between.
  std::vector<EndLine> choices(std::uint32_t group) const {
    const EndPoints& all = together_[group];
    EndPoints leading = hubs_[group] ? own_[*hubs_[group]] : all;
    if (leading.along.dot(all.along) < 0.0) leading.along *= -1.0;
    const double square_rad = leading.heading_rad();
    const EndLine through = all.through();
    const double skew_rad =
        std::remainder(through.heading_rad - square_rad, 2.0 * std::numbers::pi);
    const auto [behind_m, before_m] = all.before_m(through);
    const bool in_line = rims_[group] || std::max(-behind_m, before_m) <= kOffLine_m;
    std::vector<EndLine> lines;
    if (in_line && std::abs(skew_rad) <= (is_free_[group] ? kMostSkew_rad : kSkew_rad)) {
      lines.push_back(at_heading(group, through.heading_rad).front());
    }
    const EndLine own = leading.through();
    const double own_rad = std::remainder(own.heading_rad - square_rad, 2.0 * std::numbers::pi);
    for (const double share : {0.0, 0.5, 1.0}) {
      const double turn_rad = share * std::clamp(own_rad, -kMostSkew_rad, kMostSkew_rad);
      for (const EndLine& line : at_heading(group, square_rad + turn_rad)) lines.push_back(line);
    }
    if (in_line && std::abs(skew_rad) <= kMostSkew_rad) {
      lines.push_back(at_heading(group, through.heading_rad).front());
    }
    if (!rims_[group]) lines.push_back({all.middle(), all.heading_rad()});
    return lines;
  }

  // Behind the last border of a road that leads nowhere; else where all borders of the road that
  // leads into a junction are still there, amid the ends, and through each of them.
  std::vector<EndLine> at_heading(std::uint32_t group, double heading_rad) const {
    if (rims_[group]) return {rim(*rims_[group], heading_rad)};
    const EndLine middle{together_[group].middle(), heading_rad};
    std::vector<EndLine> lines;
    if (hubs_[group]) lines.push_back(cut_back(*hubs_[group], heading_rad));
    lines.push_back(middle);
    for (const double off_m : together_[group].places_m(middle)) {
      lines.push_back({middle.in_map + off_m * unit(heading_rad), heading_rad});
    }
    for (EndLine& line : lines) line.off_m = (line.in_map - middle.in_map).norm();
    return lines;
  }

  EndLine rim(std::uint32_t end, double heading_rad) const {
    EndLine line = amid(own_[end], heading_rad);
    const auto [behind_m, before_m] = own_[end].before_m(line);
    line.in_map += (end % 2 == 1 ? before_m : behind_m) * unit(line.heading_rad);
    line.is_rim = true;
    return line;
  }

  // Its heading along the road.
  static EndLine amid(const EndPoints& ends, double heading_rad) {
    const bool is_turned = unit(heading_rad).dot(ends.along) < 0.0;
    return {ends.middle(), heading_rad + (is_turned ? std::numbers::pi : 0.0)};
  }

  EndLine cut_back(std::uint32_t hub, double heading_rad) const {
    const EndPoints& own = own_[hub];
    EndLine line = amid(own, heading_rad);
    const auto [behind_m, before_m] = own.before_m(line);
    double length_m = 0.0;
    for (const PlannedSection& section : plan_.roads[hub / 2].sections) {
      length_m += road_map_.lane(section.lanes.front().lane).length_m();
    }
    const bool last = hub % 2 == 1;
    const double cut_m = std::min({last ? -behind_m : before_m, kMostCut_m, kMostShare * length_m});
    line.in_map += (last ? -cut_m : cut_m) * unit(line.heading_rad);
    return line;
  }

  const RoadMap& road_map_;
  const RoadPlan& plan_;
  std::vector<std::uint32_t> groups_;               // by end: those that share a line
  std::vector<EndPoints> own_, together_;           // by end, by group
  std::vector<std::optional<std::uint32_t>> hubs_;  // by group
  std::vector<std::optional<std::uint32_t>> rims_;  // likewise: the only end, which leads nowhere
  std::vector<bool> is_free_;                       // likewise
};

}  // namespace

Crossing crossing(const RoadBorder& border, const EndLine& line, bool last) {
  const Line3& points = border.points;
  const Eigen::Vector2d ahead = (last ? 1.0 : -1.0) * unit(line.heading_rad);
  const auto place = [&](std::size_t i) { return last ? points.size() - 1 - i : i; };
  const auto at = [&](std::size_t i) { return Eigen::Vector2d(points[place(i)].head<2>()); };
  const auto beyond_m = [&](std::size_t i) { return ahead.dot(at(i) - line.in_map); };
  std::size_t i = 0;
  while (i + 1 < points.size() && beyond_m(i) > 1e-9) ++i;
  if (i == 0) {
    const Eigen::Vector2d along = (at(0) - at(1)).normalized();
    const double cosine = ahead.dot(along);
    const Eigen::Vector2d step = cosine < 0.3 ? ahead : Eigen::Vector2d(along / cosine);
    return {at(0) - beyond_m(0) * step, place(0)};
  }
  const double a = beyond_m(i), b = beyond_m(i - 1);
  if (a > 0.0) return {at(i) - a * ahead, place(i)};  // all of it lies beyond
  return {at(i) + a / (a - b) * (at(i - 1) - at(i)), place(i)};
}

std::vector<std::size_t> EndLines::nearest_first(std::size_t group) const {
  std::vector<std::size_t> order(choices[group].size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return choices[group][i].off_m; });
  return order;
}

EndLine EndLines::at(std::uint32_t end, std::size_t choice) const {
  EndLine line = choices[group_of_end[end]][choice];
  if (unit(line.heading_rad).dot(along_of_end[end]) < 0.0) line.heading_rad += std::numbers::pi;
  return line;
}

EndLines end_lines(const RoadMap& road_map, const RoadPlan& plan) {
  return EndLineFinder(road_map, plan).find();
}

}  // namespace roadbed::map::opendrive
