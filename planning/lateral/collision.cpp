#include "roadbed/planning/lateral/collision.h"

#include <limits>

#include "roadbed/planning/lateral/drive_sweep.h"

namespace roadbed::planning::inline lateral {
namespace {

using geometry::Rectangle;
using geometry::TrajectoryPoint;

constexpr double kSure_m = 0.01;  // kept beyond what is demanded by what is said to be clear
// Of a point of a drive that is known otherwise, see surely_hits().
constexpr double kSameWay_m = 0.01, kRounding_m = 1e-9;

}  // namespace

CollisionChecker::CollisionChecker(const CollisionScene& scene,
                                   const geometry::VehicleShape& vehicle,
                                   const CollisionOptions& options)
    : things_(std::make_unique<CollisionThings>(scene, vehicle, options)) {}

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
  things_->begin_at(drive.front());
  const std::vector<DriveSegment> segments = segments_of(drive, things_->vehicle().reach_m());
  std::optional<Contact> found;
  for (std::size_t i = 0; !found && i < things.size(); ++i) {
    found = lateral::first_contact(*things_, things[i], drive, segments);
  }
  return found;
}

double CollisionChecker::distance_m(const Contact& other, const Rectangle& body, double t_s) const {
  if (other.with < CollisionThings::kFirstMover) return geometry::distance_m(body, other.standing);
  const Mover& mover = things_->mover(other.with);
  if (t_s > mover.until_s) return std::numeric_limits<double>::infinity();
  return geometry::distance_m(body, mover.body_at(t_s));
}

int CollisionChecker::parts(const Contact& other) {
  return other.with < CollisionThings::kFirstMover ? 1 : kSweepParts;
}

bool CollisionChecker::surely_hits(const Contact& other, const Rectangle& body, double t_s,
                                   double driven_m) const {
  const double demanded = things_->demanded_m(other.with, driven_m - kSameWay_m);
  return distance_m(other, body, t_s) < demanded + things_->enough_beyond_m(demanded) - kRounding_m;
}

bool CollisionChecker::is_empty() const { return things().empty(); }

std::vector<std::size_t> CollisionChecker::things() const { return things_->numbers(); }

bool CollisionChecker::keeps_clear(std::size_t with, const Rectangle& cover, double from_t_s,
                                   double to_t_s) const {
  const CollisionOptions& options = things_->options();
  return things_->is_far(with, cover, from_t_s, to_t_s,
                         options.clearance_m + options.tolerance_m + kSure_m);
}

void CollisionChecker::set_clearance(double clearance_m) { things_->set_clearance(clearance_m); }

}  // namespace roadbed::planning::lateral
