#include "roadbed/tools/simulation/speed_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace roadbed::tools {
namespace {

constexpr double kSubstep_s = WayOccupancy::kStep_s;
constexpr double kCell_m = 0.75, kCell_mps = 0.6;
constexpr double kLeast_mps2 = -12.0;  // no vehicle brakes harder
constexpr double kMostLayers = 16.0;
constexpr double kTimeSlack_s = 0.051;  // a goal's moment may lie between two substeps

// Costs per second, in units of a speed that is missing altogether.
constexpr double kTooFast = 4.0;
constexpr double kCommand = 0.04, kChange = 0.05;  // of (m/s²)²
constexpr double kBend = 60.0;                     // of (m/s)² beyond what a bend allows
constexpr double kNearAhead = 1.5, kNearBehind = 0.5;
constexpr double kMissedGoal = 40.0, kMissPerMetre = 1.0;
constexpr double kTouchAfterGoal = 15.0;

struct Node {
  double ahead_m, speed_mps, acceleration_mps2, command_mps2;
  double cost, miss, bend_excess_mps;
  int parent;
  bool reached, touched;
};

/// What the actuator's lag makes of a constant command after some substeps.
struct Response {
  double t_s, decay, lag_way_s, lag_square_s2;
};

class Search {
 public:
  Search(const SpeedSearchQuestion& question, const SpeedSearchOptions& options)
      : q_(question), options_(options) {
    substeps_ = std::max(3, static_cast<int>(std::ceil(q_.horizon_s / kSubstep_s / kMostLayers)));
    layers_ = std::max(1, static_cast<int>(std::ceil(q_.horizon_s / (kSubstep_s * substeps_))));
    for (int i = 1; i <= substeps_; ++i) {
      const double t = kSubstep_s * i, lag = options.actuator_lag_s, decay = std::exp(-t / lag);
      responses_.push_back({t, decay, lag * (1.0 - decay), lag * (t - lag * (1.0 - decay))});
    }
    for (const double share : {-1.0, -0.7, -0.45, -0.25, -0.1, 0.0, 0.1, 0.25, 0.45, 0.7, 1.0}) {
      commands_.push_back(share < 0.0 ? -share * options.least_mps2 : share * options.most_mps2);
    }
  }

  SpeedSearchAnswer run() {
    nodes_.push_back({0.0, q_.speed_mps, q_.acceleration_mps2, q_.last_command_mps2, 0.0,
                      q_.goals.empty() ? 0.0 : 1e3, 0.0, -1, q_.goals.empty(), false});
    int from = 0, to = 1;
    for (int layer = 0; layer < layers_; ++layer) {
      cells_.assign(cells_.size(), -1);
      for (int i = from; i < to; ++i) expand(i, layer);
      if (static_cast<int>(nodes_.size()) == to) {
        return answer(deepest(from, to), layer, false);
      }
      from = to;
      to = static_cast<int>(nodes_.size());
    }
    return answer(cheapest(from, to), layers_, true);
  }

 private:
  double wanted_mps(double ahead_m) const {
    return std::min(q_.most_wanted_mps, q_.way.wanted_mps[q_.way.before(ahead_m)]);
  }

  void expand(int index, int layer) {
    const Node from = nodes_[static_cast<std::size_t>(index)];
    for (const double command : commands_) follow(index, from, command, layer);
    const double hold = std::clamp(0.8 * (wanted_mps(from.ahead_m) - from.speed_mps), -1.2, 1.2);
    follow(index, from, std::clamp(hold, options_.least_mps2, options_.most_mps2), layer);
  }

  /// Drives one layer on with a constant command; keeps the end if it is the best of its cell.
  void follow(int index, const Node& from, double command, int layer) {
    Node to = from;
    to.parent = index;
    to.command_mps2 = command;
    for (int i = 0; i < substeps_; ++i) {
      move(from, command, responses_[static_cast<std::size_t>(i)], to);
      if (!may_be_there(to, layer * substeps_ + i + 1)) return;
    }
    to.bend_excess_mps = std::max(from.bend_excess_mps, bend_excess_mps(to));
    to.cost += cost_of(from, to, layer * substeps_ + substeps_);
    keep(to);
  }

  static void move(const Node& from, double command, const Response& r, Node& to) {
    const double lagging = from.acceleration_mps2 - command;
    to.acceleration_mps2 = command + lagging * r.decay;
    to.speed_mps = from.speed_mps + command * r.t_s + lagging * r.lag_way_s;
    const double ahead_m = from.ahead_m + from.speed_mps * r.t_s + 0.5 * command * r.t_s * r.t_s +
                           lagging * r.lag_square_s2;
    if (to.speed_mps <= 0.0) {
      to.speed_mps = to.acceleration_mps2 = 0.0;
      to.ahead_m = std::max(to.ahead_m, std::min(ahead_m, to.ahead_m));
    } else {
      to.ahead_m = std::max(to.ahead_m, ahead_m);
    }
  }

  bool may_be_there(Node& node, int substep) const {
    if (node.ahead_m > q_.end_m && !node.reached) return false;
    const bool hit = q_.occupancy.is_blocked(substep, node.ahead_m) || node.ahead_m > q_.end_m;
    if (hit && (q_.goals.empty() || !node.reached)) return false;
    node.touched = node.touched || hit;
    look_at_goals(node, kSubstep_s * substep);
    return true;
  }

  static double outside(const Window& window, double value) {
    return std::max({0.0, window.least - value, value - window.most});
  }

  void look_at_goals(Node& node, double t_s) const {
    if (node.reached) return;
    for (const GoalAhead& goal : q_.goals) {
      if (outside(goal.time_s, t_s) > kTimeSlack_s) continue;
      const double miss =
          outside(goal.ahead_m, node.ahead_m) + 2.0 * outside(goal.speed_mps, node.speed_mps);
      node.miss = std::min(node.miss, miss);
      node.reached = node.reached || miss <= 0.0;
    }
  }

  double cost_of(const Node& from, const Node& to, int substep) const {
    const double wanted = wanted_mps(to.ahead_m);
    const double missing = (wanted - to.speed_mps) / std::max(5.0, wanted);
    double cost = missing > 0.0 ? missing * missing : kTooFast * missing * missing;
    cost += kCommand * to.command_mps2 * to.command_mps2;
    const double too_fast = bend_excess_mps(to);
    cost += kBend * too_fast * too_fast;
    cost += nearness(to, substep);
    const double change = to.command_mps2 - from.command_mps2;
    const double touch = to.touched && !from.touched ? kTouchAfterGoal : 0.0;
    return kSubstep_s * substeps_ * cost + kChange * change * change + touch;
  }

  double bend_excess_mps(const Node& node) const {
    return std::max(0.0, node.speed_mps - q_.way.most_mps[q_.way.before(node.ahead_m)]);
  }

  double nearness(const Node& node, int substep) const {
    const double keep_ahead = 1.5 + 0.8 * node.speed_mps, keep_behind = 1.0 + 0.1 * node.speed_mps;
    double ahead = keep_ahead, behind = keep_behind;
    for (const Blocked& part : q_.occupancy.at(substep)) {
      if (part.from_m >= node.ahead_m) ahead = std::min(ahead, part.from_m - node.ahead_m);
      if (part.to_m <= node.ahead_m) behind = std::min(behind, node.ahead_m - part.to_m);
    }
    const double a = 1.0 - ahead / keep_ahead, b = 1.0 - behind / keep_behind;
    return kNearAhead * a * a + kNearBehind * b * b;
  }

  /// With the lag T, s + T v and v + T a follow the command as a double integrator does, whatever a
  /// is now. So states of one cell of these two go on alike, which those of one cell of s and v do
  /// not.
  void keep(const Node& node) {
    const double lag_s = options_.actuator_lag_s;
    const double future_mps = node.speed_mps + lag_s * (node.acceleration_mps2 - kLeast_mps2);
    const auto column = static_cast<std::size_t>(std::max(0.0, future_mps) / kCell_mps);
    const auto row = static_cast<std::size_t>((node.ahead_m + lag_s * node.speed_mps) / kCell_m);
    constexpr std::size_t columns = 128;
    if (column >= columns) return;
    const std::size_t cell = (row * columns + column) * 2 + (node.reached ? 1 : 0);
    if (cell >= cells_.size()) cells_.resize(cell + 1, -1);
    int& kept = cells_[cell];
    if (kept < 0) {
      kept = static_cast<int>(nodes_.size());
      nodes_.push_back(node);
    } else if (node.cost < nodes_[static_cast<std::size_t>(kept)].cost) {
      nodes_[static_cast<std::size_t>(kept)] = node;
    }
  }

  bool goal_ends_within_horizon() const {
    return std::ranges::any_of(q_.goals, [&](const GoalAhead& goal) {
      return goal.time_s.most <= kSubstep_s * substeps_ * layers_ + kTimeSlack_s;
    });
  }

  double total(const Node& node) const {
    if (node.reached || !goal_ends_within_horizon()) return node.cost;
    return node.cost + kMissedGoal + kMissPerMetre * std::min(node.miss, 1e3);
  }

  int cheapest(int from, int to) const {
    int best = from;
    for (int i = from; i < to; ++i) {
      if (total(nodes_[static_cast<std::size_t>(i)]) <
          total(nodes_[static_cast<std::size_t>(best)]))
        best = i;
    }
    return best;
  }

  /// Of the nodes from which nothing leads on, the slowest.
  int deepest(int from, int to) const {
    int best = from;
    for (int i = from; i < to; ++i) {
      if (nodes_[static_cast<std::size_t>(i)].speed_mps <
          nodes_[static_cast<std::size_t>(best)].speed_mps)
        best = i;
    }
    return best;
  }

  SpeedSearchAnswer answer(int end, int layer, bool is_free) const {
    SpeedSearchAnswer found;
    const Node& last = nodes_[static_cast<std::size_t>(end)];
    found.is_free = is_free;
    found.misses_goal = !last.reached && goal_ends_within_horizon();
    found.reaches_goal = last.reached && !q_.goals.empty();
    found.free_until_s = kSubstep_s * substeps_ * layer;
    found.bend_excess_mps = last.bend_excess_mps;
    if (is_free) found.cost = total(last);
    for (int i = end; i >= 0; i = nodes_[static_cast<std::size_t>(i)].parent) {
      const Node& node = nodes_[static_cast<std::size_t>(i)];
      found.plan.push_back({kSubstep_s * substeps_ * layer--, node.ahead_m, node.speed_mps,
                            node.acceleration_mps2, node.command_mps2});
    }
    std::ranges::reverse(found.plan);
    return found;
  }

  const SpeedSearchQuestion& q_;
  const SpeedSearchOptions& options_;
  int substeps_ = 3, layers_ = 1;
  std::vector<Response> responses_;
  std::vector<double> commands_;
  std::vector<Node> nodes_;
  std::vector<int> cells_;
};

}  // namespace

SpeedSearchAnswer search_speed(const SpeedSearchQuestion& question,
                               const SpeedSearchOptions& options) {
  return Search(question, options).run();
}

}  // namespace roadbed::tools
