#include "roadbed/tools/files/drive_options.h"

#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

namespace roadbed::tools::inline files {

using geometry::Pose2;

namespace {

/// X,Y[,HEADING]
std::optional<Pose2> pose_of(std::string_view words) {
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

std::optional<PoseFrame> frame_at(const std::optional<Pose2>& pose, bool is_camera) {
  if (!pose) return std::nullopt;
  return PoseFrame{*pose, is_camera};
}

}  // namespace

std::optional<PoseFrame> pose_frame(const std::string& words, const geometry::VehicleShape& shape) {
  constexpr std::string_view camera_at = "camera:";
  if (words == "rear-axle") return PoseFrame{};
  if (words == "centre") return PoseFrame{{0.5 * shape.length_m - shape.rear_overhang_m, 0.0, 0.0}};
  if (words == "camera") return PoseFrame{.is_camera = true};
  if (words.starts_with(camera_at)) {
    return frame_at(pose_of(std::string_view(words).substr(camera_at.size())), true);
  }
  return frame_at(pose_of(words), false);
}

}  // namespace roadbed::tools::files
