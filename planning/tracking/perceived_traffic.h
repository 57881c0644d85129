#pragma once

#include <map>
#include <span>
#include <vector>

#include "roadbed/geometry/primitives/pose2.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/obstacles/reachable_set.h"
#include "roadbed/planning/tracking/lane_forecast.h"
#include "roadbed/planning/tracking/tracker.h"

namespace roadbed::planning::inline tracking {

/// The traffic as it is measured: tracks, what each of them may do, and that as the obstacles that
/// a planner takes.
class PerceivedTraffic {
 public:
  /// Refers to the map.
  explicit PerceivedTraffic(const map::RoadMap& road_map, const TrackerOptions& options = {});

  /// Takes everything that is measured at a time, and foresees it.
  /// @param is_hidden  as Tracker::observe.
  /// @throws std::invalid_argument as that.
  void observe(double t_s, std::span<const Detection> detections,
               const Tracker::IsHidden& is_hidden = {});

  /// Foresees all at a time at which nothing was measured.
  /// @throws std::invalid_argument as Tracker::foresee.
  void foresee(double t_s);

  const Tracker& tracker() const { return tracker_; }

  /// Per slot of the tracker; empty where that is.
  const std::vector<std::vector<ForecastMotion>>& forecasts() const { return forecasts_; }

  /// As they were, are, and may be: kMostMotions places for each slot, the most likely motion
  /// first, then others that matter to the vehicle; a place without any is never there.
  std::vector<Obstacle> obstacles(const geometry::Pose2& map_from_vehicle);

  /// How they may move by the rules of the road, who are known but for twice the noise.
  MotionBounds expected() const;

  static constexpr std::size_t kPlacesPerSlot = LaneForecast::kMostMotions;

 private:
  void forecast();
  bool is_planned_for(const ForecastMotion& motion, double vehicle_heading_rad);
  bool has_to_give_way(const ForecastMotion& motion);

  const map::RoadMap& road_map_;
  ObjectNoise noise_;
  Tracker tracker_;
  LaneForecast lane_forecast_;
  double across_oncoming_;  ///< sign of a turn across oncoming traffic: 1 left, −1 right
  std::vector<std::vector<ForecastMotion>> forecasts_;
  std::map<map::LaneId, bool> crosses_oncoming_;  ///< of lanes that were asked about
};

}  // namespace roadbed::planning::tracking
