#include "roadbed/planning/lateral/drive_sweep.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace roadbed::planning::inline lateral {
namespace {

using geometry::Rectangle;
using geometry::TrajectoryPoint;
using geometry::VehicleShape;

// Nearer than this beyond the demanded clearance the exact distance is found; farther away a lower
// bound from the circles will do.
constexpr double kNear_m = 0.5;

// A rectangle that holds the body all along a segment: in the frame of the middle heading the
// corners move from one end to the other on lines that bend by no more than reach · Δθ² / 8.
Rectangle cover_of(const TrajectoryPoint& a, const TrajectoryPoint& b,
                   const VehicleShape& vehicle) {
  const double turn_rad = b.heading_rad - a.heading_rad;
  const double heading_rad = a.heading_rad + 0.5 * turn_rad;
  const Eigen::Vector2d axis(std::cos(heading_rad), std::sin(heading_rad)),
      left(-axis.y(), axis.x());
  Eigen::AlignedBox2d box;
  for (const TrajectoryPoint* end : {&a, &b}) {
    for (const Eigen::Vector2d& corner : geometry::body_at(end->pose(), vehicle).corners()) {
      box.extend(Eigen::Vector2d(axis.dot(corner), left.dot(corner)));
    }
  }
  const double bend_m = 0.125 * vehicle.reach_m() * turn_rad * turn_rad;
  const Eigen::Vector2d centre = box.center(), size = box.sizes();
  return {centre.x() * axis + centre.y() * left, axis, 0.5 * size.x() + bend_m,
          0.5 * size.y() + bend_m};
}

// The strip across a direction that parts two rectangles, the second one ahead; negative: none
// does.
double gap_along_m(const Eigen::Vector2d& direction, const Rectangle& behind,
                   const Rectangle& ahead) {
  double least_m = std::numeric_limits<double>::infinity(), most_m = -least_m;
  for (const Eigen::Vector2d& corner : behind.corners()) {
    most_m = std::max(most_m, direction.dot(corner));
  }
  for (const Eigen::Vector2d& corner : ahead.corners()) {
    least_m = std::min(least_m, direction.dot(corner));
  }
  return least_m - most_m;
}

// A place on a drive: on a segment, a fraction of it from its start.
struct Place {
  std::size_t segment = 0;
  double fraction = 0.0;
};

// What was seen from a place on a drive.
struct Look {
  Place place;
  DriveMoment moment;
  Rectangle other;  // then, if it moves
  double demanded_m, slack_m;
  bool counts;  // it is not past the horizon
};

class Sweep {
 public:
  Sweep(const CollisionThings& things, std::size_t with, const std::vector<TrajectoryPoint>& drive,
        const std::vector<DriveSegment>& segments)
      : things_(things),
        with_(with),
        mover_(with < CollisionThings::kFirstMover ? nullptr : &things.mover(with)),
        drive_(drive),
        segments_(segments) {}

  std::optional<Contact> first_contact() const {
    if (segments_.empty()) return std::nullopt;
    Look from = look({0, 0.0});
    if (is_too_near(from)) return contact_at(from);
    while (from.counts) {
      const Ahead ahead = follow(from);
      if (ahead.segment == segments_.size()) break;
      Look to = look({ahead.segment, 1.0});
      if (!is_clear_before(to, ahead)) {
        const Look begin = ahead.segment == from.place.segment ? from : look({ahead.segment, 0.0});
        if (const auto near = too_near_between(begin, to)) return contact_at(*near);
      }
      if (is_too_near(to)) return contact_at(to);
      to.place = {ahead.segment + 1, 0.0};
      from = to;
    }
    return std::nullopt;
  }

 private:
  // The first segment that may not be clear, and a lower bound of the slack at its start.
  struct Ahead {
    std::size_t segment;
    double slack_m;
  };

  double tolerance_m() const { return things_.options().tolerance_m; }

  // Every metre of motion may cost a metre of slack; a demand that grows along the drive costs too.
  double cost_m(std::size_t segment) const {
    const DriveSegment& of = segments_[segment];
    const double rate_mps = mover_ ? mover_->rate_mps : 0.0;
    return of.motion_m + rate_mps * of.duration_s + things_.demand_slope(with_) * of.length_m;
  }

  Look look(const Place& place) const {
    const TrajectoryPoint &a = drive_[place.segment], &b = drive_[place.segment + 1];
    const auto between = [&](double from, double to) {
      return from + place.fraction * (to - from);
    };
    const DriveSegment& segment = segments_[place.segment];
    Look look{
        .place = place,
        .moment = DriveMoment(
            between(a.t_s, b.t_s),
            {between(a.x_m, b.x_m), between(a.y_m, b.y_m), between(a.heading_rad, b.heading_rad)},
            things_.vehicle()),
        .other = {},
        .demanded_m = things_.demanded_m(with_, segment.from_m + place.fraction * segment.length_m),
        .slack_m = 0.0,
        .counts = !mover_ || between(a.t_s, b.t_s) <= mover_->until_s};
    if (mover_) look.other = mover_->body_at(look.moment.t_s);
    look.slack_m = distance_m(look, look.demanded_m + kNear_m) - look.demanded_m;
    return look;
  }

  double distance_m(const Look& look, double enough_m) const {
    return mover_ ? things_.distance_m(look.other, look.moment, enough_m)
                  : things_.distance_m(with_, look.moment, enough_m);
  }

  bool is_too_near(const Look& look) const {
    return look.counts && !(look.slack_m >= things_.enough_beyond_m(look.demanded_m));
  }

  Contact contact_at(const Look& look) const {
    return {look.place.segment, look.place.fraction, with_, things_.nearest(with_, look.moment)};
  }

  Ahead follow(const Look& from) const {
    Ahead ahead{from.place.segment, from.slack_m};
    for (; ahead.segment < segments_.size(); ++ahead.segment) {
      const double after_m = ahead.slack_m - cost_m(ahead.segment);
      if (after_m < tolerance_m()) break;
      ahead.slack_m = after_m;
    }
    return ahead;
  }

  // All along the segment that ends there.
  bool is_clear_before(const Look& to, const Ahead& ahead) const {
    if (!to.counts) return false;
    if (0.5 * (ahead.slack_m + to.slack_m - cost_m(ahead.segment)) >= tolerance_m()) return true;
    if (mover_) return false;
    const Rectangle cover =
        cover_of(drive_[ahead.segment], drive_[ahead.segment + 1], things_.vehicle());
    return things_.is_clear(with_, cover, to.demanded_m);
  }

  // At eighths of a segment nothing is missed that is too near; between these, what is found clear
  // keeps what is demanded.
  std::optional<Look> too_near_between(const Look& a, const Look& b) const {
    const double part = b.place.fraction - a.place.fraction;
    if (least_slack_m(a, b) >= (part * kSweepParts > 1.0 ? tolerance_m() : 0.0))
      return std::nullopt;
    const Look middle = look({b.place.segment, a.place.fraction + 0.5 * part});
    if (is_too_near(middle)) return middle;
    if (const auto before = too_near_between(a, middle)) return before;
    return middle.counts ? too_near_between(middle, b) : std::nullopt;
  }

  // A lower bound from one look to the other.
  double least_slack_m(const Look& a, const Look& b) const {
    const double part = b.place.fraction - a.place.fraction;
    const double cost = part * cost_m(b.place.segment);
    if (!b.counts) return a.slack_m - cost;
    const double by_motion_m = 0.5 * (a.slack_m + b.slack_m - cost);
    return mover_ ? std::max(by_motion_m, gap_m(a, b) - b.demanded_m) : by_motion_m;
  }

  // How far apart body and mover are all the time from one look to the other: as far as along some
  // direction at both, but for how much corners move off the straight lines between.
  double gap_m(const Look& a, const Look& b) const {
    double gap_m = -std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& axis : {a.moment.body.axis, a.other.axis}) {
      const Eigen::Vector2d left(-axis.y(), axis.x());
      for (const Eigen::Vector2d& to :
           {axis, Eigen::Vector2d(-axis), left, Eigen::Vector2d(-left)}) {
        gap_m = std::max(gap_m, std::min(gap_along_m(to, a.moment.body, a.other),
                                         gap_along_m(to, b.moment.body, b.other)));
      }
    }
    const double turn_rad = b.moment.pose.heading_rad - a.moment.pose.heading_rad;
    return gap_m - 0.125 * things_.vehicle().reach_m() * turn_rad * turn_rad -
           mover_->bend_m(a.moment.t_s, b.moment.t_s);
  }

  const CollisionThings& things_;
  std::size_t with_;
  const Mover* mover_;  // none: it stands
  const std::vector<TrajectoryPoint>& drive_;
  const std::vector<DriveSegment>& segments_;
};

}  // namespace

std::vector<DriveSegment> segments_of(const std::vector<TrajectoryPoint>& drive, double reach_m) {
  std::vector<DriveSegment> segments;
  segments.reserve(drive.size());
  double from_m = 0.0;
  for (std::size_t i = 0; i + 1 < drive.size(); ++i) {
    const TrajectoryPoint &a = drive[i], &b = drive[i + 1];
    const double length_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    segments.push_back({length_m, length_m + reach_m * std::abs(b.heading_rad - a.heading_rad),
                        b.t_s - a.t_s, from_m});
    from_m += length_m;
  }
  return segments;
}

std::optional<Contact> first_contact(const CollisionThings& things, std::size_t with,
                                     const std::vector<TrajectoryPoint>& drive,
                                     const std::vector<DriveSegment>& segments) {
  return Sweep(things, with, drive, segments).first_contact();
}

}  // namespace roadbed::planning::lateral
