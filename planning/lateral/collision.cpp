#include "roadbed/planning/lateral/collision.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/obstacles/static_obstacles.h"

namespace roadbed::planning::inline lateral {
namespace {

using geometry::Rectangle;
using geometry::TrajectoryPoint;
using geometry::VehicleShape;

// Nearer than this beyond the demanded clearance the exact distance is found; farther away a lower
// bound from the circles will do.
constexpr double kNear_m = 0.5;

// What a contact is with: the standing obstacles, the occupied cells, or the mover of an index.
constexpr std::size_t kStanding = 0, kOccupied = 1, kFirstMover = 2;

// Nearer than demanded by this much is too near, whatever the demand was rounded to.
constexpr double kSure_m = 0.01;

// Where the demand is less than the clearance, because the drive begins nearer, so much beyond it
// is enough: it may pass what it begins beside.
constexpr double kEnoughAtStart_m = 0.002;

// The vehicle at one moment of a drive.
struct Moment {
  double t_s = 0.0;
  geometry::Pose2 pose;
  Rectangle body;
  std::vector<Eigen::Vector2d> circle_centres;
};

// One section of a drive, between two of its points.
struct Segment {
  double length_m;  // straight
  double motion_m;  // no point of the body moves farther
  double duration_s;
  double from_m;  // length of the drive before it
};

std::vector<Segment> segments_of(const std::vector<TrajectoryPoint>& drive, double reach_m) {
  std::vector<Segment> segments;
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

// A place on a drive: on a segment, a fraction of it from its start.
struct Place {
  std::size_t segment = 0;
  double fraction = 0.0;
};

struct Mover {
  std::function<geometry::Pose2(double)> centre_at;
  double length_m, width_m;
  double rate_mps;  // no point of its body moves faster until then
  double until_s;   // of the scene; it is not looked at later
};

// Of anything that has a greatest speed between two times. What never moves again is looked at for
// ever, as standing obstacles are.
template <typename Fastest>
Mover mover(std::function<geometry::Pose2(double)> centre_at, double length_m, double width_m,
            const Fastest& fastest_mps, double start_s, double horizon_end_s) {
  const double radius_m = 0.5 * std::hypot(length_m, width_m);
  const double for_ever = std::numeric_limits<double>::infinity();
  const bool stands = fastest_mps(radius_m, start_s, for_ever) == 0.0;
  return {std::move(centre_at), length_m, width_m,
          stands ? 0.0 : fastest_mps(radius_m, start_s, horizon_end_s),
          stands ? for_ever : horizon_end_s};
}

}  // namespace

struct CollisionChecker::Impl {
  Impl(const CollisionScene& of_scene, const geometry::VehicleShape& of_vehicle,
       const CollisionOptions& by_options)
      : scene(of_scene),
        vehicle(of_vehicle),
        options(by_options),
        circles(geometry::covering_circles(vehicle, options.circles)),
        standing(scene.counts ? StaticObstacles(std::vector<Obstacle>{})
                              : StaticObstacles(scene.obstacles)) {
    if (scene.counts) scene.field = nullptr;
    for (const Obstacle& obstacle : scene.obstacles) {
      if (obstacle.is_static() || obstacle.motion.empty()) continue;
      if (!is_counted(obstacle.motion.at(scene.start_t_s).pose())) continue;
      const auto centre_at = [&obstacle](double t_s) { return obstacle.motion.at(t_s).pose(); };
      const auto fastest = [&obstacle](double radius_m, double from_s, double to_s) {
        return fastest_mps(obstacle.motion, radius_m, from_s, to_s);
      };
      movers.push_back(mover(centre_at, obstacle.length_m, obstacle.width_m, fastest,
                             scene.start_t_s, horizon_end_s()));
    }
    for (const PredictedObstacle& obstacle : scene.predicted) {
      const Prediction& prediction = obstacle.motion;
      if (!is_counted(prediction.at(scene.start_t_s))) continue;
      const auto fastest = [&prediction](double radius_m, double from_s, double to_s) {
        return prediction.fastest_mps(radius_m, from_s, to_s);
      };
      movers.push_back(mover([prediction](double t_s) { return prediction.at(t_s); },
                             obstacle.length_m, obstacle.width_m, fastest, scene.start_t_s,
                             horizon_end_s()));
    }
  }

  bool is_counted(const geometry::Pose2& centre) const {
    return !scene.counts || scene.counts(centre);
  }
  double horizon_end_s() const { return scene.start_t_s + options.horizon_s; }
  double demanded_m(std::size_t with, double driven_m) const;
  void begin_at(const TrajectoryPoint& start);
  void look_at(const std::vector<TrajectoryPoint>& drive, Place place, Moment& moment) const;
  void set_moment(double t_s, const geometry::Pose2& pose, Moment& moment) const;

  template <typename Clearance>
  std::optional<Contact> contact(std::size_t with, const std::vector<TrajectoryPoint>& drive,
                                 const std::vector<Segment>& segments, double rate_mps,
                                 double until_s, const Clearance& clearance) const;
  std::optional<Contact> contact_with(std::size_t with, const std::vector<TrajectoryPoint>& drive,
                                      const std::vector<Segment>& segments) const;
  bool is_clear_of_standing(std::size_t with, const Rectangle& cover, double enough_m) const;
  bool is_far_from_occupied(const Rectangle& cover, double enough_m) const;
  Place follow(std::size_t with, const std::vector<Segment>& segments, Place from, double rate_mps,
               double slack_m) const;

  Rectangle nearest(std::size_t with, const Moment& moment) const;
  Rectangle nearest_cell(const Moment& moment) const;
  geometry::Pose2 in_source(const geometry::Pose2& in_map) const;
  double from_standing_m(const Moment& moment, double enough_m) const;
  double from_occupied_m(const Moment& moment, double enough_m) const;
  double from_mover_m(const Moment& moment, const Mover& mover, double enough_m) const;

  CollisionScene scene;
  geometry::VehicleShape vehicle;
  CollisionOptions options;
  geometry::CoveringCircles circles;
  StaticObstacles standing;
  std::vector<Mover> movers;

  // Of the drives that begin there: what is demanded at first, by what it is kept from.
  std::optional<TrajectoryPoint> start;
  std::vector<double> at_start_m;
};

double CollisionChecker::Impl::demanded_m(std::size_t with, double driven_m) const {
  const double fraction = std::min(1.0, driven_m / options.recovery_m);
  return at_start_m[with] + (options.clearance_m - at_start_m[with]) * fraction;
}

// All drives of a planning cycle begin at one place.
void CollisionChecker::Impl::begin_at(const TrajectoryPoint& at) {
  const bool is_same = start && start->t_s == at.t_s &&
                       start->pose().position() == at.pose().position() &&
                       start->heading_rad == at.heading_rad;
  if (is_same) return;
  start = at;
  Moment moment;
  set_moment(at.t_s, at.pose(), moment);
  const double enough_m = options.clearance_m + 2.0 * options.tolerance_m;
  const auto demanded = [&](double distance_m) {
    return std::clamp(distance_m - options.tolerance_m, 0.0, options.clearance_m);
  };
  at_start_m.assign(kFirstMover + movers.size(), options.clearance_m);
  if (!standing.empty()) at_start_m[kStanding] = demanded(from_standing_m(moment, enough_m));
  if (scene.field != nullptr) at_start_m[kOccupied] = demanded(from_occupied_m(moment, enough_m));
  for (std::size_t i = 0; i < movers.size(); ++i) {
    at_start_m[kFirstMover + i] = demanded(from_mover_m(moment, movers[i], enough_m));
  }
}

void CollisionChecker::Impl::look_at(const std::vector<TrajectoryPoint>& drive, Place place,
                                     Moment& moment) const {
  const TrajectoryPoint &a = drive[place.segment], &b = drive[place.segment + 1];
  const auto between = [&](double from, double to) { return from + place.fraction * (to - from); };
  set_moment(between(a.t_s, b.t_s),
             {between(a.x_m, b.x_m), between(a.y_m, b.y_m), between(a.heading_rad, b.heading_rad)},
             moment);
}

void CollisionChecker::Impl::set_moment(double t_s, const geometry::Pose2& pose,
                                        Moment& moment) const {
  moment.t_s = t_s;
  moment.pose = pose;
  moment.body = geometry::body_at(moment.pose, vehicle);
  moment.circle_centres.clear();
  for (const double x_m : circles.centres_x_m) {
    moment.circle_centres.push_back(moment.pose.position() + x_m * moment.body.axis);
  }
}

// As far along the drive as `slack_m` allows, if every metre of motion may cost a metre of it; a
// demand that grows along the drive costs too.
Place CollisionChecker::Impl::follow(std::size_t with, const std::vector<Segment>& segments,
                                     Place from, double rate_mps, double slack_m) const {
  const double demand_slope = (options.clearance_m - at_start_m[with]) / options.recovery_m;
  for (Place place = from; place.segment < segments.size(); place = {place.segment + 1, 0.0}) {
    const Segment& segment = segments[place.segment];
    const double whole_m =
        segment.motion_m + rate_mps * segment.duration_s + demand_slope * segment.length_m;
    const double rest_m = (1.0 - place.fraction) * whole_m;
    if (rest_m > slack_m) return {place.segment, place.fraction + slack_m / whole_m};
    slack_m -= rest_m;
  }
  return {segments.size(), 0.0};
}

// `clearance(moment, enough)` is the distance at a moment, or any lower bound above `enough`.
template <typename Clearance>
std::optional<Contact> CollisionChecker::Impl::contact(std::size_t with,
                                                       const std::vector<TrajectoryPoint>& drive,
                                                       const std::vector<Segment>& segments,
                                                       double rate_mps, double until_s,
                                                       const Clearance& clearance) const {
  Moment moment;
  std::size_t covered = 0;  // segments that were looked at as a whole
  for (Place place; place.segment < segments.size();) {
    look_at(drive, place, moment);
    if (moment.t_s > until_s) return std::nullopt;
    const Segment& segment = segments[place.segment];
    const double demanded = demanded_m(with, segment.from_m + place.fraction * segment.length_m);
    const double slack_m = clearance(moment, demanded + kNear_m) - demanded;
    const double least_m = demanded < options.clearance_m ? kEnoughAtStart_m : options.tolerance_m;
    if (!(slack_m >= least_m)) return Contact{place.segment, with, nearest(with, moment)};
    const Place next = follow(with, segments, place, rate_mps, slack_m);
    const bool is_slow = next.segment == place.segment && place.segment >= covered;
    covered = std::max(covered, place.segment + 1);
    // Beside a wall every step is short, and the whole segment mostly clear.
    const bool is_clear =
        is_slow && is_clear_of_standing(
                       with, cover_of(drive[place.segment], drive[place.segment + 1], vehicle),
                       demanded_m(with, segment.from_m + segment.length_m));
    place = is_clear ? Place{place.segment + 1, 0.0} : next;
  }
  return std::nullopt;
}

bool CollisionChecker::Impl::is_clear_of_standing(std::size_t with, const Rectangle& cover,
                                                  double enough_m) const {
  if (with == kStanding) return standing.distance_m(cover) >= enough_m;
  if (with != kOccupied) return false;
  VehicleShape shape = vehicle;
  shape.length_m = 2.0 * cover.half_length_m;
  shape.width_m = 2.0 * cover.half_width_m;
  shape.rear_overhang_m = cover.half_length_m;
  const geometry::Pose2 centre{cover.centre.x(), cover.centre.y(),
                               std::atan2(cover.axis.y(), cover.axis.x())};
  return !scene.field->nearest(in_source(centre), shape, enough_m);
}

// By circles along the cover that stick out of it by an eighth of its half width.
bool CollisionChecker::Impl::is_far_from_occupied(const Rectangle& cover, double enough_m) const {
  const int count = static_cast<int>(std::ceil(2.0 * cover.half_length_m / cover.half_width_m));
  const double part_m = cover.half_length_m / count;
  const double radius_m = std::hypot(part_m, cover.half_width_m);
  for (int i = 0; i < count; ++i) {
    const double along_m = (2 * i + 1 - count) * part_m;
    const Eigen::Vector2d centre = cover.centre + along_m * cover.axis + scene.origin_in_source;
    if (scene.field->distance_bound_m(centre) - radius_m <= enough_m) return false;
  }
  return true;
}

double CollisionChecker::Impl::from_standing_m(const Moment& moment, double enough_m) const {
  double bound_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& centre : moment.circle_centres) {
    bound_m = std::min(bound_m, standing.distance_bound_m(centre) - circles.radius_m);
  }
  return bound_m > enough_m ? bound_m : standing.distance_m(moment.body);
}

double CollisionChecker::Impl::from_occupied_m(const Moment& moment, double enough_m) const {
  double bound_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& centre : moment.circle_centres) {
    const Eigen::Vector2d in_source = centre + scene.origin_in_source;
    bound_m = std::min(bound_m, scene.field->distance_bound_m(in_source) - circles.radius_m);
  }
  if (bound_m > enough_m) return bound_m;
  const auto found = scene.field->nearest(in_source(moment.pose), vehicle, enough_m);
  return found ? found->distance_m : enough_m;
}

geometry::Pose2 CollisionChecker::Impl::in_source(const geometry::Pose2& in_map) const {
  return {in_map.x_m + scene.origin_in_source.x(), in_map.y_m + scene.origin_in_source.y(),
          in_map.heading_rad};
}

// The standing body or the occupied cell that is nearest at a moment of contact.
Rectangle CollisionChecker::Impl::nearest(std::size_t with, const Moment& moment) const {
  if (with == kStanding) return standing.nearest(moment.body);
  return with == kOccupied ? nearest_cell(moment) : Rectangle{};
}

Rectangle CollisionChecker::Impl::nearest_cell(const Moment& moment) const {
  const auto found =
      scene.field->nearest(in_source(moment.pose), vehicle, options.clearance_m + kNear_m);
  const map::Box2& box = found->witness;
  const Eigen::Vector2d size = box.max_in_source - box.min_in_source;
  return {0.5 * (box.min_in_source + box.max_in_source) - scene.origin_in_source,
          {1.0, 0.0},
          0.5 * size.x(),
          0.5 * size.y()};
}

double CollisionChecker::Impl::from_mover_m(const Moment& moment, const Mover& mover,
                                            double enough_m) const {
  const Rectangle other = body_around(mover.centre_at(moment.t_s), mover.length_m, mover.width_m);
  double bound_m = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& centre : moment.circle_centres) {
    bound_m = std::min(bound_m, geometry::distance_m(other, centre) - circles.radius_m);
  }
  return bound_m > enough_m ? bound_m : geometry::distance_m(moment.body, other);
}

CollisionChecker::CollisionChecker(const CollisionScene& scene,
                                   const geometry::VehicleShape& vehicle,
                                   const CollisionOptions& options)
    : impl_(std::make_unique<Impl>(scene, vehicle, options)) {}

CollisionChecker::~CollisionChecker() = default;
CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker& CollisionChecker::operator=(CollisionChecker&&) noexcept = default;

std::optional<Contact> CollisionChecker::first_contact(
    const std::vector<TrajectoryPoint>& drive) const {
  return first_contact(drive, things());
}

std::optional<Contact> CollisionChecker::first_contact(const std::vector<TrajectoryPoint>& drive,
                                                       std::span<const std::size_t> things) const {
  if (drive.empty()) return std::nullopt;
  impl_->begin_at(drive.front());
  const std::vector<Segment> segments = segments_of(drive, impl_->vehicle.reach_m());
  std::optional<Contact> found;
  for (std::size_t i = 0; !found && i < things.size(); ++i) {
    found = impl_->contact_with(things[i], drive, segments);
  }
  return found;
}

std::optional<Contact> CollisionChecker::Impl::contact_with(
    std::size_t with, const std::vector<TrajectoryPoint>& drive,
    const std::vector<Segment>& segments) const {
  const double for_ever = std::numeric_limits<double>::infinity();
  if (with == kStanding) {
    return contact(with, drive, segments, 0.0, for_ever, [&](const Moment& at, double enough_m) {
      return from_standing_m(at, enough_m);
    });
  }
  if (with == kOccupied) {
    return contact(with, drive, segments, 0.0, for_ever, [&](const Moment& at, double enough_m) {
      return from_occupied_m(at, enough_m);
    });
  }
  const Mover& mover = movers[with - kFirstMover];
  return contact(
      with, drive, segments, mover.rate_mps, mover.until_s,
      [&](const Moment& at, double enough_m) { return from_mover_m(at, mover, enough_m); });
}

double CollisionChecker::distance_m(const Contact& other, const Rectangle& body, double t_s) const {
  if (other.with < kFirstMover) return geometry::distance_m(body, other.standing);
  const Mover& mover = impl_->movers[other.with - kFirstMover];
  if (t_s > mover.until_s) return std::numeric_limits<double>::infinity();
  return geometry::distance_m(body,
                              body_around(mover.centre_at(t_s), mover.length_m, mover.width_m));
}

bool CollisionChecker::surely_hits(const Contact& other, const Rectangle& body, double t_s,
                                   double driven_m) const {
  return distance_m(other, body, t_s) < impl_->demanded_m(other.with, driven_m) - kSure_m;
}

bool CollisionChecker::is_empty() const {
  return impl_->standing.empty() && impl_->scene.field == nullptr && impl_->movers.empty();
}

std::vector<std::size_t> CollisionChecker::things() const {
  std::vector<std::size_t> things;
  if (!impl_->standing.empty()) things.push_back(kStanding);
  if (impl_->scene.field != nullptr) things.push_back(kOccupied);
  for (std::size_t i = 0; i < impl_->movers.size(); ++i) things.push_back(kFirstMover + i);
  return things;
}

bool CollisionChecker::keeps_clear(std::size_t with, const Rectangle& cover, double from_t_s,
                                   double to_t_s) const {
  const double enough_m = impl_->options.clearance_m + impl_->options.tolerance_m + kSure_m;
  if (with == kStanding) return impl_->standing.distance_m(cover) > enough_m;
  if (with == kOccupied) return impl_->is_far_from_occupied(cover, enough_m);
  const Mover& mover = impl_->movers[with - kFirstMover];
  const double to_s = std::min(to_t_s, mover.until_s);
  double t_s = from_t_s;
  while (t_s <= to_s) {
    const double slack_m = geometry::distance_m(cover, body_around(mover.centre_at(t_s),
                                                                   mover.length_m, mover.width_m)) -
                           enough_m;
    if (slack_m < kSure_m) return false;
    if (mover.rate_mps == 0.0) return true;
    t_s += slack_m / mover.rate_mps;
  }
  return true;
}

void CollisionChecker::set_clearance(double clearance_m) {
  impl_->options.clearance_m = clearance_m;
  impl_->start.reset();
}

}  // namespace roadbed::planning::lateral
