#include "roadbed/map/logs/foxglove_poses.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/logs/protobuf.h"

namespace roadbed::map::inline logs {
namespace {

constexpr std::string_view kFoxgloveTransform = "foxglove.FrameTransform",
                           kFoxgloveTransforms = "foxglove.FrameTransforms",
                           kFoxglovePose = "foxglove.PoseInFrame";

/// google.protobuf.Timestamp; 0 is when the message was recorded, as with ROS.
std::int64_t stamp_of(ProtoReader time, std::int64_t received_ns) {
  std::uint64_t seconds = 0, nanos = 0;
  while (const auto field = time.next()) {
    if (field->number == 1 && field->value) seconds = *field->value;
    if (field->number == 2 && field->value) nanos = *field->value;
  }
  constexpr std::uint64_t most_s = 4'600'000'000, second_ns = 1'000'000'000;
  if (seconds > most_s || nanos >= second_ns) {
    time.refuse(fmt::format("a time of {} s and {} ns", seconds, nanos), "one from 1970 to 2115");
  }
  const auto stamp_ns = static_cast<std::int64_t>(seconds * second_ns + nanos);
  return stamp_ns == 0 ? received_ns : stamp_ns;
}

/// Numbers of the fields 1 to N; what is not written is 0.
template <std::size_t N>
std::array<double, N> numbers_of(ProtoReader message) {
  std::array<double, N> numbers{};
  while (const auto field = message.next()) {
    if (field->number < 1 || field->number > N) continue;
    const auto value = field->real();
    if (!value) message.refuse("a number that is no double", "a double");
    numbers[field->number - 1] = *value;
  }
  return numbers;
}

/// What two messages say of a pose: place and turn.
struct PlaceAndTurn {
  std::array<double, 3> place{};
  std::array<double, 4> turn{};  // x, y, z, w

  Eigen::Isometry3d isometry(const ProtoReader& reader) const {
    Eigen::Quaterniond quaternion;
    quaternion.coeffs() << turn[0], turn[1], turn[2], turn[3];
    const Eigen::Vector3d position(place[0], place[1], place[2]);
    if (const PoseFault fault = pose_fault(position, quaternion); !fault.found.empty()) {
      reader.refuse(fault.found, fault.needed);
    }
    return pose_of(position, quaternion);
  }
};

FrameTransform transform_of(ProtoReader message, std::int64_t received_ns) {
  FrameTransform transform;
  transform.child_in_parent.stamp_ns = received_ns;
  PlaceAndTurn at;
  while (const auto field = message.next()) {
    const ProtoReader inner = message.inner(*field);
    if (field->number == 1) transform.child_in_parent.stamp_ns = stamp_of(inner, received_ns);
    if (field->number == 2) transform.parent = one_line(std::string(field->bytes));
    if (field->number == 3) transform.child = one_line(std::string(field->bytes));
    if (field->number == 4) at.place = numbers_of<3>(inner);
    if (field->number == 5) at.turn = numbers_of<4>(inner);
  }
  transform.child_in_parent.pose = at.isometry(message);
  return transform;
}

Eigen::Isometry3d pose_in(ProtoReader message) {
  PlaceAndTurn at;
  while (const auto field = message.next()) {
    if (field->number == 1) at.place = numbers_of<3>(message.inner(*field));
    if (field->number == 2) at.turn = numbers_of<4>(message.inner(*field));
  }
  return at.isometry(message);
}

std::string place_of(const LogTopic& topic, const LogMessage& message) {
  return topic.name + ", " + message.place;
}

}  // namespace

bool is_foxglove_transform_type(std::string_view type) {
  return type == kFoxgloveTransform || type == kFoxgloveTransforms;
}
bool is_foxglove_pose_type(std::string_view type) { return type == kFoxglovePose; }

std::vector<FrameTransform> parse_foxglove_transforms(const LogTopic& topic,
                                                      const LogMessage& message,
                                                      const std::string& file) {
  const std::string place = place_of(topic, message);
  ProtoReader reader(message.bytes, file, place);
  if (topic.type == kFoxgloveTransform) return {transform_of(reader, message.received_ns)};
  std::vector<FrameTransform> transforms;
  while (const auto field = reader.next()) {
    if (field->number != 1) continue;
    transforms.push_back(transform_of(reader.inner(*field), message.received_ns));
  }
  return transforms;
}

PoseMessage parse_foxglove_pose(const LogTopic& topic, const LogMessage& message,
                                const std::string& file) {
  const std::string place = place_of(topic, message);
  ProtoReader reader(message.bytes, file, place);
  PoseMessage read{{message.received_ns, Eigen::Isometry3d::Identity()}, {}, {}};
  bool has_pose = false;
  while (const auto field = reader.next()) {
    const ProtoReader inner = reader.inner(*field);
    if (field->number == 1) read.at.stamp_ns = stamp_of(inner, message.received_ns);
    if (field->number == 2) read.frame = one_line(std::string(field->bytes));
    if (field->number == 3) read.at.pose = pose_in(inner);
    has_pose = has_pose || field->number == 3;
  }
  if (!has_pose) reader.refuse("a message without a pose", "one");
  return read;
}

geometry::TrajectoryPoint parse_drive_state(const LogTopic& topic, const LogMessage& message,
                                            const std::string& file) {
  const std::string place = place_of(topic, message);
  ProtoReader reader(message.bytes, file, place);
  std::array<double, 8> row{};
  while (const auto field = reader.next()) {
    if (field->number < 2 || field->number > 9) continue;
    const auto value = field->real();
    if (!value || !std::isfinite(*value)) reader.refuse("a row with no number", "finite ones");
    row[field->number - 2] = *value;
  }
  return {.t_s = row[0],
          .x_m = row[1],
          .y_m = row[2],
          .heading_rad = row[3],
          .speed_mps = row[4],
          .acceleration_mps2 = row[5],
          .steering_rad = row[6],
          .curvature_per_m = row[7]};
}

}  // namespace roadbed::map::logs
