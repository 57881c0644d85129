#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/tracking/perceived_traffic.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/object_sensor.h"
#include "roadbed/tools/simulation/scenario.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline simulation {

/// Others as the planner of a drive gets to know them: measured, tracked and foreseen. What they
/// truly are is used for nothing but the names of tracks, for readers, and to judge them.
class TrackedTraffic {
 public:
  /// Refers to the world.
  TrackedTraffic(const World& world, const Scenario& scenario);

  /// One cycle.
  /// @param body     of the vehicle, as it truly is: the sensors are on it.
  /// @param vehicle  its pose as it is believed, for whom it plans.
  /// @returns what the planner takes; each has the name of whom it was measured of last.
  std::vector<planning::Obstacle> look(double t_s, const geometry::Rectangle& body,
                                       const geometry::Pose2& vehicle);

  planning::MotionBounds expected() const { return perceived_.expected(); }

  double range_m() const { return range_m_; }  ///< farther away nobody is measured

  /// Whom one of those that the planner takes was measured of last: its index in the world.
  std::size_t obstacle_of(std::size_t index) const {
    return obstacle_of_[index / planning::PerceivedTraffic::kPlacesPerSlot];
  }

  /// What each that moves may do in the next seconds.
  std::vector<ForeseenMotion> foreseen() const;

  const TrackingQuality& quality() const { return quality_; }

 private:
  void name(std::span<const SeenObject> seen);
  void judge(double t_s, std::span<const SeenObject> seen);

  void track(double t_s, std::span<const SeenObject> seen, const geometry::Rectangle& body);

  const World& world_;
  double range_m_;
  ObjectSensor sensor_;
  planning::PerceivedTraffic perceived_;
  std::vector<std::size_t> obstacle_of_;  ///< per slot: of whom it was measured last
  TrackingQuality quality_;
};

}  // namespace roadbed::tools::simulation
