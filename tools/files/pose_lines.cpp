#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/files/drive_formats.h"

namespace roadbed::tools::inline files {
namespace {

constexpr std::size_t kTum = 8, kKitti = 12;

/// Numbers between blanks; empty where something else stands.
std::vector<double> numbers_in(std::string_view line) {
  std::vector<double> numbers;
  const char* at = line.data();
  const char* const end = at + line.size();
  for (;;) {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\r')) ++at;
    if (at == end) return numbers;
    double value = 0.0;
    const auto [stop, error] = std::from_chars(at, end, value);
    const bool is_word = stop == end || *stop == ' ' || *stop == '\t' || *stop == '\r';
    if (error != std::errc() || !std::isfinite(value) || !is_word) return {};
    numbers.push_back(value);
    at = stop;
  }
}

bool is_blank(std::string_view line) {
  const std::size_t sign = line.find_first_not_of(" \t\r");
  return sign == std::string_view::npos || line[sign] == '#';
}

std::string_view take_line(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  return line;
}

Eigen::Isometry3d of_tum(const std::vector<double>& v) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
  pose.linear() = Eigen::Quaterniond(v[7], v[4], v[5], v[6]).normalized().toRotationMatrix();
  return pose;
}

Eigen::Isometry3d of_kitti(const std::vector<double>& v) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      pose.matrix()(row, column) = v[static_cast<std::size_t>(4 * row + column)];
    }
  }
  return pose;
}

std::string fault_of(const std::vector<double>& v) {
  constexpr double off = 0.01;
  if (v.size() == kTum) {
    const double length = Eigen::Vector4d(v[4], v[5], v[6], v[7]).norm();
    return std::abs(length - 1.0) <= off ? ""
                                         : fmt::format("a quaternion of length {:.4g}", length);
  }
  const Eigen::Matrix3d turn = of_kitti(v).linear();
  const bool is_rotation = (turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm() <= off;
  return is_rotation && turn.determinant() > 0.0 ? "" : "a matrix that is no rotation";
}

}  // namespace

bool begins_as_pose_lines(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::string_view line = take_line(bytes);
    if (is_blank(line)) continue;
    const std::size_t count = numbers_in(line).size();
    return count == kTum || count == kKitti;
  }
  return false;
}

DrivePoses parse_pose_lines(std::string_view bytes, const std::string& name,
                            const DriveOptions& options) {
  DrivePoses read{.unit = "line", .has_rotations = true};
  std::size_t line_number = 0, width = 0;
  double step_s = 0.0;
  for (std::string_view rest = bytes; !rest.empty();) {
    const std::string_view line = take_line(rest);
    ++line_number;
    if (is_blank(line)) continue;
    const std::vector<double> numbers = numbers_in(line);
    if (width == 0) {
      width = numbers.size();
      if (width == kKitti) step_s = needed_step_s(options, name, "KITTI");
    }
    const std::string fault =
        numbers.size() == width ? fault_of(numbers) : fmt::format("{} numbers", numbers.size());
    if (!fault.empty()) {
      throw map::InputError({.file = name,
                             .place = std::to_string(line_number),
                             .found = fault,
                             .needed = width == kTum ? "t x y z qx qy qz qw, a rotation"
                                                     : "12 numbers of a rotation and a place",
                             .remedy = "mend the line"});
    }
    const double t_s = width == kTum ? numbers[0] : step_s * static_cast<double>(read.poses.size());
    read.poses.push_back(
        flat_pose(t_s, width == kTum ? of_tum(numbers) : of_kitti(numbers), options));
    read.places.push_back(line_number);
  }
  return read;
}

}  // namespace roadbed::tools::files
