#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/planning/maneuvers/zip_merge.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/tools/simulation/obstacle_motion.h"
#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tools::inline simulation {

/// The end of a lane beside a way.
struct LaneEndBeside {
  std::size_t end = 0;        ///< the same for all ways
  geometry::LinePosition at;  ///< of the lane's middle, by the way
};

/// Somebody who drives along lanes at wanted speeds, and keeps a distance from whoever is ahead.
struct LaneDriver {
  std::string obstacle;  ///< id
  Way way;               ///< of its centre
  double way_length_m = 0.0;
  /// Place of a point along the way and beside it.
  std::function<geometry::LinePosition(const Eigen::Vector2d& point)> place_of;
  std::vector<TimedSpeed> speeds;
  std::vector<LaneEndBeside> lane_ends = {};  ///< who comes from there is let in in turn
};

/// The body of the vehicle that is simulated, and its speed along its axis.
struct DrivenBody {
  geometry::Rectangle body;
  double speed_mps = 0.0;
};

/// Car following by the Intelligent Driver Model, in its improved form (Treiber and Kesting,
/// Traffic Flow Dynamics, section 11.3.7), for those who drive at wanted speeds v₀(t):
///
///     s* = s₀ + max(0, v T + v Δv / (2 √(a b))),   z = s* / s
///     dv/dt = a (1 − z²) where z ≥ 1; else as wanted
///
/// Where the lane beside ends, they let others in in turn (ZipMerge).
///
/// Who is not hindered drives exactly as its speeds say. Its future, as far as others foresee it,
/// is that of its speeds; that of somebody who has been hindered is its present speed.
class TrafficFlow {
 public:
  struct Options {
    double headway_s = 1.2;       ///< T
    double standstill_m = 2.0;    ///< s₀
    double speeds_up_mps2 = 1.5;  ///< a
    double brakes_mps2 = 2.0;     ///< b, comfortably
    double hardest_mps2 = 8.0;
  };
  static constexpr double kStep_s = 0.1;
  /// Motions last so much longer than a drive: longer than anybody plans ahead.
  static constexpr double kForeseenFor_s = 20.0;

  /// Sets everybody to the start. Drivers whose obstacle is not there are left out.
  /// @param drivers    outlive it.
  /// @param obstacles  kept by reference; the motions of drivers are replaced as they drive.
  TrafficFlow(const std::vector<LaneDriver>& drivers, std::vector<planning::Obstacle>& obstacles,
              double duration_s, const Options& options);

  /// Drives everybody on by one step, behind whoever is ahead now. O(drivers · obstacles), a
  /// projection for each that is near.
  void step(const DrivenBody& vehicle);

 private:
  struct Car {
    const LaneDriver* driver;
    std::size_t obstacle;
    double s_m, speed_mps;
    bool hindered;  ///< at any time so far
  };
  /// Everybody who moves, the vehicle last.
  struct Body {
    std::string id;  ///< of the obstacle; the vehicle's is empty
    geometry::Rectangle body;
    double speed_mps;
  };
  struct Ahead {
    double gap_m, speed_mps;
  };

  Ahead ahead_of(const Car& car, const DrivenBody& vehicle) const;
  double braking_mps2(const Car& car, const Ahead& ahead) const;
  std::vector<Body> movers(const DrivenBody& vehicle) const;
  double to_end_m(const Car& car, const LaneEndBeside& beside) const;
  std::vector<planning::ZipBody> waiting_at(const Car& car, const LaneEndBeside& beside,
                                            const std::vector<Body>& movers) const;
  void take_turns(const std::vector<Body>& movers);
  double letting_in_mps2(const Car& car, const std::vector<Body>& movers) const;
  void drive(Car& car, double braking_mps2);
  void foresee(const Car& car);

  std::vector<planning::Obstacle>& obstacles_;
  Options options_;
  std::vector<Car> cars_;
  planning::ZipMerge zip_;
  int steps_ = 0;
};

}  // namespace roadbed::tools::simulation
