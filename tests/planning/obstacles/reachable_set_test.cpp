#include "roadbed/planning/obstacles/reachable_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <optional>
#include <random>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::planning {
namespace {

using geometry::Pose2;
using geometry::Rectangle;

constexpr double kStep_s = 0.1, kRounding_m = 1e-3;

/// Corners, and the middles of the sides.
std::vector<Eigen::Vector2d> points_of(const Rectangle& body) {
  std::vector<Eigen::Vector2d> points;
  const auto corners = body.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    points.push_back(corners[i]);
    points.emplace_back(0.5 * (corners[i] + corners[(i + 1) % corners.size()]));
  }
  return points;
}

/// How far the farthest point of a body is from all of the rectangles [m].
double outside_m(const std::vector<Rectangle>& set, const Rectangle& body) {
  double farthest_m = 0.0;
  for (const Eigen::Vector2d& point : points_of(body)) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Rectangle& part : set) {
      nearest_m = std::min(nearest_m, geometry::distance_m(part, point));
    }
    farthest_m = std::max(farthest_m, nearest_m);
  }
  return farthest_m;
}

/// Somebody who drives along lanes as he likes: every half second another acceleration, and another
/// speed to the side; turns where lanes part. All of it within what he is said to be able to.
class RandomDriver {
 public:
  RandomDriver(const map::RoadMap& road_map, const MotionBounds& bounds, std::mt19937& random)
      : map_(road_map), bounds_(bounds), random_(random) {
    do {
      lane_ = map::LaneId{static_cast<std::uint32_t>(
          std::uniform_int_distribution<std::size_t>(0, map_.lanes().size() - 1)(random_))};
    } while (!map::is_drivable(lane().type) || lane().length_m() < 1.0);
    s_m_ = uniform(0.0, lane().length_m());
    speed_mps_ = uniform(0.0, 1.0) < 0.1 ? 0.0 : uniform(0.0, most_mps());
    d_m_ = uniform(-room_m(), room_m());
    choose();
  }

  Pose2 pose() const {
    return lane().pose_at(s_m_) *
           Pose2{0.0, d_m_, std::atan2(aside_mps(), std::max(1e-9, speed_mps_))};
  }
  double speed_mps() const { return std::hypot(speed_mps_, aside_mps()); }

  /// False where his lanes end, or become narrow faster than he may give way.
  bool go_on() {
    t_s_ += kStep_s;
    if (t_s_ > next_s_) choose();
    const double before_mps = speed_mps_;
    speed_mps_ = std::clamp(speed_mps_ + mps2_ * kStep_s, 0.0, std::max(speed_mps_, most_mps()));
    aside_mps_ +=
        std::clamp(wanted_aside_mps_ - aside_mps_, -aside_mps2() * kStep_s, aside_mps2() * kStep_s);
    d_m_ += aside_mps() * kStep_s;
    if (std::abs(d_m_) > room_m()) {
      const double back_m = std::abs(d_m_) - room_m();
      if (back_m > bounds_.max_sideways_mps * kStep_s) return false;  // the lane ends
      d_m_ = std::clamp(d_m_, -room_m(), room_m());
      aside_mps_ = 0.0;
    }
    s_m_ += 0.5 * (before_mps + speed_mps_) * kStep_s;
    while (s_m_ > lane().length_m()) {
      s_m_ -= lane().length_m();
      std::vector<map::LaneId> next;
      for (const map::LaneId id : map_.graph().of(lane_).successors) {
        if (map::is_drivable(map_.lane(id).type)) next.push_back(id);
      }
      if (next.empty()) return false;
      lane_ = next[std::uniform_int_distribution<std::size_t>(0, next.size() - 1)(random_)];
    }
    return true;
  }

 private:
  const map::Lane& lane() const { return map_.lane(lane_); }
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  double most_mps() const {
    return std::min(40.0, bounds_.max_speeding * lane().least_speed_limit_mps().value_or(20.0));
  }
  /// Both together are less than the greatest acceleration, with something left for bends.
  double aside_mps2() const { return 0.4 * bounds_.max_acceleration_mps2; }
  double along_mps2() const { return 0.8 * bounds_.max_acceleration_mps2; }
  /// Who keeps his lane does so with his whole body; others use what is beside.
  double room_m() const {
    const double half_m = 0.5 * lane().width_m(s_m_);
    return bounds_.keeps_lane ? std::max(0.0, half_m - 0.9) : half_m;
  }
  double aside_mps() const {  // nobody slides to the side
    const double most_mps = bounds_.max_turned_sine * speed_mps_;
    return std::clamp(aside_mps_, -most_mps, most_mps);
  }
  void choose() {
    next_s_ = t_s_ + 0.5;
    const double extreme = uniform(0.0, 1.0);
    const double most_mps2 = std::min(along_mps2(), bounds_.max_gain_mps2);
    mps2_ = extreme < 0.3   ? -along_mps2()
            : extreme < 0.6 ? most_mps2
                            : uniform(-along_mps2(), most_mps2);
    wanted_aside_mps_ = uniform(-bounds_.max_sideways_mps, bounds_.max_sideways_mps);
  }

  const map::RoadMap& map_;
  MotionBounds bounds_;
  std::mt19937& random_;
  map::LaneId lane_{0};
  double s_m_ = 0.0, d_m_ = 0.0, speed_mps_ = 0.0, aside_mps_ = 0.0;
  double mps2_ = 0.0, wanted_aside_mps_ = 0.0;
  double t_s_ = 0.0, next_s_ = 0.0;
};

Obstacle seen_at(const Pose2& pose, double speed_mps) {
  const Pose2 later = pose * Pose2{speed_mps, 0.0, 0.0};
  const auto point = [&](double t_s, const Pose2& at) {
    return geometry::TrajectoryPoint{.t_s = t_s,
                                     .x_m = at.x_m,
                                     .y_m = at.y_m,
                                     .heading_rad = at.heading_rad,
                                     .speed_mps = speed_mps};
  };
  return {.id = "a", .motion = geometry::Trajectory({point(0.0, pose), point(1.0, later)})};
}

/// Whether who is here now has been where his velocity led, but for this acceleration, since.
bool is_within_reach(const Pose2& start, double speed_mps, const Pose2& now, double after_s,
                     double mps2) {
  const Eigen::Vector2d straight_on = (start * Pose2{speed_mps * after_s, 0.0, 0.0}).position();
  return (now.position() - straight_on).norm() <= 0.5 * mps2 * after_s * after_s;
}

struct Held {
  int behaviours = 0, times = 0, escapes = 0;
  double worst_m = 0.0;
};

Held held_of(const map::RoadMap& road_map, const MotionBounds& bounds, int behaviours) {
  std::mt19937 random(7);
  Held held;
  for (int i = 0; i < behaviours; ++i) {
    RandomDriver driver(road_map, bounds, random);
    const Pose2 start = driver.pose();
    const double speed_mps = driver.speed_mps();
    const ReachableSet set(road_map, seen_at(start, speed_mps), 0.0, 3.0, bounds);
    ++held.behaviours;
    for (double t_s = kStep_s; t_s < 3.05 && driver.go_on(); t_s += kStep_s) {
      if (!is_within_reach(start, speed_mps, driver.pose(), t_s, bounds.max_acceleration_mps2))
        break;
      const double off_m = outside_m(set.between(t_s, t_s), body_around(driver.pose(), 4.5, 1.8));
      ++held.times;
      held.escapes += off_m > kRounding_m;
      held.worst_m = std::max(held.worst_m, off_m);
    }
  }
  return held;
}

TEST(ReachableSet, HoldsTenThousandBehaviours) {
  const map::RoadMap road_map = map::load_map(tests::data_folder() / "town.xodr");
  for (const MotionBounds& bounds : {MotionBounds{}, by_the_rules()}) {
    const Held held = held_of(road_map, bounds, 5000);
    EXPECT_EQ(held.escapes, 0) << held.worst_m << " m";
    EXPECT_GT(held.times, 10 * held.behaviours);
    std::cout << held.behaviours << " behaviours at " << held.times << " times\n";
  }
}

/// Whether a recording says another speed than it moves at.
bool contradicts_itself(const Obstacle& other, double t_s) {
  constexpr double kApart_mps = 1.0, kOver_s = 0.5;
  const double over_s = std::min(kOver_s, other.motion.end_s() - t_s);
  const auto now = other.motion.at(t_s), then = other.motion.at(t_s + over_s);
  const double moves_mps = (then.pose().position() - now.pose().position()).norm() / over_s;
  return std::abs(moves_mps - 0.5 * std::abs(now.speed_mps + then.speed_mps)) > kApart_mps;
}

TEST(ReachableSet, HoldsAllRecordedTraffic) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  Held held, by_rules;
  int contradictions = 0, unreadable = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "commonroad")) {
    if (entry.path().extension() != ".xml") continue;
    std::optional<tools::CommonRoadDrive> problem;
    try {
      problem.emplace(tools::read_common_road_drive(entry.path()));
    } catch (const std::exception&) {
      ++unreadable;  // or refused: maps and solutions lie there, too
      continue;
    }
    const tools::World& world = problem->world;
    std::map<std::string, int> escapes;
    for (const Obstacle& other : world.obstacles) {
      if (other.is_static()) continue;
      ++held.behaviours;
      for (double from_s = other.motion.start_s(); from_s < other.motion.end_s(); from_s += 0.5) {
        if (contradicts_itself(other, from_s)) {
          ++contradictions;
          continue;
        }
        const ReachableSet set(world.road_map, other, from_s, 3.0, {});
        const ReachableSet lawful(world.road_map, other, from_s, 3.0, by_the_rules());
        for (const double after_s : {0.2, 0.5, 1.0, 2.0, 3.0}) {
          if (from_s + after_s > other.motion.end_s()) break;
          const Rectangle body = rectangle_at(other, from_s + after_s);
          const double off_m = outside_m(set.between(after_s, after_s), body);
          ++held.times;
          held.escapes += off_m > kRounding_m;
          by_rules.escapes += outside_m(lawful.between(after_s, after_s), body) > kRounding_m;
          if (off_m > kRounding_m && escapes[other.id]++ < 3) {
            std::cout << entry.path().stem().string() << " " << other.kind << " " << other.id
                      << " at " << from_s << " after " << after_s << ": " << off_m << " m, "
                      << other.motion.at(from_s).speed_mps << " m/s\n";
          }
          held.worst_m = std::max(held.worst_m, off_m);
        }
      }
    }
  }
  EXPECT_GT(held.times, 1000);
  EXPECT_EQ(held.escapes, 0) << "of " << held.times << ", " << held.worst_m << " m";
  std::cout << held.times << " places of " << held.behaviours << "; " << by_rules.escapes
            << " by the rules escape; left out: " << contradictions
            << " states whose speed contradicts their motion, " << unreadable
            << " files that are no problem to drive\n";
}

}  // namespace
}  // namespace roadbed::planning
