#include "roadbed/map/lanelet2/centreline.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "roadbed/geometry/primitives/cross.h"

namespace roadbed::map::lanelet2 {
namespace {

constexpr std::size_t kReach = 256;  // vertices that a rung looks ahead and behind

// Positive if the point is to the left of the line from a to b.
double side(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& point) {
  return geometry::cross(b - a, point - a);
}

struct Segment {
  Eigen::Vector2d from, to;
};

// Whether the ranges between two numbers each are apart.
bool apart(double a, double b, double c, double d) {
  return std::max(a, b) < std::min(c, d) || std::max(c, d) < std::min(a, b);
}

bool boxes_meet(const Segment& a, const Segment& b) {
  return !apart(a.from.x(), a.to.x(), b.from.x(), b.to.x()) &&
         !apart(a.from.y(), a.to.y(), b.from.y(), b.to.y());
}

// Whether the closed segments have a point in common.
bool meet(const Segment& a, const Segment& b) {
  if (!boxes_meet(a, b)) return false;
  const double a1 = side(b.from, b.to, a.from), a2 = side(b.from, b.to, a.to);
  if ((a1 > 0.0 && a2 > 0.0) || (a1 < 0.0 && a2 < 0.0)) return false;
  const double b1 = side(a.from, a.to, b.from), b2 = side(a.from, a.to, b.to);
  return !((b1 > 0.0 && b2 > 0.0) || (b1 < 0.0 && b2 < 0.0));
}

std::vector<Eigen::Vector2d> in_plan(const Line3& line) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(line.size());
  for (const Eigen::Vector3d& point : line) points.push_back(point.head<2>());
  return points;
}

std::vector<double> arc_lengths(const Line3& line) {
  std::vector<double> s_m(line.size(), 0.0);
  for (std::size_t i = 1; i < line.size(); ++i) {
    s_m[i] = s_m[i - 1] + (line[i] - line[i - 1]).head<2>().norm();
  }
  return s_m;
}

Eigen::AlignedBox2d box_of(const Segment& segment) {
  return {segment.from.cwiseMin(segment.to), segment.from.cwiseMax(segment.to)};
}

// From a rung to the next: to a vertex of one rail.
struct Step {
  double distance_m;  // length of the next rung
  std::size_t to;
  bool operator<(const Step& other) const {
    return std::pair(distance_m, to) < std::pair(other.distance_m, other.to);
  }
};

// One border while it is climbed. Its segments are searched in runs, each with its box.
class Rail {
 public:
  explicit Rail(const Line3& border)
      : line(border),
        plan(in_plan(border)),
        station_m(border.size(), std::numeric_limits<double>::quiet_NaN()),
        boxes_((border.size() + kRun - 1) / kRun) {
    for (std::size_t i = 0; i < plan.size(); ++i) {
      boxes_[i / kRun].extend(plan[i]).extend(plan[std::min(i + 1, plan.size() - 1)]);
    }
  }

  const Eigen::Vector2d& here() const { return plan[at]; }
  bool at_end() const { return at + 1 == plan.size(); }

  // Whether a segment of the border, but for those that `spared` accepts, meets the given one.
  template <typename Spared>
  bool is_met(const Segment& by, const Spared& spared) const {
    const Eigen::AlignedBox2d box = box_of(by);
    const std::size_t first = at > kReach ? at - kReach : 0;
    const std::size_t last = std::min(plan.size() - 1, at + kReach);
    for (std::size_t run = first / kRun; run * kRun < last; ++run) {
      if (!boxes_[run].intersects(box)) continue;
      const std::size_t begin = std::max(first, run * kRun), end = std::min(last, (run + 1) * kRun);
      double before = side(by.from, by.to, plan[begin]);
      for (std::size_t i = begin; i < end; ++i) {
        const double after = side(by.from, by.to, plan[i + 1]);
        const bool is_beside = (before > 0.0 && after > 0.0) || (before < 0.0 && after < 0.0);
        before = after;
        if (is_beside) continue;  // as most are
        const Segment segment{plan[i], plan[i + 1]};
        if (meet(segment, by) && !spared(segment)) return true;
      }
    }
    return false;
  }

  // The nearest vertex ahead, within reach, of equally near ones the first; none at the end.
  std::optional<Step> nearest_ahead(const Eigen::Vector2d& point) const {
    const std::size_t end = std::min(plan.size(), at + 1 + kReach);
    Step nearest{std::numeric_limits<double>::infinity(), end};
    for (std::size_t i = at + 1; i < end;) {
      const std::size_t run = i / kRun, run_end = std::min(end, (run + 1) * kRun);
      const double distance_m = std::sqrt(boxes_[run].squaredExteriorDistance(point));
      if (distance_m <= nearest.distance_m) {
        for (; i < run_end; ++i) nearest = std::min(nearest, {(plan[i] - point).norm(), i});
      }
      i = run_end;
    }
    return nearest.to == end ? std::nullopt : std::optional(nearest);
  }

  const Line3& line;
  std::vector<Eigen::Vector2d> plan;
  std::size_t at = 0;
  std::vector<double> station_m;  // NaN where no rung stands

 private:
  static constexpr std::size_t kRun = 8;

  std::vector<Eigen::AlignedBox2d> boxes_;
};

class Ladder {
 public:
  Ladder(const Line3& left, const Line3& right)
      : left_(left),
        right_(right),
        entry_{right_.plan.front(), left_.plan.front()},
        exit_{left_.plan.back(), right_.plan.back()} {}

  Centreline climb() {
    add_rung();
    if (left_.here() == right_.here() && !left_.at_end()) ++left_.at;
    while (take_step()) add_rung();
    if (!left_.at_end() || !right_.at_end()) {
      left_.at = left_.plan.size() - 1;
      right_.at = right_.plan.size() - 1;
      add_rung();
    }
    fill_stations(left_);
    fill_stations(right_);
    return {std::move(centre_), std::move(left_.station_m), std::move(right_.station_m)};
  }

 private:
  void add_rung() {
    const Eigen::Vector3d middle = 0.5 * (left_.line[left_.at] + right_.line[right_.at]);
    if (!centre_.empty()) length_m_ += (middle - centre_.back()).head<2>().norm();
    centre_.push_back(middle);
    for (Rail* rail : {&left_, &right_}) {
      double& station_m = rail->station_m[rail->at];
      if (std::isnan(station_m)) station_m = length_m_;  // of the first rung at the vertex
    }
  }

  // Goes on by the shorter of the rails' best steps, of equal ones the left; false if none is free.
  bool take_step() {
    const auto nearest_left = left_.nearest_ahead(right_.here());
    const auto nearest_right = right_.nearest_ahead(left_.here());
    // Where the nearer of these two is free, no step on the other rail is shorter.
    if (is_first(nearest_left, nearest_right)) {
      if (is_free(left_, right_, nearest_left->to)) return go_to(left_, *nearest_left);
    } else if (nearest_right && is_free(right_, left_, nearest_right->to)) {
      return go_to(right_, *nearest_right);
    }
    const auto left = best_step(left_, right_, nearest_left);
    const auto right = best_step(right_, left_, nearest_right);
    if (is_first(left, right)) return go_to(left_, *left);
    return right && go_to(right_, *right);
  }

  static bool is_first(const std::optional<Step>& left, const std::optional<Step>& right) {
    return left && (!right || left->distance_m <= right->distance_m);
  }

  static bool go_to(Rail& rail, const Step& step) {
    rail.at = step.to;
    return true;
  }

  // The nearest vertex ahead on `rail` to which a rung from the other one may be laid.
  std::optional<Step> best_step(const Rail& rail, const Rail& opposite,
                                const std::optional<Step>& nearest) const {
    if (!nearest || is_free(rail, opposite, nearest->to)) return nearest;
    const std::size_t end = std::min(rail.plan.size(), rail.at + 1 + kReach);
    return next_best_step(rail, opposite, nearest->to, end);
  }

  // The same without the nearest one, which is not free: by distance, until one is.
  std::optional<Step> next_best_step(const Rail& rail, const Rail& opposite, std::size_t nearest,
                                     std::size_t end) const {
    std::vector<Step> steps;
    steps.reserve(end - rail.at);
    for (std::size_t i = rail.at + 1; i < end; ++i) {
      if (i != nearest) steps.push_back({(rail.plan[i] - opposite.here()).norm(), i});
    }
    const auto later = [](const Step& a, const Step& b) { return b < a; };
    std::make_heap(steps.begin(), steps.end(), later);
    while (!steps.empty()) {
      if (is_free(rail, opposite, steps.front().to)) return steps.front();
      std::pop_heap(steps.begin(), steps.end(), later);
      steps.pop_back();
    }
    return {};
  }

  // Whether a step of the centreline leaves the lane through its entry or exit.
  static bool crosses(const Segment& ahead, const Segment& gate) {
    return meet(ahead, gate) && side(gate.from, gate.to, ahead.to) > 0.0;
  }

  bool is_free(const Rail& rail, const Rail& opposite, std::size_t to) const {
    const Eigen::Vector2d& candidate = rail.plan[to];
    const Eigen::Vector2d& foot = opposite.here();
    const Eigen::Vector2d middle = 0.5 * (candidate + foot);
    const Segment ahead{centre_.back().head<2>(), middle};
    const auto starts_here = [&](const Segment& s) { return s.from == ahead.from; };
    if (left_.is_met(ahead, starts_here) || right_.is_met(ahead, starts_here)) return false;
    if (crosses(ahead, entry_) || crosses(ahead, exit_)) return false;
    const Segment rung{foot, candidate};
    const auto at_candidate = [&](const Segment& s) {
      return s.from == candidate || s.to == candidate;
    };
    const auto at_foot = [&](const Segment& s) { return s.from == foot || s.to == foot; };
    return !rail.is_met(rung, at_candidate) && !opposite.is_met(rung, at_foot);
  }

  // The vertices without a rung, by their fraction of the border between those that have one.
  void fill_stations(Rail& rail) const {
    std::vector<double>& station_m = rail.station_m;
    station_m.front() = 0.0;
    station_m.back() = length_m_;
    if (std::ranges::none_of(station_m, [](double s_m) { return std::isnan(s_m); })) return;
    const std::vector<double> arc_m = arc_lengths(rail.line);
    std::size_t known = 0;
    for (std::size_t i = 1; i < station_m.size(); ++i) {
      if (std::isnan(station_m[i])) continue;
      for (std::size_t k = known + 1; k < i; ++k) {
        const double span_m = arc_m[i] - arc_m[known];
        const double fraction = span_m > 0.0 ? (arc_m[k] - arc_m[known]) / span_m : 0.0;
        station_m[k] = station_m[known] + fraction * (station_m[i] - station_m[known]);
      }
      known = i;
    }
  }

  Rail left_, right_;
  Segment entry_, exit_;
  Line3 centre_;
  double length_m_ = 0.0;
};

// The nearest place on a line in space, and on which side of it, seen from above, a point lies.
bool is_left_of(const Line3& line, const Eigen::Vector3d& point) {
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t segment = 0;
  bool at_its_end = false;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector3d along = line[i + 1] - line[i];
    const double squared = along.squaredNorm();
    const double fraction =
        squared > 0.0 ? std::clamp((point - line[i]).dot(along) / squared, 0.0, 1.0) : 0.0;
    const double distance = (point - line[i] - fraction * along).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      segment = i;
      at_its_end = fraction >= 1.0;
    }
  }
  const auto plan = [&](std::size_t i) { return Eigen::Vector2d(line[i].head<2>()); };
  const Eigen::Vector2d a = plan(segment), b = plan(segment + 1), p = point.head<2>();
  const bool left = side(a, b, p) > 0.0;
  if (at_its_end && segment + 2 < line.size()) {
    // Behind a corner that bends away, the next segment decides.
    const Eigen::Vector2d next = plan(segment + 2);
    if (left != (side(b, next, p) > 0.0) && left == (side(a, b, next) > 0.0)) return !left;
  }
  return left;
}

// Of a border of even length it depends on its direction.
Eigen::Vector3d middle_vertex(const Line3& line, bool reversed = false) {
  const std::size_t n = line.size();
  if (n > 2) return line[reversed ? n - 1 - n / 2 : n / 2];
  return 0.5 * (line.front() + line.back());
}

Line3 moved(Line3 line, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& point : line) point += by;
  return line;
}

// The point of the centreline nearest to a vertex, searched from the segment of the one before.
class NearestAhead {
 public:
  explicit NearestAhead(const Line3& centre) : centre_(centre), arc_m_(arc_lengths(centre)) {}

  double station_m(const Eigen::Vector2d& point) {
    const std::size_t end = std::min(centre_.size() - 1, segment_ + kReach);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = segment_; i < end; ++i) {
      const Eigen::Vector2d from = centre_[i].head<2>();
      const Eigen::Vector2d along = centre_[i + 1].head<2>() - from;
      const double squared = along.squaredNorm();
      const double fraction =
          squared > 0.0 ? std::clamp((point - from).dot(along) / squared, 0.0, 1.0) : 0.0;
      const double distance = (point - from - fraction * along).squaredNorm();
      if (distance < nearest) {
        nearest = distance;
        segment_ = i;
        station_m_ = std::max(last_m_, arc_m_[i] + fraction * (arc_m_[i + 1] - arc_m_[i]));
      }
    }
    return last_m_ = station_m_;
  }

  double length_m() const { return arc_m_.back(); }

 private:
  const Line3& centre_;
  std::vector<double> arc_m_;
  std::size_t segment_ = 0;
  double station_m_ = 0.0, last_m_ = 0.0;
};

std::vector<double> stations_along(const Line3& centre, const Line3& border) {
  NearestAhead search(centre);
  std::vector<double> station_m;
  station_m.reserve(border.size());
  for (const Eigen::Vector3d& point : border) {
    station_m.push_back(search.station_m(point.head<2>()));
  }
  station_m.front() = 0.0;
  station_m.back() = search.length_m();
  return station_m;
}

}  // namespace

Centreline centreline_between(const Line3& left, const Line3& right) {
  const Eigen::Vector3d origin(left.front().x(), left.front().y(), 0.0);
  Centreline found = Ladder(moved(left, -origin), moved(right, -origin)).climb();
  found.points = moved(std::move(found.points), origin);
  return found;
}

Centreline centreline_along(Line3 centre, const Line3& left, const Line3& right) {
  std::vector<double> left_m = stations_along(centre, left);
  std::vector<double> right_m = stations_along(centre, right);
  return {std::move(centre), std::move(left_m), std::move(right_m)};
}

Alignment align(const Line3& left, const Line3& right) {
  Alignment alignment;
  alignment.left_reversed = is_left_of(left, middle_vertex(right));
  alignment.right_reversed = !is_left_of(right, middle_vertex(left, alignment.left_reversed));
  return alignment;
}

}  // namespace roadbed::map::lanelet2
