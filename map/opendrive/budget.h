#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "roadbed/geometry/primitives/work_limit.h"

namespace roadbed::map::opendrive {

/// A road whose numbers cannot be those of a road.
class RoadFault : public std::runtime_error {
 public:
  RoadFault(std::size_t road, const std::string& found, const std::string& remedy)
      : std::runtime_error(found), road_index(road), what_to_do(remedy) {}
  std::size_t road_index;
  std::string what_to_do;
};

/// How many points a map may still be sampled into. A file can ask for endless points with a few
/// bytes (a road of 1,000 km in millimetre curves); memory stays bounded by the file's size: a
/// point costs about 160 bytes until it is in the map.
class PointBudget {
 public:
  /// What a lane or an object costs beside its points.
  static constexpr std::size_t kPerThing = 10;

  static constexpr std::size_t kBytesPerPoint = 160;

  explicit PointBudget(std::size_t file_bytes)
      : file_bytes_(file_bytes), left_(geometry::most_bytes_read(file_bytes) / kBytesPerPoint) {}

  std::size_t left() const { return left_; }
  std::size_t file_bytes() const { return file_bytes_; }

  /// @throws RoadFault if fewer than `points` are left.
  void spend(std::size_t points, std::size_t road) {
    if (!try_to_spend(points)) {
      throw RoadFault(road,
                      "its curves and lanes need more points than a map of this size can hold",
                      "check its lengths, curvatures and lane sections, or sample it with a larger "
                      "--max-error");
    }
  }

  bool try_to_spend(std::size_t points) {
    if (points > left_ && !take_block(points)) return false;
    left_ -= points;
    return true;
  }

  /// A part for one of several threads, which takes blocks of what the others take from, too, and
  /// gives back at its end what it did not spend.
  explicit PointBudget(std::atomic<std::size_t>& common) : common_(&common) {}
  ~PointBudget() {
    if (common_ != nullptr) *common_ += left_;
  }
  PointBudget(const PointBudget&) = delete;
  PointBudget& operator=(const PointBudget&) = delete;

 private:
  bool take_block(std::size_t points) {
    if (common_ == nullptr) return false;
    constexpr std::size_t kBlock = 4096;
    std::size_t there = *common_, block = 0;
    do {
      if (points - left_ > there) return false;
      block = std::min(there, std::max(points - left_, kBlock));
    } while (!common_->compare_exchange_weak(there, there - block));
    left_ += block;
    return true;
  }

  std::atomic<std::size_t>* common_ = nullptr;
  std::size_t file_bytes_ = 0, left_ = 0;
};

/// How many lanes the budget of a file can hold: each has two points of two borders at least.
inline std::size_t most_lanes(std::size_t file_bytes) {
  return PointBudget(file_bytes).left() / (PointBudget::kPerThing + 2);
}

}  // namespace roadbed::map::opendrive
