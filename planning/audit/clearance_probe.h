#pragma once

// Private to planning/audit.

#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"

namespace roadbed::planning::inline audit {

/// A bound over what is asked by this is over, whatever the rounding.
inline constexpr double kOver_m = 1e-9;

/// A part of one segment of a drive, between two of its samples: `from`, `to` in 0 … 1. Or several
/// whole segments, one after the other, whose middle is a sample.
struct Span {
  std::size_t segment = 0;
  double from = 0.0, to = 1.0;
  std::size_t segments = 1;

  std::size_t middle_segment() const { return segment + segments / 2; }
  double middle() const { return segments == 1 ? 0.5 * (from + to) : 0.0; }  ///< in that segment

  Span first_half() const {
    return segments == 1 ? Span{segment, from, middle()} : Span{segment, 0.0, 1.0, segments / 2};
  }
  Span second_half() const {
    if (segments == 1) return {segment, middle(), to};
    return {middle_segment(), 0.0, 1.0, segments - segments / 2};
  }
};

/// What the audit asks of the things around a drive: how far the body is from them in the middle of
/// a span, and how much that may change within it.
class ClearanceProbe {
 public:
  /// O(samples).
  ClearanceProbe(const geometry::Trajectory& drive, double reach_m);
  virtual ~ClearanceProbe() = default;
  ClearanceProbe(const ClearanceProbe&) = delete;
  ClearanceProbe& operator=(const ClearanceProbe&) = delete;

  std::size_t segments() const;  ///< at least one: a single sample is a segment without motion
  geometry::TrajectoryPoint state_at(std::size_t segment, double fraction) const;
  geometry::TrajectoryPoint middle_of(const Span& span) const {
    return state_at(span.middle_segment(), span.middle());
  }
  double time_at(std::size_t segment, double fraction) const;
  geometry::TrajectoryPoint state_at_time(double t_s) const { return drive_.at(t_s); }

  /// Of each sample, and its last one once more if that is the only one: no point of the body moves
  /// farther up to there [m], but for rounding.
  const std::vector<double>& moved_m() const { return moved_m_; }

  struct Place {
    std::size_t segment;
    double fraction;
  };
  /// Where the body has moved so far, by `moved_m`. O(log samples).
  Place place_moved(double moved_m) const;

  /// The inverse. O(log samples).
  double moved_at_m(double t_s) const;

  /// The first segment after `segment` that is not settled with it: where the distance is nowhere
  /// in `segment` within `spare_m` of what counts, it needs that much of motion to come there.
  /// O(log samples).
  std::size_t next_after(std::size_t segment, double spare_m) const;

  /// The distance changes by no more than this between the span's middle and any other time of it.
  /// Here that of things at rest: the way of the axle plus the turn times the body's reach, to the
  /// end that is farther from the middle, and rounding. O(1).
  virtual double motion_bound_m(const Span& span) const;

  /// Lower bound of the distance in the middle of a span; at most the horizon. A bound of
  /// `enough_m` or more need not be the best that is known.
  virtual double lower_bound_m(const Span& span, double enough_m) const = 0;

  struct Near {
    double distance_m;
    map::Box2 witness;          ///< box around the nearest thing
    std::string obstacle = {};  ///< its id, if it is one that moves
  };
  /// Exact distance in the middle of a span; none if it is over `within_m` or the horizon.
  virtual std::optional<Near> nearest(const Span& span, double within_m) const = 0;

  /// Lower bound of the distance at all times of a span, from all that the body sweeps over in it;
  /// at most `within_m`. 0 where nothing is known of that.
  virtual double swept_bound_m(const Span& /*span*/, double /*within_m*/) const { return 0.0; }

  virtual double horizon_m() const = 0;

  /// Whether distances at the end of a segment are those at the start of the next one, and change
  /// by the body's own motion only. If not, spans of several segments must not be asked about.
  virtual bool is_continuous() const = 0;

 protected:
  const geometry::Trajectory& drive() const { return drive_; }
  static constexpr double kRounding_m = 1e-8;  // of coordinates up to 10,000 km

  geometry::Pose2 pose_at(std::size_t segment, double fraction) const;
  geometry::Pose2 middle_pose_of(const Span& span) const {
    return pose_at(span.middle_segment(), span.middle());
  }
  /// A rectangle, turned as the body is in the middle of a span, that a part of it (without its
  /// radius) stays in all along. O(segments).
  geometry::Rectangle swept_over(const Span& span, const geometry::BodyPart& part) const;

 private:
  double segment_motion_m(std::size_t segment) const;

  const geometry::Trajectory& drive_;
  double reach_m_;
  std::vector<double> moved_m_;
  double sum_rounding_m_;  // of any difference of these sums
};

}  // namespace roadbed::planning::audit
