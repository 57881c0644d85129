#include "roadbed/planning/speed/drive_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <unordered_set>
#include <utility>

namespace roadbed::planning::inline speed {
namespace {

constexpr double kDriveStep_s = TrafficBodies::kStep_s;
constexpr int kStepsInLayer = 3;
constexpr std::array<double, 5> kLateralShares{-1.0, -0.5, 0.0, 0.5, 1.0};
constexpr std::array<double, 5> kCommands_mps2{-geometry::kLongitudinal.max_braking_mps2, -3.0, 0.0,
                                               2.0, 4.0};
constexpr double kRounding_mps2 = 0.1;  // of the lateral acceleration, while the speed changes
// States that are alike.
constexpr double kAlike_m = 1.2, kAlike_rad = 0.05, kAlike_mps = 2.0, kAlikeLateral_mps2 = 2.0,
                 kAlikeAlong_mps2 = 4.0;
constexpr std::size_t kFew = 3;     // times as many as are kept are not thinned
constexpr double kChance_m = 12.0;  // by which nearness to the goal does not matter
constexpr double kGoalAlong_m = 0.3, kGoalAside_m = 0.2;  // kept from its edges
constexpr double kLanesApart_m = 0.01;                    // lanes of real files do not meet exactly

struct DriveState {
  geometry::Pose2 pose;
  double speed_mps, acceleration_mps2, curvature_per_m;
};

struct DriveNode {
  std::array<DriveState, kStepsInLayer> states;
  int parent;
  const DriveState& end() const { return states.back(); }
};

/// The same numbers each time, evenly in [0, 1).
class Chance {
 public:
  double next() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 11U) * 0x1.0p-53;
  }

 private:
  std::uint64_t state_ = 20261124;
};

/// Which of the states at the end of a layer are looked at, one after the other: by turns the
/// nearest to the goal and any.
class Turns {
 public:
  Turns(const std::vector<DriveNode>& children, const std::optional<Eigen::Vector2d>& aim,
        Chance& chance)
      : by_chance_(children.size()) {
    std::iota(by_chance_.begin(), by_chance_.end(), std::size_t{0});
    for (std::size_t i = by_chance_.size(); i > 1; --i) {
      const auto other = static_cast<std::size_t>(chance.next() * static_cast<double>(i));
      std::swap(by_chance_[i - 1], by_chance_[other]);
    }
    if (!aim) return;
    for (std::size_t i = 0; i < children.size(); ++i) {
      const double away_m = (children[i].end().pose.position() - *aim).norm();
      by_nearness_.emplace_back(-away_m - kChance_m * chance.next(), i);
    }
    std::ranges::make_heap(by_nearness_);
  }

  std::optional<std::size_t> next() {
    is_near_ = !is_near_ && !by_nearness_.empty();
    if (is_near_) {
      std::ranges::pop_heap(by_nearness_);
      const std::size_t child = by_nearness_.back().second;
      by_nearness_.pop_back();
      return child;
    }
    if (by_chance_.empty()) return std::nullopt;
    const std::size_t child = by_chance_.back();
    by_chance_.pop_back();
    return child;
  }

 private:
  std::vector<std::size_t> by_chance_;
  std::vector<std::pair<double, std::size_t>> by_nearness_;  ///< a heap
  bool is_near_ = false;
};

class DriveSearch {
 public:
  DriveSearch(const DriveSearchQuestion& question, const DriveSearchOptions& options)
      : q_(question), options_(options), bodies_(question.bodies.times()) {
    for (const TrafficBodies::Body& body : q_.bodies.all()) bodies_[body.step].push_back(&body);
    const auto has_region = [](const GoalState& state) { return !state.region_in_source.empty(); };
    const auto goal = std::ranges::find_if(q_.goal.states, has_region);
    if (goal != q_.goal.states.end()) {
      aim_ = q_.road_map.to_map(middle_of(goal->region_in_source));
    }
  }

  std::vector<VehicleState> run() {
    const std::optional<double> latest_s = q_.goal.latest_s();
    if (!latest_s || *latest_s - q_.now_s > options_.longest_s) return {};
    const int last = static_cast<int>(std::floor((*latest_s - q_.now_s) / kDriveStep_s + 1e-6));
    const DriveState start{
        .pose = q_.start.map_from_vehicle,
        .speed_mps = q_.start.speed_mps,
        .acceleration_mps2 = q_.start.acceleration_mps2,
        .curvature_per_m = std::tan(q_.start.steering_rad) / q_.vehicle.wheelbase_m};
    nodes_.push_back({.states = {start, start, start}, .parent = -1});
    std::size_t first = 0;
    for (int step = 0; step < last; step += kStepsInLayer) {
      const std::size_t end = nodes_.size();
      if (first == end) return {};
      if (const auto steps = lead_on(first, end, step)) return drive_to_last(*steps);
      first = end;
    }
    return {};
  }

 private:
  /// From the nodes of a layer; appends those of the next, up to one from which the goal is met:
  /// after how many steps.
  std::optional<int> lead_on(std::size_t first, std::size_t end, int step) {
    const std::vector<DriveNode> children = children_of(first, end);
    const bool are_few = children.size() < kFew * options_.kept_states;
    Turns turns(children, aim_, chance_);
    std::unordered_set<std::uint64_t> cells;
    std::size_t looked_at = 0;
    while (nodes_.size() - end < options_.kept_states && looked_at < options_.most_looked_at) {
      const std::optional<std::size_t> child = turns.next();
      if (!child) break;
      if (!cells.insert(are_few ? *child : cell_of(children[*child].end())).second) continue;
      ++looked_at;
      if (!is_free(children[*child], step)) continue;
      nodes_.push_back(children[*child]);
      if (const int steps = reaches(nodes_.back(), step)) return steps;
    }
    return std::nullopt;
  }

  /// What a command makes of the speed in each step of a layer, whatever the steering.
  struct Along {
    double speed_mps, acceleration_mps2, mean_mps, square, most_per_m;
  };
  using AlongLayer = std::array<Along, kStepsInLayer>;

  std::vector<DriveNode> children_of(std::size_t first, std::size_t end) const {
    std::vector<DriveNode> children;
    children.reserve((end - first) * kLateralShares.size() * kCommands_mps2.size());
    for (std::size_t i = first; i < end; ++i) {
      std::array<AlongLayer, kCommands_mps2.size()> along;
      for (std::size_t k = 0; k < along.size(); ++k) {
        along[k] = along_layer(nodes_[i].end(), kCommands_mps2[k]);
      }
      const double heading_rad = nodes_[i].end().pose.heading_rad;
      const Eigen::Vector2d ahead(std::cos(heading_rad), std::sin(heading_rad));
      for (const double share : kLateralShares) {
        for (const AlongLayer& speeds : along) add_child(i, share, speeds, ahead, children);
      }
    }
    return children;
  }

  AlongLayer along_layer(const DriveState& from, double command_mps2) const {
    const double h = kDriveStep_s;
    double speed_mps = from.speed_mps, lagging = from.acceleration_mps2 - command_mps2;
    AlongLayer layer;
    for (Along& step : layer) {
      const double before_mps = speed_mps;
      const double gained = lagging * options_.actuator_lag_s / h * (1.0 - decay_);
      speed_mps = std::max(0.0, before_mps + h * (command_mps2 + gained));
      lagging *= decay_;
      const double square = std::max(0.01, speed_mps * speed_mps);
      const double limit = options_.max_lateral_acceleration_mps2 / square;
      step = {.speed_mps = speed_mps,
              .acceleration_mps2 = command_mps2 + lagging,
              .mean_mps = 0.5 * (before_mps + speed_mps),
              .square = square,
              .most_per_m = std::min(most_per_m_, limit)};
    }
    return layer;
  }

  void add_child(std::size_t parent, double share, const AlongLayer& along, Eigen::Vector2d ahead,
                 std::vector<DriveNode>& children) const {
    DriveNode child{.states = {}, .parent = static_cast<int>(parent)};
    const DriveState* from = &nodes_[parent].end();
    for (std::size_t k = 0; k < along.size(); ++k) {
      if (!follow(share, along[k], *from, ahead, child.states[k])) return;
      from = &child.states[k];
    }
    children.push_back(child);
  }

  /// One step, in which the curvature changes evenly; whether the vehicle can drive that.
  /// @param ahead  the heading as a direction; turned with it
  bool follow(double share, const Along& along, const DriveState& from, Eigen::Vector2d& ahead,
              DriveState& to) const {
    const double target_per_m = share * along.most_per_m;
    to.curvature_per_m = std::clamp(target_per_m, from.curvature_per_m - turn_per_m_,
                                    from.curvature_per_m + turn_per_m_);
    const double curvature = 0.5 * (from.curvature_per_m + to.curvature_per_m);
    const double most = std::max(along.mean_mps * along.mean_mps * std::abs(curvature),
                                 along.square * std::abs(to.curvature_per_m));
    if (most > options_.max_lateral_acceleration_mps2 + kRounding_mps2) return false;
    const double way_m = kDriveStep_s * along.mean_mps;
    const Eigen::Vector2d middle = turned(ahead, 0.5 * way_m * curvature);
    to.pose.x_m = from.pose.x_m + way_m * middle.x();
    to.pose.y_m = from.pose.y_m + way_m * middle.y();
    to.pose.heading_rad = from.pose.heading_rad + way_m * curvature;
    to.speed_mps = along.speed_mps;
    to.acceleration_mps2 = along.acceleration_mps2;
    ahead = turned(middle, 0.5 * way_m * curvature);
    return true;
  }

  /// By a small angle, to 1e-12: a step turns by less than 0.2 rad.
  static Eigen::Vector2d turned(const Eigen::Vector2d& direction, double angle_rad) {
    const double square = angle_rad * angle_rad;
    const double cosine =
        1.0 - square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0)));
    const double sine =
        angle_rad * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)));
    return {cosine * direction.x() - sine * direction.y(),
            sine * direction.x() + cosine * direction.y()};
  }

  std::uint64_t cell_of(const DriveState& state) const {
    const geometry::Pose2 &at = state.pose, &start = q_.start.map_from_vehicle;
    const double lateral_mps2 = state.speed_mps * state.speed_mps * state.curvature_per_m;
    const std::array<double, 6> places{(at.x_m - start.x_m) / kAlike_m,
                                       (at.y_m - start.y_m) / kAlike_m,
                                       (at.heading_rad - start.heading_rad) / kAlike_rad,
                                       state.speed_mps / kAlike_mps,
                                       lateral_mps2 / kAlikeLateral_mps2,
                                       state.acceleration_mps2 / kAlikeAlong_mps2};
    constexpr double kMiddle = 512.0;
    std::uint64_t cell = 0;
    for (const double place : places) {
      const double column = std::clamp(kMiddle + std::floor(place), 0.0, 2.0 * kMiddle - 1.0);
      cell = cell * 1024 + static_cast<std::uint64_t>(column);
    }
    return cell;
  }

  /// What is cheapest to find out, and likeliest to fail, comes first.
  bool is_free(const DriveNode& node, int step) const {
    std::array<geometry::Rectangle, kStepsInLayer> bodies;
    for (int i = kStepsInLayer; i-- > 0;) {
      const auto at = static_cast<std::size_t>(i);
      bodies[at] = geometry::body_at(node.states[at].pose, q_.vehicle);
      if (touches(bodies[at], step + i + 1)) return false;
    }
    return std::all_of(bodies.rbegin(), bodies.rend(),
                       [&](const geometry::Rectangle& body) { return is_on_surface(body); });
  }

  bool touches(const geometry::Rectangle& body, int step) const {
    const auto k = static_cast<std::size_t>(step);
    if (k >= bodies_.size()) return false;
    const double radius_m = body.radius_m();
    return std::ranges::any_of(bodies_[k], [&](const TrafficBodies::Body* other) {
      const double reach_m = radius_m + other->radius_m + options_.clearance_m;
      return (body.centre - other->at.centre).squaredNorm() < reach_m * reach_m &&
             geometry::distance_m(body, other->at) <= options_.clearance_m;
    });
  }

  bool is_on_surface(geometry::Rectangle body) const {
    body.half_length_m += options_.border_margin_m;
    body.half_width_m += options_.border_margin_m;
    return std::ranges::all_of(body.corners(), [&](const Eigen::Vector2d& corner) {
      return q_.road_map.on_surface(corner, kLanesApart_m);
    });
  }

  /// After how many steps the goal is met, with room to all sides; 0: not.
  int reaches(const DriveNode& node, int step) const {
    for (int i = 0; i < kStepsInLayer; ++i) {
      const double t_s = q_.now_s + kDriveStep_s * (step + i + 1);
      if (is_inside_goal(node.states[static_cast<std::size_t>(i)], t_s)) return i + 1;
    }
    return 0;
  }

  bool is_inside_goal(const DriveState& state, double t_s) const {
    const auto meets = [&](double ahead_m, double aside_m) {
      const geometry::Pose2 beside = state.pose * geometry::Pose2{ahead_m, aside_m, 0.0};
      return q_.goal.is_reached(q_.road_map, beside, state.speed_mps, t_s, q_.vehicle);
    };
    return meets(0.0, 0.0) && meets(kGoalAlong_m, 0.0) && meets(-kGoalAlong_m, 0.0) &&
           meets(0.0, kGoalAside_m) && meets(0.0, -kGoalAside_m);
  }

  VehicleState vehicle_in(const DriveState& state) const {
    return {.map_from_vehicle = state.pose,
            .speed_mps = state.speed_mps,
            .steering_rad = std::atan(q_.vehicle.wheelbase_m * state.curvature_per_m),
            .acceleration_mps2 = state.acceleration_mps2};
  }

  std::vector<VehicleState> drive_to_last(int steps) const {
    std::vector<VehicleState> drive;
    const DriveNode* node = &nodes_.back();
    for (; node->parent >= 0; node = &nodes_[static_cast<std::size_t>(node->parent)]) {
      for (int k = steps; k-- > 0;) {
        drive.push_back(vehicle_in(node->states[static_cast<std::size_t>(k)]));
      }
      steps = kStepsInLayer;
    }
    drive.push_back(q_.start);
    std::ranges::reverse(drive);
    return drive;
  }

  const DriveSearchQuestion& q_;
  const DriveSearchOptions& options_;
  std::vector<std::vector<const TrafficBodies::Body*>> bodies_;  ///< by step
  std::optional<Eigen::Vector2d> aim_;                           ///< in the map
  std::vector<DriveNode> nodes_;
  Chance chance_;
  double decay_ = std::exp(-kDriveStep_s / options_.actuator_lag_s);  ///< of the lag, in a step
  double most_per_m_ = std::tan(q_.vehicle.max_steering_rad) / q_.vehicle.wheelbase_m;
  double turn_per_m_ = kDriveStep_s * options_.steering_rate_fraction *
                       q_.vehicle.max_steering_rate_radps / q_.vehicle.wheelbase_m;  ///< in a step
};

}  // namespace

std::vector<VehicleState> search_drive(const DriveSearchQuestion& question,
                                       const DriveSearchOptions& options) {
  return DriveSearch(question, options).run();
}

}  // namespace roadbed::planning::speed
