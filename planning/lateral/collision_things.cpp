#include "roadbed/planning/lateral/collision_things.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbed::planning::inline lateral {
namespace {

using geometry::Rectangle;
using geometry::TrajectoryPoint;
using geometry::VehicleShape;

constexpr double kNearCell_m =
    0.5;  // beyond the clearance: a cell that is touched is looked for there
constexpr double kLeastStep_m = 0.01;

// Where the demand is less than the clearance, because the drive begins nearer, so much beyond it
// is enough: it may pass what it begins beside.
constexpr double kEnoughAtStart_m = 0.002;

constexpr double kForEver_s = std::numeric_limits<double>::infinity();

// Of anything that has a greatest speed between two times. What never moves again is looked at for
// ever, as standing obstacles are.
template <typename Fastest>
void set_rate(const Fastest& fastest_mps, double start_s, double horizon_end_s, Mover& mover) {
  const double radius_m = 0.5 * std::hypot(mover.length_m, mover.width_m);
  const bool stands = fastest_mps(radius_m, start_s, kForEver_s) == 0.0;
  mover.rate_mps = stands ? 0.0 : fastest_mps(radius_m, start_s, horizon_end_s);
  mover.until_s = stands ? kForEver_s : horizon_end_s;
}

}  // namespace

Rectangle Mover::body_at(double t_s) const {
  return body_around(centre_at(t_s), length_m, width_m);
}

CollisionThings::CollisionThings(const CollisionScene& scene, const VehicleShape& vehicle,
                                 const CollisionOptions& options)
    : scene_(scene),
      vehicle_(vehicle),
      options_(options),
      circles_(geometry::covering_circles(vehicle, options.circles)),
      standing_(scene.counts ? StaticObstacles(std::vector<Obstacle>{})
                             : StaticObstacles(scene.obstacles)) {
  if (scene.counts) scene_.field = nullptr;
  for (const Obstacle& obstacle : scene.obstacles) {
    if (obstacle.is_static() || obstacle.motion.empty()) continue;
    if (is_counted(obstacle.motion.at(scene.start_t_s).pose())) add(obstacle);
  }
  for (const PredictedObstacle& obstacle : scene.predicted) {
    if (is_counted(obstacle.motion.at(scene.start_t_s))) add(obstacle);
  }
}

void CollisionThings::add(const Obstacle& obstacle) {
  const double radius_m = 0.5 * std::hypot(obstacle.length_m, obstacle.width_m);
  const geometry::Trajectory& motion = obstacle.motion;
  Mover& mover = movers_.emplace_back(
      Mover{.centre_at = [&motion](double t_s) { return motion.at(t_s).pose(); },
            .bend_m = [&motion, radius_m](
                          double from_s,
                          double to_s) { return planning::bend_m(motion, radius_m, from_s, to_s); },
            .length_m = obstacle.length_m,
            .width_m = obstacle.width_m,
            .rate_mps = 0.0,
            .until_s = kForEver_s});
  const auto fastest = [&motion](double within_m, double from_s, double to_s) {
    return fastest_mps(motion, within_m, from_s, to_s);
  };
  set_rate(fastest, scene_.start_t_s, horizon_end_s(), mover);
}

void CollisionThings::add(const PredictedObstacle& obstacle) {
  const Prediction& prediction = obstacle.motion;
  Mover& mover = movers_.emplace_back(
      Mover{.centre_at = [prediction](double t_s) { return prediction.at(t_s); },
            .bend_m = [](double, double) { return kForEver_s; },
            .length_m = obstacle.length_m,
            .width_m = obstacle.width_m,
            .rate_mps = 0.0,
            .until_s = kForEver_s});
  const auto fastest = [&prediction](double within_m, double from_s, double to_s) {
    return prediction.fastest_mps(within_m, from_s, to_s);
  };
  set_rate(fastest, scene_.start_t_s, horizon_end_s(), mover);
}

void CollisionThings::set_clearance(double clearance_m) {
  options_.clearance_m = clearance_m;
  start_.reset();
}

std::vector<std::size_t> CollisionThings::numbers() const {
  std::vector<std::size_t> numbers;
  if (!standing_.empty()) numbers.push_back(kStanding);
  if (scene_.field != nullptr) numbers.push_back(kOccupied);
  for (std::size_t i = 0; i < movers_.size(); ++i) numbers.push_back(kFirstMover + i);
  return numbers;
}

double CollisionThings::enough_beyond_m(double demanded_m) const {
  return demanded_m < options_.clearance_m ? kEnoughAtStart_m : options_.tolerance_m;
}

double CollisionThings::demanded_m(std::size_t with, double driven_m) const {
  const double fraction = std::min(1.0, driven_m / options_.recovery_m);
  return at_start_m_[with] + (options_.clearance_m - at_start_m_[with]) * fraction;
}

// All drives of a planning cycle begin at one place.
void CollisionThings::begin_at(const TrajectoryPoint& at) {
  const bool is_same = start_ && start_->t_s == at.t_s &&
                       start_->pose().position() == at.pose().position() &&
                       start_->heading_rad == at.heading_rad;
  if (is_same) return;
  start_ = at;
  const DriveMoment moment(at.t_s, at.pose(), vehicle_);
  const double enough_m = options_.clearance_m + 2.0 * options_.tolerance_m;
  at_start_m_.assign(kFirstMover + movers_.size(), options_.clearance_m);
  for (const std::size_t with : numbers()) {
    at_start_m_[with] = std::clamp(distance_m(with, moment, enough_m) - options_.tolerance_m, 0.0,
                                   options_.clearance_m);
  }
}

double CollisionThings::distance_m(std::size_t with, const DriveMoment& moment,
                                   double enough_m) const {
  if (with == kStanding) return from_standing_m(moment, enough_m);
  if (with == kOccupied) return from_occupied_m(moment, enough_m);
  return distance_m(mover(with).body_at(moment.t_s), moment, enough_m);
}

bool CollisionThings::is_clear(std::size_t with, const Rectangle& cover, double enough_m) const {
  if (with == kStanding) return standing_.distance_m(cover) >= enough_m;
  if (with != kOccupied) return false;
  VehicleShape shape = vehicle_;
  shape.length_m = 2.0 * cover.half_length_m;
  shape.width_m = 2.0 * cover.half_width_m;
  shape.rear_overhang_m = cover.half_length_m;
  const geometry::Pose2 centre{cover.centre.x(), cover.centre.y(),
                               std::atan2(cover.axis.y(), cover.axis.x())};
  return !scene_.field->nearest(in_source(centre), shape, enough_m);
}

// By circles along the cover that stick out of it by an eighth of its half width.
bool CollisionThings::is_far_from_occupied(const Rectangle& cover, double enough_m) const {
  const int count = static_cast<int>(std::ceil(2.0 * cover.half_length_m / cover.half_width_m));
  const double part_m = cover.half_length_m / count;
  const double radius_m = std::hypot(part_m, cover.half_width_m);
  for (int i = 0; i < count; ++i) {
    const double along_m = (2 * i + 1 - count) * part_m;
    const Eigen::Vector2d centre = cover.centre + along_m * cover.axis + scene_.origin_in_source;
    if (scene_.field->distance_bound_m(centre) - radius_m <= enough_m) return false;
  }
  return true;
}

double CollisionThings::from_standing_m(const DriveMoment& moment, double enough_m) const {
  double bound_m = std::numeric_limits<double>::infinity();
  for (const double x_m : circles_.centres_x_m) {
    bound_m =
        std::min(bound_m, standing_.distance_bound_m(moment.on_axis(x_m)) - circles_.radius_m);
  }
  return bound_m > enough_m ? bound_m : standing_.distance_m(moment.body);
}

double CollisionThings::from_occupied_m(const DriveMoment& moment, double enough_m) const {
  double bound_m = std::numeric_limits<double>::infinity();
  for (const double x_m : circles_.centres_x_m) {
    const Eigen::Vector2d in_source = moment.on_axis(x_m) + scene_.origin_in_source;
    bound_m = std::min(bound_m, scene_.field->distance_bound_m(in_source) - circles_.radius_m);
  }
  if (bound_m > enough_m) return bound_m;
  const auto found = scene_.field->nearest(in_source(moment.pose), vehicle_, enough_m);
  return found ? found->distance_m : enough_m;
}

geometry::Pose2 CollisionThings::in_source(const geometry::Pose2& in_map) const {
  return {in_map.x_m + scene_.origin_in_source.x(), in_map.y_m + scene_.origin_in_source.y(),
          in_map.heading_rad};
}

// The standing body or the occupied cell that is nearest at a moment of contact.
Rectangle CollisionThings::nearest(std::size_t with, const DriveMoment& moment) const {
  if (with == kStanding) return standing_.nearest(moment.body);
  return with == kOccupied ? nearest_cell(moment) : Rectangle{};
}

Rectangle CollisionThings::nearest_cell(const DriveMoment& moment) const {
  const auto found =
      scene_.field->nearest(in_source(moment.pose), vehicle_, options_.clearance_m + kNearCell_m);
  const map::Box2& box = found->witness;
  const Eigen::Vector2d size = box.max_in_source - box.min_in_source;
  return {0.5 * (box.min_in_source + box.max_in_source) - scene_.origin_in_source,
          {1.0, 0.0},
          0.5 * size.x(),
          0.5 * size.y()};
}

double CollisionThings::distance_m(const Rectangle& other, const DriveMoment& moment,
                                   double enough_m) const {
  double bound_m = std::numeric_limits<double>::infinity();
  for (const double x_m : circles_.centres_x_m) {
    bound_m =
        std::min(bound_m, geometry::distance_m(other, moment.on_axis(x_m)) - circles_.radius_m);
  }
  return bound_m > enough_m ? bound_m : geometry::distance_m(moment.body, other);
}

bool CollisionThings::is_far(std::size_t with, const Rectangle& cover, double from_t_s,
                             double to_t_s, double enough_m) const {
  if (with == kStanding) return standing_.distance_m(cover) > enough_m;
  if (with == kOccupied) return is_far_from_occupied(cover, enough_m);
  const Mover& other = mover(with);
  const double reach_m =
      cover.radius_m() + 0.5 * std::hypot(other.length_m, other.width_m) + enough_m;
  const double to_s = std::min(to_t_s, other.until_s);
  double t_s = from_t_s;
  while (t_s <= to_s) {
    const geometry::Pose2 centre = other.centre_at(t_s);
    double slack_m = (centre.position() - cover.centre).norm() - reach_m;
    if (slack_m < reach_m) {
      const Rectangle body = body_around(centre, other.length_m, other.width_m);
      slack_m = geometry::distance_m(cover, body) - enough_m;
    }
    if (slack_m < kLeastStep_m) return false;
    if (other.rate_mps == 0.0) return true;
    t_s += slack_m / other.rate_mps;
  }
  return true;
}

}  // namespace roadbed::planning::lateral
