#include "roadbed/map/occupancy/clouds/sensor_poses.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

constexpr double kOff = 0.01;  // of a rotation written with few digits
constexpr double kFarthest = 1e9;

class PoseParser {
 public:
  PoseParser(std::string_view bytes, const std::string& name) : lines_(bytes), name_(name) {}

  std::vector<Eigen::Isometry3d> parse() {
    while (!lines_.done()) {
      const std::vector<double> numbers = numbers_of(lines_.next_line());
      if (numbers.empty()) continue;
      if (count_ == 0) count_ = numbers.size();
      if (numbers.size() != count_ || (count_ != 8 && count_ != 12)) {
        refuse(fmt::format("has {} numbers", numbers.size()),
               poses_.empty() ? "8 (TUM) or 12 (KITTI)" : fmt::format("{} as before", count_));
      }
      poses_.push_back(count_ == 8 ? tum(numbers) : kitti(numbers));
    }
    if (poses_.empty()) refuse("holds no pose", "a line for each cloud");
    return std::move(poses_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& needed) const {
    refuse_cloud(name_, fmt::format("{}", lines_.line_number()), "", found, needed,
                 "write the poses in TUM's or KITTI's form");
  }

  std::vector<double> numbers_of(std::string_view line) const {
    std::vector<double> numbers;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      if (numbers.empty() && word.starts_with('#')) return {};
      const std::optional<double> value = parse_number(word);
      if (!value || !std::isfinite(*value)) {
        refuse(fmt::format("\"{}\"", word), "a finite number");
      }
      numbers.push_back(*value);
    }
    return numbers;
  }

  Eigen::Isometry3d tum(const std::vector<double>& n) {
    if (last_s_ && !(n[0] > *last_s_)) {
      refuse(fmt::format("{} s does not come after {} s", n[0], *last_s_), "increasing times");
    }
    last_s_ = n[0];
    const Eigen::Quaterniond turn(n[7], n[4], n[5], n[6]);
    if (!(std::abs(turn.norm() - 1.0) <= kOff)) {
      refuse(fmt::format("a quaternion of length {}", turn.norm()), "length 1");
    }
    return checked(turn.normalized().toRotationMatrix(), {n[1], n[2], n[3]});
  }

  Eigen::Isometry3d kitti(const std::vector<double>& n) const {
    Eigen::Matrix3d turn;
    turn << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
    const double off =
        (turn * turn.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
    if (!(off <= kOff) || !(turn.determinant() > 0.0)) {
      refuse("a matrix that is no rotation", "three orthogonal axes of length 1, right-handed");
    }
    return checked(Eigen::Quaterniond(turn).normalized().toRotationMatrix(), {n[3], n[7], n[11]});
  }

  Eigen::Isometry3d checked(const Eigen::Matrix3d& turn, const Eigen::Vector3d& place) const {
    if (!(place.cwiseAbs().maxCoeff() <= kFarthest)) {
      refuse("a place beyond any Earth frame", fmt::format("at most {:g} m", kFarthest));
    }
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = turn;
    pose.translation() = place;
    return pose;
  }

  TextScanner lines_;
  const std::string& name_;
  std::size_t count_ = 0;
  std::optional<double> last_s_;
  std::vector<Eigen::Isometry3d> poses_;
};

}  // namespace

std::vector<Eigen::Isometry3d> parse_sensor_poses(std::string_view bytes, const std::string& name) {
  return PoseParser(bytes, name).parse();
}

std::vector<Eigen::Isometry3d> read_sensor_poses(const std::filesystem::path& file) {
  return parse_sensor_poses(read_file(file, most_unpacked_of_rows), input_name(file));
}

}  // namespace roadbed::map::occupancy::clouds
