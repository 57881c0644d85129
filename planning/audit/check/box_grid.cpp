#include "roadbed/planning/audit/check/box_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace roadbed::planning::inline audit {
namespace {

// Between boxes with sides along x and y.
double squared_gap_m2(const map::Box2& a, const map::Box2& b) {
  const Eigen::Array2d apart = (a.min_in_source - b.max_in_source)
                                   .array()
                                   .max((b.min_in_source - a.max_in_source).array())
                                   .max(0.0);
  return apart.matrix().squaredNorm();
}

}  // namespace

std::int64_t tile_key(std::int64_t tile_x, std::int64_t tile_y) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(tile_x) << 32 |
                                   static_cast<std::uint32_t>(tile_y));
}

std::int64_t BoxGrid::bucket(double at_m) const {
  return static_cast<std::int64_t>(
      std::floor(std::clamp(at_m, -kFarthest_m, kFarthest_m) / side_m_));
}

void BoxGrid::add(const map::Box2& box) {
  constexpr std::int64_t most_buckets = 10'000;
  if (boxes_.size() >= kMostBoxes) throw std::length_error(kTooMuchToCheck);
  const auto number = static_cast<std::uint32_t>(boxes_.size());
  boxes_.push_back(box);
  const std::int64_t from_x = bucket(box.min_in_source.x()), to_x = bucket(box.max_in_source.x());
  const std::int64_t from_y = bucket(box.min_in_source.y()), to_y = bucket(box.max_in_source.y());
  if ((to_x - from_x + 1) * (to_y - from_y + 1) > most_buckets) return wide_.push_back(number);
  for (std::int64_t y = from_y; y <= to_y; ++y) {
    for (std::int64_t x = from_x; x <= to_x; ++x) buckets_[tile_key(x, y)].push_back(number);
  }
}

double BoxGrid::least_of(const Bucket& bucket, const BodyOutline::Place& body,
                         const map::Box2& around, double least_m) const {
  for (const std::uint32_t i : bucket) {
    if (squared_gap_m2(around, boxes_[i]) >= least_m * least_m) continue;
    least_m = std::min(least_m, body.distance_m(corners_of(boxes_[i])));
  }
  return least_m;
}

// As a square, which holds what its boxes have in it; what sticks out is in other buckets as well.
map::Box2 BoxGrid::square(std::int64_t x, std::int64_t y) const {
  const Eigen::Vector2d least =
      side_m_ * Eigen::Vector2d(static_cast<double>(x), static_cast<double>(y));
  return {least, least.array() + side_m_};
}

double BoxGrid::distance_m(const BodyOutline::Place& body, double limit_m) const {
  const map::Box2 around = body.around();
  double least_m = least_of(wide_, body, around, limit_m);
  const std::int64_t from_x = bucket(around.min_in_source.x() - limit_m),
                     to_x = bucket(around.max_in_source.x() + limit_m),
                     from_y = bucket(around.min_in_source.y() - limit_m),
                     to_y = bucket(around.max_in_source.y() + limit_m);
  const double count =
      static_cast<double>(to_x - from_x + 1) * static_cast<double>(to_y - from_y + 1);
  if (count > static_cast<double>(buckets_.size())) {
    for (const auto& [key, bucket] : buckets_) least_m = least_of(bucket, body, around, least_m);
    return least_m;
  }
  for (std::int64_t y = from_y; y <= to_y; ++y) {
    for (std::int64_t x = from_x; x <= to_x && least_m > 0.0; ++x) {
      if (squared_gap_m2(around, square(x, y)) >= least_m * least_m) continue;
      const auto found = buckets_.find(tile_key(x, y));
      if (found != buckets_.end()) least_m = least_of(found->second, body, around, least_m);
    }
  }
  return least_m;
}

bool BoxGrid::holds(const Eigen::Vector2d& point) const {
  const auto in = [&](std::uint32_t i) {
    return (boxes_[i].min_in_source.array() < point.array()).all() &&
           (point.array() < boxes_[i].max_in_source.array()).all();
  };
  const auto found = buckets_.find(tile_key(bucket(point.x()), bucket(point.y())));
  return std::ranges::any_of(wide_, in) ||
         (found != buckets_.end() && std::ranges::any_of(found->second, in));
}

}  // namespace roadbed::planning::audit
