#include "roadbed/map/logs/foxglove_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "roadbed/map/logs/foxglove_schemas.h"
#include "roadbed/map/logs/log_drive.h"
#include "roadbed/map/logs/protobuf.h"
#include "roadbed/tests/map/logs/logged_drive.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;

ProtoWriter time_of(std::int64_t ns) {
  return ProtoWriter()
      .whole(1, static_cast<std::uint64_t>(ns / 1'000'000'000))
      .whole(2, static_cast<std::uint64_t>(ns % 1'000'000'000));
}
ProtoWriter place(double x_m, double y_m) { return ProtoWriter().number(1, x_m).number(2, y_m); }
ProtoWriter turn(double heading_rad) {
  return ProtoWriter()
      .number(3, std::sin(0.5 * heading_rad))
      .number(4, std::cos(0.5 * heading_rad));
}

// 10 poses at 100 ms: 1e6 + i, -2 i, heading 0.3 i.
double heading(int i) { return 0.3 * i; }
std::int64_t stamp_ns(int i) { return kStart_ns + 100'000'000 * i; }

std::string transform(int i) {
  return ProtoWriter()
      .message(1, time_of(stamp_ns(i)))
      .bytes(2, "map")
      .bytes(3, "base_link")
      .message(4, place(1e6 + i, -2.0 * i))
      .message(5, turn(heading(i)))
      .bytes();
}

std::string pose(int i) {
  return ProtoWriter()
      .message(1, time_of(stamp_ns(i)))
      .bytes(2, "map")
      .message(3, ProtoWriter().message(1, place(1e6 + i, -2.0 * i)).message(2, turn(heading(i))))
      .bytes();
}

std::string state(int i) {
  ProtoWriter state;
  state.message(1, time_of(stamp_ns(i)));
  for (std::uint32_t field = 2; field <= 9; ++field) state.number(field, i + 0.1 * field);
  return state.bytes();
}

/// Topics of a type each, with ten messages.
struct Topic {
  std::string name, type;
  std::string (*message)(int i);
  std::string encoding = "protobuf";
};

std::string log_of(const std::vector<Topic>& topics) {
  McapWriter writer("a test");
  for (const Topic& topic : topics) {
    const std::uint16_t id =
        writer.add_topic({topic.name, topic.type, topic.encoding}, {topic.encoding, ""});
    for (int i = 0; i < 10; ++i) writer.write(id, stamp_ns(i) + 7, topic.message(i));
  }
  return writer.finish();
}

void expect_has_the_poses(const LogDrive& drive) {
  ASSERT_EQ(drive.poses.size(), 10u);
  for (int i = 0; i < 10; ++i) {
    const TimedPose& at = drive.poses[static_cast<std::size_t>(i)];
    EXPECT_EQ(at.stamp_ns, stamp_ns(i));
    EXPECT_EQ(at.pose.translation(), Eigen::Vector3d(1e6 + i, -2.0 * i, 0.0));
    EXPECT_NEAR(std::atan2(at.pose.linear()(1, 0), at.pose.linear()(0, 0)), heading(i), 1e-12);
  }
}

TEST(FoxglovePoses, AreADriveAsTransformsOneOrManyInAMessageAndAsPoses) {
  expect_has_the_poses(drive_in(log_of({{"/tf", "foxglove.FrameTransform", transform}})));
  expect_has_the_poses(drive_in(log_of({{"/pose", "foxglove.PoseInFrame", pose}})));
  const auto both = [](int i) {
    return ProtoWriter().bytes(1, transform(i)).bytes(1, transform(i)).bytes();
  };
  expect_has_the_poses(drive_in(log_of({{"/tf", "foxglove.FrameTransforms", both}})));
}

TEST(FoxglovePoses, RowsOfRoadbedAreMeantBeforeOtherTopicsAndComeBackBitForBit) {
  const std::string log = log_of({{"/tf", "foxglove.FrameTransform", transform},
                                  {"/drive", std::string(kDriveStateType), state}});
  const LogDrive drive = drive_in(log);
  EXPECT_EQ(drive.topic, "/drive");
  ASSERT_EQ(drive.rows.size(), 10u);
  for (int i = 0; i < 10; ++i) {
    const auto& row = drive.rows[static_cast<std::size_t>(i)];
    std::uint32_t field = 2;
    for (const double value : {row.t_s, row.x_m, row.y_m, row.heading_rad, row.speed_mps,
                               row.acceleration_mps2, row.steering_rad, row.curvature_per_m}) {
      EXPECT_EQ(value, i + 0.1 * field++);
    }
  }
  expect_has_the_poses(drive_in(log, "/tf"));
}

TEST(FoxglovePoses, InAnotherEncodingAreNoDriveAndInNobodysWay) {
  const auto json = [](int) { return std::string("{}"); };
  const std::string log = log_of({{"/json", "foxglove.FrameTransform", json, "json"},
                                  {"/pose", "foxglove.PoseInFrame", pose}});
  expect_has_the_poses(drive_in(log));
}

TEST(FoxglovePoses, CutOffOrOfAnotherKindAreRefused) {
  const auto cut = [](int i) { return pose(i).substr(0, pose(i).size() - 3); };
  EXPECT_THAT(fault_of(log_of({{"/pose", "foxglove.PoseInFrame", cut}})), HasSubstr("/pose, byte"));
  const auto unturned = [](int) {
    return ProtoWriter().message(3, ProtoWriter().message(1, place(1.0, 2.0))).bytes();
  };
  EXPECT_THAT(fault_of(log_of({{"/pose", "foxglove.PoseInFrame", unturned}})),
              HasSubstr("quaternion of length 0"));
  const auto empty = [](int) { return std::string(); };
  EXPECT_THAT(fault_of(log_of({{"/pose", "foxglove.PoseInFrame", empty}})),
              HasSubstr("without a pose"));
  const auto infinite = [](int) { return ProtoWriter().number(4, INFINITY).bytes(); };
  EXPECT_THAT(fault_of(log_of({{"/drive", std::string(kDriveStateType), infinite}})),
              HasSubstr("finite"));
  const auto groups = [](int) { return std::string("\x0b"); };
  EXPECT_THAT(fault_of(log_of({{"/drive", std::string(kDriveStateType), groups}})),
              HasSubstr("wire type 3"));
}

TEST(FoxgloveSchemas, HoldAllThatAMessageIsMadeOf) {
  const std::string schema = foxglove_schema("foxglove.SceneUpdate").bytes;
  for (const char* name : {"google/protobuf/timestamp.proto", "google/protobuf/duration.proto",
                           "foxglove/SceneEntity.proto", "foxglove/Point3.proto"}) {
    EXPECT_THAT(schema, HasSubstr(name));
  }
  EXPECT_THAT(schema, testing::Not(HasSubstr("PointCloud")));
  EXPECT_THROW(foxglove_schema("foxglove.Nothing"), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::map
