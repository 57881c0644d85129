#include "roadbed/planning/route_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

namespace roadbed::planning {
namespace {

using map::LaneId;

constexpr int kNone = -1;

// A lane in a passage, after some changes. `first`: the passage in which the route starts.
struct Label {
  LaneId lane;
  int changes = 0;
  bool first = false;
  double cost = 0.0;
  int parent = kNone;
};

// In the queue; ordered so that ties are broken the same way everywhere.
struct Entry {
  double estimate;
  int changes;
  LaneId lane;
  int label;
  bool operator>(const Entry& other) const {
    return std::tie(estimate, changes, lane, label) >
           std::tie(other.estimate, other.changes, other.lane, other.label);
  }
};

class Search {
 public:
  Search(const TravelRules& rules, const map::LanePlace& from, const map::LanePlace& to)
      : rules_(rules),
        road_map_(rules.road_map()),
        goal_(to.lane),
        start_share_(fraction(from)),
        goal_share_(fraction(to)),
        goal_point_(point(to.lane, goal_share_)),
        least_changes_(2 * road_map_.lanes().size(), std::numeric_limits<int>::max()) {
    cost_per_m_ = least_cost_per_m(from.lane);
    push({from.lane, 0, true, 0.0, kNone});
  }

  SearchResult run() {
    while (!queue_.empty()) {
      const int index = queue_.top().label;
      queue_.pop();
      if (index == reached_goal_) return {passages(), reached()};
      if (settle(labels_[static_cast<std::size_t>(index)])) expand(index);
    }
    return {std::nullopt, reached()};
  }

 private:
  double fraction(const map::LanePlace& place) const {
    const double length_m = road_map_.lane(place.lane).length_m();
    return length_m > 0.0 ? std::clamp(place.s_m / length_m, 0.0, 1.0) : 0.0;
  }

  Eigen::Vector2d point(LaneId lane, double share) const {
    const auto& centre = road_map_.lane(lane).centre.in_map;
    return centre.at(share * centre.length_m());
  }

  double entry_share(const Label& label) const { return label.first ? start_share_ : 0.0; }

  // Where a label stands: its passage is not driven yet.
  Eigen::Vector2d place(const Label& label) const { return point(label.lane, entry_share(label)); }

  // The least ratio of cost to straight-line distance of any step: times the distance to the goal
  // it never exceeds the cost of the way there, and falls by no more than a step costs.
  double least_cost_per_m(LaneId start) const {
    double least = std::numeric_limits<double>::infinity();
    for (const map::Lane& lane : road_map_.lanes()) {
      if (rules_.may_enter(lane.id)) least = std::min(least, least_ratio({lane.id}));
    }
    // The passage of the start has its own places; its lanes lie beside the start lane.
    for (const LaneId lane : beside(start)) least = std::min(least, least_ratio({lane, 0, true}));
    return std::isfinite(least) ? least : 0.0;
  }

  std::vector<LaneId> beside(LaneId lane) const {
    std::vector<LaneId> lanes{lane};
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      for (const auto& neighbour : neighbours(lanes[i])) {
        if (neighbour && neighbour->same_direction &&
            std::find(lanes.begin(), lanes.end(), neighbour->lane) == lanes.end()) {
          lanes.push_back(neighbour->lane);
        }
      }
    }
    return lanes;
  }

  std::array<std::optional<map::Neighbour>, 2> neighbours(LaneId lane) const {
    const map::LaneLinks& links = road_map_.graph().of(lane);
    return {links.left, links.right};
  }

  double least_ratio(const Label& label) const {
    const Eigen::Vector2d here = place(label);
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](double cost, const Eigen::Vector2d& there) {
      const double distance_m = (there - here).norm();
      if (distance_m > 0.0) least = std::min(least, cost / distance_m);
    };
    const double share = 1.0 - entry_share(label);
    const double whole = rules_.travel_cost(label.lane, share);
    for (const LaneId next : road_map_.graph().of(label.lane).successors) {
      if (rules_.may_enter(next)) consider(whole, point(next, 0.0));
    }
    for (const auto& neighbour : neighbours(label.lane)) {
      if (!neighbour || !neighbour->same_direction || !rules_.may_enter(neighbour->lane)) continue;
      consider(rules_.change_cost(label.lane, 0, share),
               point(neighbour->lane, entry_share(label)));
    }
    if (label.lane == goal_ && goal_share_ > entry_share(label)) {
      consider(rules_.travel_cost(goal_, goal_share_ - entry_share(label)), goal_point_);
    }
    return least;
  }

  void push(const Label& label) {
    labels_.push_back(label);
    const double ahead = cost_per_m_ * (place(label) - goal_point_).norm();
    queue_.push(
        {label.cost + ahead, label.changes, label.lane, static_cast<int>(labels_.size()) - 1});
  }

  // False if the lane was settled with no more changes before, and so at no more cost.
  bool settle(const Label& label) {
    int& least = least_changes_[2 * label.lane.index + (label.first ? 1 : 0)];
    if (label.changes >= least) return false;
    least = label.changes;
    return true;
  }

  void expand(int index) {
    const Label label = labels_[static_cast<std::size_t>(index)];
    const double share = 1.0 - entry_share(label);
    finish(label, index);
    for (const LaneId next : road_map_.graph().of(label.lane).successors) {
      if (!rules_.may_enter(next) || !rules_.has_room(label.lane, label.changes, share)) continue;
      push({next, 0, false, label.cost + rules_.travel_cost(label.lane, share), index});
    }
    for (const auto& next : neighbours(label.lane)) {
      if (!next || !rules_.may_change(label.lane, *next, label.changes, share)) continue;
      push({next->lane, label.changes + 1, label.first,
            label.cost + rules_.change_cost(label.lane, label.changes, share), index});
    }
  }

  // Offers the goal if it lies ahead in this lane. The goal is a label too, the cheapest so far.
  void finish(const Label& label, int index) {
    const double share = goal_share_ - entry_share(label);
    if (label.lane != goal_ || share < 0.0 || !rules_.has_room(goal_, label.changes, share)) return;
    const double cost = label.cost + rules_.travel_cost(goal_, share);
    if (reached_goal_ != kNone && labels_[static_cast<std::size_t>(reached_goal_)].cost <= cost) {
      return;
    }
    labels_.push_back({goal_, label.changes, label.first, cost, index});
    reached_goal_ = static_cast<int>(labels_.size()) - 1;
    queue_.push({cost, -1, goal_, reached_goal_});
  }

  std::vector<Passage> passages() const {
    std::vector<Passage> passages;
    bool joins = false;  // whether the label before is in the same passage
    for (int i = labels_[static_cast<std::size_t>(reached_goal_)].parent; i != kNone;) {
      const Label& label = labels_[static_cast<std::size_t>(i)];
      if (!joins) passages.push_back({{}, entry_share(label), 1.0});
      passages.back().lanes.insert(passages.back().lanes.begin(), label.lane);
      joins = label.changes > 0;
      i = label.parent;
    }
    passages.front().to = goal_share_;
    std::reverse(passages.begin(), passages.end());
    return passages;
  }

  std::vector<LaneId> reached() const {
    std::vector<LaneId> lanes;
    for (const map::Lane& lane : road_map_.lanes()) {
      const std::size_t i = 2 * lane.id.index;
      constexpr int kNever = std::numeric_limits<int>::max();
      if (least_changes_[i] != kNever || least_changes_[i + 1] != kNever) lanes.push_back(lane.id);
    }
    return lanes;
  }

  const TravelRules& rules_;
  const map::RoadMap& road_map_;
  LaneId goal_;
  double start_share_, goal_share_;
  Eigen::Vector2d goal_point_;
  double cost_per_m_ = 0.0;
  std::vector<Label> labels_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::vector<int> least_changes_;  // of settled labels, two per lane: later passages, the first
  int reached_goal_ = kNone;
};

}  // namespace

SearchResult search(const TravelRules& rules, const map::LanePlace& from,
                    const map::LanePlace& to) {
  return Search(rules, from, to).run();
}

}  // namespace roadbed::planning
