#include "roadbed/map/occupancy/clouds/sweep_poses.h"

#include <cmath>
#include <utility>

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

constexpr double kKnot_ns = 1e6;
constexpr std::size_t kKnots =
    2 * static_cast<std::size_t>(SweepPoses::kFarthest_ns / kKnot_ns) + 2;

}  // namespace

SweepPoses::SweepPoses(PoseAt pose_at, std::int64_t stamp_ns)
    : pose_at_(std::move(pose_at)), stamp_ns_(stamp_ns), at_stamp_(known_at(stamp_ns)) {}

std::optional<SweepPoses::Placing> SweepPoses::known_at(std::int64_t stamp_ns) const {
  const std::optional<Eigen::Isometry3d> pose = pose_at_(stamp_ns);
  if (!pose) return std::nullopt;
  return Placing(pose->matrix().topRows<3>());
}

const std::optional<SweepPoses::Placing>& SweepPoses::at_knot(std::size_t i) {
  if (knots_.empty()) knots_.resize(kKnots);
  if (!knots_[i]) {
    const double since_ns = kKnot_ns * static_cast<double>(i) - kFarthest_ns;
    knots_[i] = known_at(stamp_ns_ + static_cast<std::int64_t>(since_ns));
  }
  return *knots_[i];
}

std::optional<SweepPoses::Placing> SweepPoses::at(double since_stamp_ns) {
  const double knots = (since_stamp_ns + kFarthest_ns) / kKnot_ns;
  const auto i = static_cast<std::size_t>(knots);
  const auto& from = at_knot(i);
  const auto& to = at_knot(i + 1);
  // At the ends of what is known no knot may be near.
  if (!from || !to) return known_at(stamp_ns_ + std::llround(since_stamp_ns));
  return Placing(*from + (knots - static_cast<double>(i)) * (*to - *from));
}

}  // namespace roadbed::map::occupancy::clouds
