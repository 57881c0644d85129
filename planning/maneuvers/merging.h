#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/planning/maneuvers/merge_gap.h"
#include "roadbed/planning/maneuvers/merge_places.h"
#include "roadbed/planning/obstacles/movers_on_line.h"
#include "roadbed/planning/right_of_way/right_of_way.h"
#include "roadbed/planning/task/driving_task.h"

namespace roadbed::planning::inline maneuvers {

/// Whose gap to merge into where the route changes lanes, and how fast to drive up to there.
///
///      ─────────────────────────────────────────────────────────
///        ▭▶ behind        ·(gap)·     ▭▶ ahead
///      ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─╱─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─
///        ▭▶ ──── speed adapted ──╱ enter
///      ──────────────────first────────────────────hold────last──
///
/// Where others drive in the next lane the route's line is left: the vehicle keeps to its own lane
/// as far as that goes, and merges where the gap is, as soon as it is there. The gap is chosen from
/// 150 m before the window on and kept as long as it can be had. Where there is none the vehicle
/// waits at the end, before the next lane, and goes when one comes.
class Merging {
 public:
  enum class Along {
    route_line,  ///< nobody is there, or the change is made
    own_lane,    ///< MergeLines::own_lane
    next_lane,   ///< MergeLines::next_lane: the gap is there, the vehicle changes lanes
  };
  /// A change for which there is no gap so far.
  struct NoGap {
    std::size_t leg;      ///< of the route, that it leaves
    double braking_mps2;  ///< that waiting at its end takes from now on
  };
  struct Decision {
    Along along = Along::route_line;
    std::optional<StopConstraint> halt = {};  ///< no gap so far; of the line that is driven along
    std::optional<NoGap> no_gap = {};         ///< with a halt
    std::optional<double> most_mps = {};      ///< up to the place, to come into the gap
    std::vector<bool> comes_behind = {};      ///< per obstacle: it will follow; empty: nobody
    /// Obstacle in whose lane the vehicle has come: it is fallen back from gently.
    std::optional<std::size_t> merged_behind = {};
    std::string reason = {};  ///< whose gap; empty: there is nobody

    bool is_near() const { return along != Along::route_line || halt || !comes_behind.empty(); }
  };

  Merging(const geometry::VehicleShape& vehicle, const DrivingTask& task,
          const SpeedCeiling& ceiling);

  /// @param view        beside the route's line.
  /// @param driven_s_m  station of the rear axle on the line that is driven along.
  Decision look(const ViewOnLine& view, double driven_s_m);

  /// Those of the decision; null along the route's line.
  const std::shared_ptr<const MergeLines>& lines() const { return lines_; }

 private:
  /// What is looked at in one cycle.
  struct Scene {
    const ViewOnLine& view;
    const MergePlace& place;
    double driven_s_m;
    double front_m;   ///< station of the next lane
    double beside_m;  ///< distance from its middle, of the rear axle
    std::vector<MergeMover> movers;
  };

  const MergePlace* next_place(const ViewOnLine& view);
  Scene scene_at(const MergePlace& place, const ViewOnLine& view, double driven_s_m) const;
  bool has_entered(const Scene& scene) const;
  void leave_route_line(const Scene& scene);
  MergingVehicle before_places(const Scene& scene) const;
  std::vector<double> places_in_window_m(const Scene& scene) const;
  double to_enter_now_m(double speed_mps) const;
  Decision choosing(const Scene& scene);
  Decision entering(const Scene& scene) const;
  Decision approaching(const MergeGap& gap, const Scene& scene) const;
  Decision waiting(const MergeGap& gap, const Scene& scene) const;
  double hold_s_m(const Scene& scene) const;
  std::string name_of(std::size_t obstacle) const;

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  const SpeedCeiling& ceiling_;
  std::vector<MergePlace> places_;
  std::size_t next_ = 0;  ///< the first place that is not behind
  std::shared_ptr<const MergeLines> lines_;
  bool has_no_lines_ = false;  ///< the next place: not asked for again, as they take long to make
  Along along_ = Along::route_line;
  double begun_enter_m_ = 0.0;                ///< station of the next lane, of the change begun
  std::optional<MergeGap> taken_;             ///< of the last look
  std::optional<std::size_t> merged_behind_;  ///< at the last place
  bool has_entered_ = false;                  ///< the next place
};

/// Length over which a lane is changed at a speed.
double change_length_m(double speed_mps);

}  // namespace roadbed::planning::maneuvers
