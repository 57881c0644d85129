#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/planning/tracking/motion_filter.h"

namespace roadbed::planning::inline tracking {

/// One object as it is measured.
struct Detection {
  std::string id;  ///< by which it is known from one time to the next; empty: it has none
  std::string kind = "car";
  double length_m = 4.5, width_m = 1.8;
  geometry::Pose2 centre;  ///< in the map
  double speed_mps = 0.0;  ///< along its heading
};

/// An object that has been measured once or more often.
struct Track {
  std::string id;  ///< its own, or "track 7"
  std::string kind;
  double length_m, width_m;
  MotionFilter filter;  ///< at the tracker's time
  double first_s, last_measured_s;
  std::deque<geometry::TrajectoryPoint> past;  ///< of the last second, up to now
  bool has_own_id;
  int measured = 1;                    ///< how often
  std::optional<double> moved_s = {};  ///< when it moved last, if ever
  double expected_s = 0.0;             ///< when it was measured last, or known to be hidden
  /// Which of the last detections is of it; none: it was not measured then.
  std::optional<std::size_t> detection = {};

  /// What has no id and was measured once or twice may be an error, or a body that is there.
  bool is_tentative() const { return !has_own_id && measured < 3; }
};

/// How objects are measured and tracked.
struct TrackerOptions {
  ObjectNoise noise = {};
  double coasts_for_s = 1.0;   ///< an object that is not measured is believed to go on for so long
  double hidden_for_s = 10.0;  ///< the same for one that is hidden where it is believed to be
  double misfit_limit = 23.5;  ///< χ² of four degrees of freedom that one in 10⁴ exceeds
};

/// Objects over time. Detections with an id are of that object; the others are given to the tracks
/// that they fit best in all (assignment.h), within the misfit limit, to tentative ones last, or
/// begin tracks of their own. A tentative track that is not measured ends. A track keeps its slot
/// for as long as it lives, and for ten seconds more nobody else has it.
class Tracker {
 public:
  /// Without any track so far.
  explicit Tracker(const TrackerOptions& options = {}) : options_(options) {}

  /// Whether nobody could be measured at a place of the map.
  using IsHidden = std::function<bool(const Eigen::Vector2d& point_in_map)>;

  /// Takes everything that is measured at a time.
  /// @param is_hidden  none: everybody could be measured.
  /// @throws std::invalid_argument if the time is not later than that of the call before, or two
  ///         detections have one id.
  void observe(double t_s, std::span<const Detection> detections, const IsHidden& is_hidden = {});

  /// Lets time pass in which nothing was measured: all are believed to go on, as if hidden.
  /// @throws std::invalid_argument if the time is not later than that of the call before.
  void foresee(double t_s);

  /// Tracks of now; a slot may be empty.
  std::span<const std::optional<Track>> slots() const { return slots_; }

 private:
  void go_on(double t_s);
  void give_by_id(std::span<const Detection> detections, std::vector<bool>& is_taken);
  void give_by_fit(std::span<const Detection> detections, bool to_tentative,
                   std::vector<bool>& is_taken);
  void take(Track& track, std::span<const Detection> detections, std::size_t at) const;
  void begin(std::span<const Detection> detections, std::size_t at);
  void expect(const IsHidden& is_hidden);
  void remember();
  MeasuredMotion measured(const Detection& detection) const;

  TrackerOptions options_;
  std::optional<double> t_s_;
  double measured_s_ = 0.0;  ///< when all was measured last, if ever
  std::vector<std::optional<Track>> slots_;
  std::vector<double> left_at_s_;                  ///< per slot, when it became empty
  std::map<std::string, std::size_t> slot_of_id_;  ///< of tracks with an id of their own
  std::size_t named_ = 0;                          ///< tracks without one, so far
};

}  // namespace roadbed::planning::tracking
