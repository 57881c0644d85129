#include "roadbed/tools/files/drive_options.h"

#include <charconv>
#include <cmath>
#include <vector>

namespace roadbed::tools::inline files {

using geometry::Pose2;

std::optional<Pose2> pose_frame(const std::string& words, const geometry::VehicleShape& shape) {
  if (words == "rear-axle") return Pose2{};
  if (words == "centre") return Pose2{0.5 * shape.length_m - shape.rear_overhang_m, 0.0, 0.0};
  std::vector<double> numbers;
  const char* at = words.data();
  const char* const end = at + words.size();
  for (;;) {
    double value = 0.0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !(std::abs(value) <= 100.0)) return std::nullopt;
    numbers.push_back(value);
    if (stop == end) break;
    if (*stop != ',') return std::nullopt;
    at = stop + 1;
  }
  if (numbers.size() < 2 || numbers.size() > 3) return std::nullopt;
  return Pose2{numbers[0], numbers[1], numbers.size() == 3 ? numbers[2] : 0.0};
}

}  // namespace roadbed::tools::files
