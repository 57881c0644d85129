#include "roadbed/map/occupancy/clouds/message_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/endian/conversion.hpp>
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>
#include <vector>

#include "roadbed/map/occupancy/clouds/attribute_filter.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"
#include "roadbed/map/occupancy/clouds/point_time.h"
#include "roadbed/map/occupancy/clouds/sweep_poses.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

constexpr std::uint8_t kFloat32 = 7, kFloat64 = 8;
constexpr bool kIsBigMachine = std::endian::native == std::endian::big;

/// Where x, y and z stand in a point.
struct Layout {
  std::array<std::size_t, 3> offsets;
  bool is_double, is_turned;
};

Layout layout_of(const CloudMessage& message, const std::string& file, const std::string& place) {
  std::array<const PointField*, 3> fields{};
  for (const PointField& field : message.fields) {
    if (field.name == "x") fields[0] = &field;
    if (field.name == "y") fields[1] = &field;
    if (field.name == "z") fields[2] = &field;
  }
  const auto refuse = [&](const std::string& found) {
    refuse_cloud(file, place, "fields", found, "x, y and z, all float32 or all float64",
                 "name another topic by --topic");
  };
  for (const PointField* field : fields) {
    if (field == nullptr) refuse("not all of x, y and z are there");
    if (field->type != fields[0]->type) refuse("x, y and z are of several types");
  }
  const std::uint8_t type = fields[0]->type;
  if (type != kFloat32 && type != kFloat64) refuse(fmt::format("x is of type {}", type));
  const std::size_t size = type == kFloat64 ? 8 : 4;
  std::array<std::size_t, 3> offsets{fields[0]->offset, fields[1]->offset, fields[2]->offset};
  std::array<std::size_t, 3> sorted = offsets;
  std::ranges::sort(sorted);
  if (sorted[1] < sorted[0] + size || sorted[2] < sorted[1] + size) refuse("x, y and z overlap");
  return {offsets, type == kFloat64, message.is_big_endian != kIsBigMachine};
}

template <class Real, bool is_turned>
double real_at(const char* bytes) {
  std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t> bits;
  std::memcpy(&bits, bytes, sizeof bits);
  if constexpr (is_turned) boost::endian::endian_reverse_inplace(bits);
  return static_cast<double>(std::bit_cast<Real>(bits));
}

class Decoder {
 public:
  Decoder(const CloudMessage& message, const Layout& layout, const MessageFrames& frames,
          const AttributeFilter& attributes, const std::optional<Box3>& vehicle_box)
      : message_(message),
        layout_(layout),
        time_(PointTime::of(message)),
        attributes_(attributes),
        vehicle_box_(vehicle_box),
        is_filtered_(vehicle_box || !attributes.keeps_all()) {
    if (frames.pose_at) poses_.emplace(frames.pose_at, message.stamp_ns);
    if (vehicle_box && frames.in_vehicle) {
      in_vehicle_ = frames.in_vehicle(message.stamp_ns).value_or(Eigen::Isometry3d::Identity());
    }
  }

  MessagePoints points() {
    if (!poses_ && !layout_.is_double && !layout_.is_turned && !is_filtered_) {
      return floats_as_they_stand();
    }
    if (poses_ && !time_ && !poses_->knows_stamp()) {
      found_.without_pose = message_.height * message_.width;
      return std::move(found_);
    }
    // Twice, if they turn out to lie far from 0. A list of doubles between would take twice the
    // memory of all points.
    take_relative_to(Eigen::Vector3d::Zero());
    if (kept_ > 0) {
      const Eigen::Vector3d origin = local_origin(box_);
      if (!origin.isZero(0.0)) take_relative_to(origin);
    }
    return std::move(found_);
  }

 private:
  // The sensor is said to be where it was for another point, if it has moved less since.
  static constexpr double kSameSensor_m = 0.02;

  const char* row(std::size_t i) const { return message_.data.data() + i * message_.row_step; }

  MessagePoints floats_as_they_stand() {
    RawCloud raw;
    raw.float_points_in_source.reserve(message_.height * message_.width);
    for (std::size_t i = 0; i < message_.height; ++i) {
      add_float_points({row(i), message_.width, message_.point_step, layout_.offsets[0],
                        layout_.offsets[1], layout_.offsets[2]},
                       raw);
    }
    found_.cloud.dropped_not_finite = raw.dropped_not_finite;
    if (!raw.empty()) found_.cloud = relative_to_origin(std::move(raw));
    return std::move(found_);
  }

  void take_relative_to(const Eigen::Vector3d& origin_in_source) {
    found_ = {};
    kept_ = run_.count = 0;
    box_ = {Eigen::Vector3d::Constant(INFINITY), Eigen::Vector3d::Constant(-INFINITY)};
    PointCloud& cloud = found_.cloud;
    cloud.origin_in_source = origin_in_source;
    cloud.points.resize(message_.height * message_.width);  // a vector of Eigen's is left as it is
    if (layout_.is_double) {
      layout_.is_turned ? take_all<double, true>() : take_all<double, false>();
    } else {
      layout_.is_turned ? take_all<float, true>() : take_all<float, false>();
    }
    cloud.points.resize(kept_);
    if (cloud.scans.size() == 1) {
      cloud.sensor_in_source = cloud.scans.front().sensor_in_source;
      cloud.scans.clear();
    }
  }

  template <class Real, bool is_turned>
  void take_all() {
    const auto [x, y, z] = layout_.offsets;
    for (std::size_t i = 0; i < message_.height; ++i) {
      const char* at = row(i);
      for (std::size_t k = 0; k < message_.width; ++k, at += message_.point_step) {
        take(at, {real_at<Real, is_turned>(at + x), real_at<Real, is_turned>(at + y),
                  real_at<Real, is_turned>(at + z)});
      }
    }
    finish_run();
  }

  static bool is_on_earth(double value) {
    return std::abs(value) < RawCloud::kBeyondEarth;  // false for NaN
  }

  void take(const char* at, const Eigen::Vector3d& point) {
    if (!is_on_earth(point.x()) || !is_on_earth(point.y()) || !is_on_earth(point.z())) {
      ++found_.cloud.dropped_not_finite;
      return;
    }
    if (is_filtered_ && is_filtered_out(at, point)) {
      ++found_.cloud.filtered_out;
      return;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      run_.at[axis][run_.count] = point[static_cast<Eigen::Index>(axis)];
    }
    if (time_ && poses_) run_.since_stamp_ns[run_.count] = likely_time_ns(at);
    if (++run_.count == PointRun::kMost) finish_run();
  }

  double likely_time_ns(const char* at) {
    const double since_stamp_ns = time_->since_stamp_ns(at);
    if (std::abs(since_stamp_ns) < SweepPoses::kFarthest_ns) return since_stamp_ns;
    ++found_.with_unlikely_times;
    return 0.0;
  }

  bool is_filtered_out(const char* at, const Eigen::Vector3d& point) const {
    if (vehicle_box_ && vehicle_box_->holds(in_vehicle_ * point)) return true;
    return !attributes_.keeps([&](std::size_t i) {
      const PointField& field = message_.fields[i];
      return read_scalar(at + field.offset, scalar_of(field), message_.is_big_endian);
    });
  }

  void finish_run() {
    if (!poses_) {
      write(run_.at, run_.count);
    } else {
      poses_->place(run_, placed_);
      found_.without_pose += run_.count - placed_.count;
      add_sensors();
      write(placed_.at, placed_.count);
    }
    run_.count = 0;
  }

  void add_sensors() {
    std::vector<ScanStart>& scans = found_.cloud.scans;
    for (std::size_t i = 0; i < placed_.count; ++i) {
      const Eigen::Vector3d sensor(placed_.sensor[0][i], placed_.sensor[1][i],
                                   placed_.sensor[2][i]);
      if (!scans.empty() &&
          (sensor - *scans.back().sensor_in_source).squaredNorm() < kSameSensor_m * kSameSensor_m) {
        continue;
      }
      scans.push_back({kept_ + i, sensor});
    }
  }

  void write(const std::array<PointRun::Values, 3>& at, std::size_t count) {
    if (count == 0) return;
    float* const to = found_.cloud.points[kept_].data();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto row = static_cast<Eigen::Index>(axis);
      const double origin = found_.cloud.origin_in_source[row];
      double least = box_.min_in_source[row], most = box_.max_in_source[row];
      for (std::size_t i = 0; i < count; ++i) {
        least = std::min(least, at[axis][i]);
        most = std::max(most, at[axis][i]);
        to[3 * i + axis] = static_cast<float>(at[axis][i] - origin);
      }
      box_.min_in_source[row] = least;
      box_.max_in_source[row] = most;
    }
    kept_ += count;
  }

  const CloudMessage& message_;
  Layout layout_;
  std::optional<PointTime> time_;
  std::optional<SweepPoses> poses_;
  const AttributeFilter& attributes_;
  const std::optional<Box3>& vehicle_box_;
  bool is_filtered_;
  Eigen::Isometry3d in_vehicle_ = Eigen::Isometry3d::Identity();
  PointRun run_;
  PlacedRun placed_;
  std::size_t kept_ = 0;  // points that are written
  Box3 box_;              // around them
  MessagePoints found_;
};

}  // namespace

MessagePoints points_of_message(const CloudMessage& message, const MessageFrames& frames,
                                const CloudFilter& filter, const std::string& file,
                                const std::string& place) {
  if (message.height == 0 || message.width == 0) return {};
  std::vector<std::string> fields;
  for (const PointField& field : message.fields) fields.push_back(lower(field.name));
  const AttributeFilter attributes(filter, fields, file);
  const Layout layout = layout_of(message, file, place);
  MessagePoints found = Decoder(message, layout, frames, attributes, filter.vehicle_box).points();
  found.cloud.format = "PointCloud2";
  found.cloud.unit = LengthUnit::metre;  // [REP 103]
  return found;
}

}  // namespace roadbed::map::occupancy::clouds
