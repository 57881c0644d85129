#include "roadbed/planning/speed/speed_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <queue>
#include <tuple>

#include "roadbed/planning/speed/path_speed_limits.h"
#include "roadbed/planning/speed/remaining_cost.h"
#include "roadbed/planning/speed/safe_way_on.h"
#include "roadbed/planning/speed/state_table.h"

namespace roadbed::planning::inline speed {
namespace {

constexpr double kSubstep_s = StGraph::kStep_s;
constexpr double kCell_m = 0.75, kCell_mps = 0.6;
constexpr double kLeast_mps2 = -12.0;  // no vehicle brakes harder
constexpr double kMostLayers = 16.0;
constexpr double kTimeSlack_s = 0.051;  // a goal's moment may lie between two substeps
constexpr double kRounding = 1e-6;      // of time steps

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
  int parent, layer;
  bool reached, touched, is_done;
};

/// What the actuator's lag makes of a constant command after some substeps.
struct Response {
  double t_s, decay, lag_way_s, lag_square_s2;
};

class Search {
 public:
  Search(const SpeedSearchQuestion& question, const SpeedSearchOptions& options)
      : q_(question), options_(options), speeds_(question.profile) {
    substeps_ = std::max(3, static_cast<int>(std::ceil(q_.horizon_s / kSubstep_s / kMostLayers)));
    layers_ = std::max(1, static_cast<int>(std::ceil(q_.horizon_s / (kSubstep_s * substeps_))));
    for (int i = 1; i <= substeps_; ++i) {
      const double t = kSubstep_s * i, lag = options.actuator_lag_s, decay = std::exp(-t / lag);
      responses_.push_back({t, decay, lag * (1.0 - decay), lag * (t - lag * (1.0 - decay))});
    }
    drive_.resize(responses_.size());
    remaining_.emplace(question, options, layer_s(), layers_ * layer_s());
    ends_within_horizon_ = goal_ends_within_horizon();
    for (int layer = 0; layer < layers_; ++layer) may_reach_.push_back(may_reach_goal_in(layer));
    for (const double fraction : {-1.0, -0.7, -0.45, -0.25, -0.1, 0.0, 0.1, 0.25, 0.45, 0.7, 1.0}) {
      commands_.push_back(fraction < 0.0 ? -fraction * options.least_mps2
                                         : fraction * options.most_mps2);
    }
  }

  /// The cheapest state goes on first. Nothing is ever paid back, so that a state that is the
  /// cheapest of all is the cheapest of its cell, and the first at the horizon the answer: that of
  /// going on with every state of a layer before the next.
  SpeedSearchAnswer run() {
    nodes_.push_back({.ahead_m = 0.0,
                      .speed_mps = q_.speed_mps,
                      .acceleration_mps2 = q_.acceleration_mps2,
                      .command_mps2 = q_.last_command_mps2,
                      .cost = 0.0,
                      .miss = q_.goals.empty() ? 0.0 : 1e3,
                      .bend_excess_mps = 0.0,
                      .parent = -1,
                      .layer = 0,
                      .reached = q_.goals.empty(),
                      .touched = false,
                      .is_done = false});
    for (queue_.push({0.0, 0}); !queue_.empty();) {
      const int index = queue_.top().node;
      queue_.pop();
      Node& node = nodes_[static_cast<std::size_t>(index)];
      if (node.is_done) continue;  // it was found again, cheaper
      node.is_done = true;
      if (node.layer == layers_) return answer(index, true);
      expand(index);
    }
    return answer(deepest(), false);
  }

 private:
  /// Where a drive is after a substep.
  struct Motion {
    double ahead_m, speed_mps, acceleration_mps2;
  };

  struct Waiting {
    double cost;
    int node;
    bool operator<(const Waiting& other) const {  // the top of a queue is the largest
      return cost != other.cost ? cost > other.cost : node > other.node;
    }
  };

  double layer_s() const { return kSubstep_s * substeps_; }

  /// Beyond a goal nothing counts.
  bool has_way_on(const Node& node) const {
    if (!q_.goals.empty() && node.reached) return true;
    return !who_bars_way_on(state_of(node), q_.occupancy, q_.end_m);
  }

  SpeedState state_of(const Node& node) const {
    return {layer_s() * node.layer, node.ahead_m, node.speed_mps, node.acceleration_mps2,
            node.command_mps2};
  }

  double wanted_mps(double ahead_m) const {
    return std::min(q_.most_wanted_mps, speeds_.wanted_mps(ahead_m));
  }

  void expand(int index) {
    const Node from = nodes_[static_cast<std::size_t>(index)];
    for (const double command : commands_) follow(index, from, command);
    const double hold = std::clamp(0.8 * (wanted_mps(from.ahead_m) - from.speed_mps), -1.2, 1.2);
    follow(index, from, std::clamp(hold, options_.least_mps2, options_.most_mps2));
  }

  /// Drives one layer on with a constant command; keeps the end if it is the best of its cell.
  /// Whether anything is touched on the way is asked last: most ends are not the best anyway.
  void follow(int index, const Node& from, double command) {
    const bool rests = may_rest(from, command);
    if (rests) move(from, command);
    const Motion end = rests ? drive_.back() : motion_at(responses_.back(), from, command);
    Node to = from;
    to.parent = index;
    to.layer = from.layer + 1;
    to.is_done = false;
    to.command_mps2 = command;
    to.ahead_m = end.ahead_m;
    to.speed_mps = end.speed_mps;
    to.acceleration_mps2 = end.acceleration_mps2;
    const auto key = key_of(to);
    if (!key) return;
    StateTable::Cell& cell = cells_.at(*key);
    const double bend_mps = bend_excess_mps(to), own_cost = cost_of(to, bend_mps);
    const double change = command - from.command_mps2;
    const auto with = [&](double nearness_cost, double touch) {
      return from.cost +
             (layer_s() * (own_cost + nearness_cost) + kChange * change * change + touch);
    };
    if (is_dearer(with(0.0, 0.0), cell, from)) return;
    const double nearness_cost = nearness(to, to.layer * substeps_);
    if (is_dearer(with(nearness_cost, 0.0), cell, from)) return;
    if (!rests) move(from, command);
    if (!drives(to) || (to.layer == layers_ && !has_way_on(to))) return;
    to.bend_excess_mps = std::max(from.bend_excess_mps, bend_mps);
    to.cost = with(nearness_cost, to.touched && !from.touched ? kTouchAfterGoal : 0.0);
    keep(to, to.reached ? cell.after_goal : cell.before_goal);
  }

  /// Whether a drive may come to rest within a layer.
  bool may_rest(const Node& from, double command) const {
    const double least_mps2 = std::min({0.0, from.acceleration_mps2, command});
    return from.speed_mps + least_mps2 * responses_.back().t_s <= 0.0;
  }

  /// Of one that goes on moving.
  static Motion motion_at(const Response& r, const Node& from, double command) {
    const double lagging = from.acceleration_mps2 - command;
    return {from.ahead_m + from.speed_mps * r.t_s + 0.5 * command * r.t_s * r.t_s +
                lagging * r.lag_square_s2,
            from.speed_mps + command * r.t_s + lagging * r.lag_way_s, command + lagging * r.decay};
  }

  /// Fills drive_.
  void move(const Node& from, double command) {
    double last_m = from.ahead_m;
    for (std::size_t i = 0; i < drive_.size(); ++i) {
      Motion& to = drive_[i] = motion_at(responses_[i], from, command);
      if (to.speed_mps <= 0.0) {
        to = {last_m, 0.0, 0.0};
      } else {
        to.ahead_m = std::max(last_m, to.ahead_m);
      }
      last_m = to.ahead_m;
    }
  }

  /// Whether drive_ may be driven; what it reaches and touches on the way is noted.
  bool drives(Node& node) const {
    const int before = (node.layer - 1) * substeps_;
    for (std::size_t i = 0; i < drive_.size(); ++i) {
      const int substep = before + static_cast<int>(i) + 1;
      if (!may_be_there(node, drive_[i], substep)) return false;
    }
    return true;
  }

  bool may_be_there(Node& node, const Motion& at, int substep) const {
    const bool is_past = at.ahead_m > q_.end_m;
    if (is_past && !node.reached) return false;
    const bool hit = is_past || q_.occupancy.is_blocked(substep, at.ahead_m);
    if (hit && (q_.goals.empty() || !node.reached)) return false;
    node.touched = node.touched || hit;
    const bool may_reach = !node.reached && may_reach_[static_cast<std::size_t>(node.layer - 1)];
    if (may_reach) look_at_goals(node, at, kSubstep_s * substep);
    return true;
  }

  static double outside(const Window& window, double value) {
    return std::max({0.0, window.least - value, value - window.most});
  }

  /// The time nearest to a substep at which a goal counts; none within half a substep of it.
  static std::optional<double> moment_s(const GoalAhead& goal, double t_s) {
    double moment = std::clamp(t_s, goal.time_s.least, goal.time_s.most);
    if (goal.step_s > 0.0) {
      const auto steps = [&](double time_s) { return (time_s - goal.a_step_s) / goal.step_s; };
      const double first = std::ceil(steps(goal.time_s.least) - kRounding);
      const double last = std::floor(steps(goal.time_s.most) + kRounding);
      if (first > last) return std::nullopt;
      moment = goal.a_step_s + goal.step_s * std::clamp(std::round(steps(t_s)), first, last);
    }
    if (std::abs(moment - t_s) > kTimeSlack_s) return std::nullopt;
    return moment;
  }

  bool may_reach_goal_in(int layer) const {
    for (int i = 1; i <= substeps_; ++i) {
      const double t_s = kSubstep_s * (layer * substeps_ + i);
      const auto is_time = [&](const GoalAhead& goal) { return moment_s(goal, t_s).has_value(); };
      if (std::ranges::any_of(q_.goals, is_time)) return true;
    }
    return false;
  }

  void look_at_goals(Node& node, const Motion& at, double t_s) const {
    for (const GoalAhead& goal : q_.goals) {
      const auto moment = moment_s(goal, t_s);
      if (!moment) continue;
      const double ahead_m =
          at.ahead_m + (goal.step_s > 0.0 ? at.speed_mps * (*moment - t_s) : 0.0);
      const double miss =
          outside(goal.ahead_m, ahead_m) + 2.0 * outside(goal.speed_mps, at.speed_mps);
      node.miss = std::min(node.miss, miss);
      node.reached = node.reached || miss <= 0.0;
    }
  }

  /// Per second, but for what is near.
  double cost_of(const Node& to, double bend_mps) const {
    const double wanted = wanted_mps(to.ahead_m);
    const double missing = (wanted - to.speed_mps) / std::max(5.0, wanted);
    double cost = missing > 0.0 ? missing * missing : kTooFast * missing * missing;
    cost += kCommand * to.command_mps2 * to.command_mps2;
    return cost + kBend * bend_mps * bend_mps;
  }

  double bend_excess_mps(const Node& node) const {
    return std::max(0.0, node.speed_mps - speeds_.most_mps(node.ahead_m));
  }

  double nearness(const Node& node, int substep) const {
    const double keep_ahead = 1.5 + 0.8 * node.speed_mps, keep_behind = 1.0 + 0.1 * node.speed_mps;
    const double ahead = std::min(keep_ahead, q_.occupancy.gap_ahead_m(substep, node.ahead_m));
    const double behind = std::min(keep_behind, q_.occupancy.gap_behind_m(substep, node.ahead_m));
    const double a = 1.0 - ahead / keep_ahead, b = 1.0 - behind / keep_behind;
    return kNearAhead * a * a + kNearBehind * b * b;
  }

  /// With the lag T, s + T v and v + T a follow the command as a double integrator does, whatever a
  /// is now. So states of one layer and one cell of these two go on alike, which those of one cell
  /// of s and v do not. None: too fast for any vehicle.
  std::optional<std::uint64_t> key_of(const Node& node) const {
    constexpr std::uint64_t columns = 128, rows = 1U << 20U;
    const double lag_s = options_.actuator_lag_s;
    const double future_mps = node.speed_mps + lag_s * (node.acceleration_mps2 - kLeast_mps2);
    const auto column = static_cast<std::uint64_t>(std::max(0.0, future_mps) / kCell_mps);
    const auto row = static_cast<std::uint64_t>((node.ahead_m + lag_s * node.speed_mps) / kCell_m);
    if (column >= columns || row >= rows) return std::nullopt;
    return (static_cast<std::uint64_t>(node.layer) * rows + row) * columns + column;
  }

  /// Whether a state is dearer than what its cell holds, be it before or after the goal.
  bool is_dearer(double cost, const StateTable::Cell& cell, const Node& from) const {
    const auto is_better = [&](int kept) {
      return kept >= 0 && nodes_[static_cast<std::size_t>(kept)].cost <= cost;
    };
    if (from.reached) return is_better(cell.after_goal);
    const bool may_reach = may_reach_[static_cast<std::size_t>(from.layer)];
    return is_better(cell.before_goal) && (!may_reach || is_better(cell.after_goal));
  }

  void keep(const Node& node, int& kept) {
    if (kept < 0) {
      kept = static_cast<int>(nodes_.size());
      nodes_.push_back(node);
    } else {
      Node& other = nodes_[static_cast<std::size_t>(kept)];
      if (other.is_done || other.cost <= node.cost) return;
      other = node;
    }
    queue_.push({node.cost + least_rest(node), kept});
  }

  /// What a state will at least cost yet.
  double least_rest(const Node& node) const {
    if (node.layer == layers_) return node.reached ? 0.0 : missed_cost(node.miss);
    const SpeedSearchPlace at{layer_s() * node.layer, node.ahead_m, node.speed_mps,
                              node.acceleration_mps2};
    const double before_end = node.touched ? 0.0 : remaining_->before_end(at);
    const double slow = q_.goals.empty() ? before_end : std::min(before_end, kTouchAfterGoal);
    return std::max(slow, node.reached ? 0.0 : least_missed_cost(node, at));
  }

  bool goal_ends_within_horizon() const {
    return std::ranges::any_of(q_.goals, [&](const GoalAhead& goal) {
      return goal.time_s.most <= layer_s() * layers_ + kTimeSlack_s;
    });
  }

  double missed_cost(double miss) const {
    return ends_within_horizon_ && miss > 0.0 ? kMissedGoal + kMissPerMetre * std::min(miss, 1e3)
                                              : 0.0;
  }

  double total(const Node& node) const {
    return node.cost + (node.reached ? 0.0 : missed_cost(node.miss));
  }

  /// Of all that a state may lead to: what it can reach by the strongest commands.
  double least_missed_cost(const Node& node, const SpeedSearchPlace& at) const {
    double miss = node.miss;
    for (const GoalAhead& goal : q_.goals)
      miss = std::min(miss, remaining_->miss(at, goal, kTimeSlack_s));
    return missed_cost(miss);
  }

  /// Of the states that came farthest, the slowest; of those the cheapest.
  int deepest() const {
    const auto is_before = [](const Node& a, const Node& b) {
      return std::tuple(-a.layer, a.speed_mps, a.cost) < std::tuple(-b.layer, b.speed_mps, b.cost);
    };
    return static_cast<int>(std::ranges::min_element(nodes_, is_before) - nodes_.begin());
  }

  SpeedSearchAnswer answer(int end, bool is_free) const {
    SpeedSearchAnswer found;
    const Node& last = nodes_[static_cast<std::size_t>(end)];
    found.is_free = is_free;
    found.misses_goal = q_.goal_is_off_path || (!last.reached && ends_within_horizon_);
    found.reaches_goal = last.reached && !q_.goals.empty() && !q_.goal_is_off_path;
    found.free_until_s = layer_s() * last.layer;
    found.bend_excess_mps = last.bend_excess_mps;
    if (is_free) found.cost = total(last) + (q_.goal_is_off_path ? kMissedGoal : 0.0);
    for (int i = end; i >= 0; i = nodes_[static_cast<std::size_t>(i)].parent) {
      found.plan.push_back(state_of(nodes_[static_cast<std::size_t>(i)]));
    }
    std::ranges::reverse(found.plan);
    return found;
  }

  const SpeedSearchQuestion& q_;
  const SpeedSearchOptions& options_;
  PathSpeedLimits speeds_;
  int substeps_ = 3, layers_ = 1;
  bool ends_within_horizon_ = false;  ///< a goal's time
  std::vector<bool> may_reach_;       ///< a goal, on the way from a layer to the next
  std::vector<Response> responses_;
  std::vector<Motion> drive_;  ///< of one command, by substep
  std::vector<double> commands_;
  std::vector<Node> nodes_;
  std::optional<RemainingCost> remaining_;
  StateTable cells_;
  std::priority_queue<Waiting> queue_;
};

}  // namespace

SpeedSearchAnswer search_speed(const SpeedSearchQuestion& question,
                               const SpeedSearchOptions& options) {
  return Search(question, options).run();
}

}  // namespace roadbed::planning::speed
