#pragma once

#include <optional>
#include <string>

#include "roadbed/planning/lateral/planned_path.h"
#include "roadbed/planning/obstacles/traffic.h"
#include "roadbed/planning/reference/speed_ceiling.h"
#include "roadbed/planning/right_of_way/hidden_traffic.h"
#include "roadbed/planning/task/driving_task.h"

namespace roadbed::planning::inline right_of_way {

/// Where the vehicle has to stop for now, and why.
struct StopConstraint {
  double s_m = 0.0;  ///< station of the rear axle
  std::string reason;
  double deceleration_mps2 = 1.5;  ///< to stop with, the same as long as the halt is asked for
  bool is_hard = false;            ///< more than the cruise control may ask for
};

/// Looks at the waiting places of a world, one after the other: lights, signs, and gaps in the
/// traffic that has the right of way.
///
/// A gap is good if the vehicle, driving on from here, comes to what it crosses 1 s after the
/// vehicle before it and leaves 1.5 s before the next one, whether it speeds up by 1 m/s² or as its
/// style does, and whether those who speed up, if they are foreseen, do so for 1 s or for 4 s. Who
/// drives along on the path already is the cruise control's lead, and not looked at here. Somebody
/// may come from where nothing is seen (hidden_traffic.h): for that one the vehicle stops as late
/// as it may, where more is seen, and creeps on when for 3 s nobody has come, until it is seen that
/// nobody does, or until it is in the way.
class RightOfWay {
 public:
  /// Time that has to be between two who cross, before and after the vehicle; in steps of 0.1 s.
  struct Gap {
    int before, after;
  };

  /// What is known at one cycle.
  struct View {
    double t_s, s_m, speed_mps;  ///< station of the task's line
    const PlannedPath& path;
    double path_s_m;  ///< station of the path's line
    const SpeedCeiling& ceiling;
    Traffic traffic;
    double acceleration_mps2 = 0.0;
    const Visibility* sight = nullptr;  ///< none: nothing is hidden
  };

  RightOfWay(const geometry::VehicleShape& vehicle, const DrivingOptions& options,
             const DrivingTask& task);

  /// The nearest place that is not to be passed now; none: drive on. A place that cannot be stopped
  /// at with 0.9 of what the cruise control may ask for, when that is first wanted, is passed; a
  /// halt that was asked for stays until the place is free or passed. A light that cannot be passed
  /// either before it is red, at the present speed, is stopped at as hard as that takes, up to what
  /// the vehicle can do.
  std::optional<StopConstraint> look(const View& view);

  /// Per obstacle, whether it is on the path, but only crosses it, and will be gone in time: it is
  /// no lead. Of the last look.
  const std::vector<bool>& crossing() const { return crossing_; }

  /// Not to be driven faster, as somebody may come from where nothing is seen; of the last look.
  std::optional<double> creep_mps() const {
    constexpr double kCreeps_mps = 2.0;
    return creeps_ ? std::optional(kCreeps_mps) : std::nullopt;
  }

 private:
  std::optional<std::string> why_wait(const StopPoint& place, const View& view);
  struct Hidden {
    Obstacle car;
    double in_the_way_from_m;
  };
  std::optional<Hidden> who_hidden_is_met(std::size_t stop_point, const View& view);
  std::optional<std::string> who_may_come(const StopPoint& place, const View& view);
  static constexpr Gap kGapToTake{10, 15}, kGapOnTheWay{3, 3};

  struct Crossing;
  Crossing crossing_of(const StopPoint& place, const View& view, Gap gap) const;
  std::optional<std::string> who_comes(const StopPoint& place, const View& view, Gap gap);
  void pass_places(const View& view);
  bool is_next(const StopPoint& place) const { return &place == &task_.stop_points[next_]; }
  double halt_m(const StopPoint& place) const;
  double look_ahead_m(double speed_mps) const;
  double left_m(const StopPoint& place, const View& view) const;
  std::optional<double> stops_with_mps2(const StopPoint& place, const View& view) const;
  std::optional<double> stops_before_red_mps2(const StopPoint& place, const View& view) const;

  const geometry::VehicleShape& vehicle_;
  double comfort_acceleration_mps2_, comfort_deceleration_mps2_;
  const DrivingTask& task_;
  std::size_t places_ = 0;    ///< how many there were at the last look
  std::size_t next_ = 0;      ///< the first place that is not passed
  bool has_stopped_ = false;  ///< at that one
  std::vector<bool> crossing_;
  HiddenTraffic hidden_;
  bool creeps_ = false;
  std::optional<double> creeps_to_m_;    ///< past the next place, where more is seen
  std::optional<double> looks_since_s_;  ///< standing there
  struct Kept {
    double s_m, deceleration_mps2;
  };
  std::optional<Kept> kept_;  ///< the place that the last look asked to wait at
};

}  // namespace roadbed::planning::right_of_way
