#pragma once

// Private to planning/audit: part of the check of certificates, which shares nothing with the
// audit, so that a fault there is not a fault here.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/check/body_outline.h"

namespace roadbed::planning::inline audit {

/// More boxes, or a place farther away, are too much to be checked.
inline constexpr std::size_t kMostBoxes = 20'000'000;  // 640 MB
inline constexpr double kFarthest_m = 1e9;
inline constexpr auto kTooMuchToCheck =
    "the drive's surroundings have too many columns to be checked";

/// A number for a square of a grid. Unsigned inside, as a witness may be said to stand anywhere.
std::int64_t tile_key(std::int64_t tile_x, std::int64_t tile_y);

/// Axis-aligned boxes in plan view, each kept in the squares of a coarse grid that it meets.
class BoxGrid {
 public:
  explicit BoxGrid(double side_m) : side_m_(side_m) {}

  void add(const map::Box2& box);

  /// Exact distance from a body to the nearest box, or `limit_m` if that is less.
  double distance_m(const BodyOutline::Place& body, double limit_m) const;

  /// Whether a point lies in a box.
  bool holds(const Eigen::Vector2d& point) const;

  std::size_t size() const { return boxes_.size(); }

 private:
  using Bucket = std::vector<std::uint32_t>;

  std::int64_t bucket(double at_m) const;
  map::Box2 square(std::int64_t x, std::int64_t y) const;
  double least_of(const Bucket& bucket, const BodyOutline::Place& body, const map::Box2& around,
                  double least_m) const;

  double side_m_;
  std::vector<map::Box2> boxes_;
  std::unordered_map<std::int64_t, Bucket> buckets_;
  Bucket wide_;  // over too many buckets
};

}  // namespace roadbed::planning::audit
