#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace roadbed::map::open_drive {

/// A road whose numbers cannot be those of a road.
class RoadFault : public std::runtime_error {
 public:
  RoadFault(std::size_t road, const std::string& found, const std::string& remedy)
      : std::runtime_error(found), road_index(road), what_to_do(remedy) {}
  std::size_t road_index;
  std::string what_to_do;
};

/// How many points a map may still be sampled into. A file can ask for endless points with a few
/// bytes (a road of 1,000 km in millimetre curves); memory stays bounded by the file's size.
class PointBudget {
 public:
  explicit PointBudget(std::size_t file_bytes) : left_(1'500'000 + file_bytes) {}

  /// @throws RoadFault if fewer than `points` are left.
  void spend(std::size_t points, std::size_t road) {
    if (points > left_) {
      throw RoadFault(road, "its curves need more points than a map of this size can hold",
                      "check its lengths and curvatures, or sample it with a larger --max-error");
    }
    left_ -= points;
  }

 private:
  std::size_t left_;
};

}  // namespace roadbed::map::open_drive
