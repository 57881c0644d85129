#include "roadbed/map/occupancy/clouds/message_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
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
  std::array<char, sizeof(Real)> taken;
  std::memcpy(taken.data(), bytes, sizeof(Real));
  if constexpr (is_turned) std::ranges::reverse(taken);
  return static_cast<double>(std::bit_cast<Real>(taken));
}

class Decoder {
 public:
  Decoder(const CloudMessage& message, const Layout& layout, const MessageFrames& frames,
          const AttributeFilter& attributes, const std::optional<Box3>& vehicle_box)
      : message_(message),
        layout_(layout),
        time_(PointTime::of(message)),
        attributes_(attributes),
        vehicle_box_(vehicle_box) {
    if (frames.pose_at) poses_.emplace(frames.pose_at, message.stamp_ns);
    if (vehicle_box && frames.in_vehicle) {
      in_vehicle_ = frames.in_vehicle(message.stamp_ns).value_or(Eigen::Isometry3d::Identity());
    }
  }

  MessagePoints points() {
    const bool are_floats = !layout_.is_double && !layout_.is_turned;
    if (!poses_ && are_floats && attributes_.keeps_all() && !vehicle_box_) {
      return floats_as_they_stand();
    }
    if (poses_ && !time_ && !poses_->at_stamp()) {
      found_.without_pose = message_.height * message_.width;
      return std::move(found_);
    }
    // Twice: floats can be written when it is known where they lie. A list of doubles between
    // would take twice the memory of all points.
    Box3 box{Eigen::Vector3d::Constant(INFINITY), Eigen::Vector3d::Constant(-INFINITY)};
    std::size_t count = 0;
    for_each([&](const Eigen::Vector3d& point, const Eigen::Vector3d*) {
      box.min_in_source = box.min_in_source.cwiseMin(point);
      box.max_in_source = box.max_in_source.cwiseMax(point);
      ++count;
    });
    if (count > 0) take(box, count);
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

  void take(const Box3& box, std::size_t count) {
    PointCloud& cloud = found_.cloud;
    cloud.origin_in_source = local_origin(box);
    cloud.points.reserve(count);
    for_each([&](const Eigen::Vector3d& point, const Eigen::Vector3d* sensor) {
      if (sensor != nullptr) add_sensor(*sensor);
      cloud.points.emplace_back((point - cloud.origin_in_source).cast<float>());
    });
    if (cloud.scans.size() == 1) {
      cloud.sensor_in_source = cloud.scans.front().sensor_in_source;
      cloud.scans.clear();
    }
  }

  void add_sensor(const Eigen::Vector3d& sensor) {
    PointCloud& cloud = found_.cloud;
    if (!cloud.scans.empty() && (sensor - *cloud.scans.back().sensor_in_source).squaredNorm() <
                                    kSameSensor_m * kSameSensor_m) {
      return;
    }
    cloud.scans.push_back({cloud.points.size(), sensor});
  }

  template <class Use>
  void for_each(const Use& use) {
    found_.cloud.dropped_not_finite = found_.cloud.filtered_out = 0;
    found_.without_pose = found_.with_unlikely_times = 0;
    if (layout_.is_double) {
      layout_.is_turned ? for_each_of<double, true>(use) : for_each_of<double, false>(use);
    } else {
      layout_.is_turned ? for_each_of<float, true>(use) : for_each_of<float, false>(use);
    }
  }

  template <class Real, bool is_turned, class Use>
  void for_each_of(const Use& use) {
    const auto [x, y, z] = layout_.offsets;
    for (std::size_t i = 0; i < message_.height; ++i) {
      const char* at = row(i);
      for (std::size_t k = 0; k < message_.width; ++k, at += message_.point_step) {
        const Eigen::Vector3d point(real_at<Real, is_turned>(at + x),
                                    real_at<Real, is_turned>(at + y),
                                    real_at<Real, is_turned>(at + z));
        if (!(point.cwiseAbs().maxCoeff() < RawCloud::kBeyondEarth) || !point.allFinite()) {
          ++found_.cloud.dropped_not_finite;
        } else if (is_filtered_out(at, point)) {
          ++found_.cloud.filtered_out;
        } else if (!poses_) {
          use(point, nullptr);
        } else {
          use_placed(at, point, use);
        }
      }
    }
  }

  bool is_filtered_out(const char* at, const Eigen::Vector3d& point) const {
    if (vehicle_box_ && vehicle_box_->holds(in_vehicle_ * point)) return true;
    return !attributes_.keeps([&](std::size_t i) {
      const PointField& field = message_.fields[i];
      return read_scalar(at + field.offset, scalar_of(field), message_.is_big_endian);
    });
  }

  template <class Use>
  void use_placed(const char* at, const Eigen::Vector3d& point, const Use& use) {
    const std::optional<SweepPoses::Placing> timed = time_ ? placing(at) : std::nullopt;
    const std::optional<SweepPoses::Placing>& placing = time_ ? timed : poses_->at_stamp();
    if (!placing) {
      ++found_.without_pose;
      return;
    }
    const Eigen::Vector3d sensor = placing->col(3);
    use(placing->leftCols<3>() * point + sensor, &sensor);
  }

  std::optional<SweepPoses::Placing> placing(const char* at) {
    const double since_stamp_ns = time_->since_stamp_ns(at);
    if (std::abs(since_stamp_ns) < SweepPoses::kFarthest_ns) return poses_->at(since_stamp_ns);
    ++found_.with_unlikely_times;
    return poses_->at_stamp();
  }

  const CloudMessage& message_;
  Layout layout_;
  std::optional<PointTime> time_;
  std::optional<SweepPoses> poses_;
  const AttributeFilter& attributes_;
  const std::optional<Box3>& vehicle_box_;
  Eigen::Isometry3d in_vehicle_ = Eigen::Isometry3d::Identity();
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
