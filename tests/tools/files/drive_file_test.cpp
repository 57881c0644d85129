#include "roadbed/tools/files/drive_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "roadbed/map/files/read_file.h"
#include "roadbed/tests/support/log_bytes.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"
#include "roadbed/tools/files/trajectory_csv.h"

namespace roadbed::tools {
namespace {

using geometry::Pose2;

std::string fault_of(const std::string& bytes, const DriveOptions& options) {
  return tests::refusal_of([&] { parse_drive(bytes, "a drive", options); });
}

/// On a circle of 20 m, as somebody saw it who sits `seen` in the vehicle.
std::string circle_as_tum(const Pose2& seen) {
  std::string text = "# t x y z qx qy qz qw\n";
  for (int i = 0; i < 50; ++i) {
    const double heading_rad = 0.02 * i;
    const Pose2 axle{20.0 * std::sin(heading_rad), -20.0 * std::cos(heading_rad), heading_rad};
    const Eigen::Vector2d at = axle * Eigen::Vector2d(seen.x_m, seen.y_m);
    const double half_rad = 0.5 * (heading_rad + seen.heading_rad);
    text += fmt::format("{} {} {} 0.3 0 0 {} {}\n", 0.1 * i, at.x(), at.y(), std::sin(half_rad),
                        std::cos(half_rad));
  }
  return text;
}

TEST(DriveFile, IsOfTheRearAxleWhereverThePoseIs) {
  for (const Pose2 seen : {Pose2{0, 0, 0}, Pose2{1.4, 0, 0}, Pose2{-0.5, 0.7, 0.4}}) {
    const auto drive =
        parse_drive(circle_as_tum(seen), "a drive", {.pose_frame = PoseFrame{seen}, .rate_hz = {}});
    ASSERT_EQ(drive.points().size(), 50u);
    for (int i = 0; i < 50; ++i) {
      const auto& row = drive.points()[static_cast<std::size_t>(i)];
      EXPECT_NEAR(row.t_s, 0.1 * i, 1e-12);
      EXPECT_NEAR(row.x_m, 20.0 * std::sin(0.02 * i), 1e-9);
      EXPECT_NEAR(row.y_m, -20.0 * std::cos(0.02 * i), 1e-9);
      EXPECT_NEAR(row.heading_rad, 0.02 * i, 1e-9);
      EXPECT_NEAR(row.speed_mps, 4.0, 0.01) << i;
    }
  }
}

TEST(DriveFile, AsksForWhatTheFileDoesNotSay) {
  const std::string tum = circle_as_tum({});
  EXPECT_NE(fault_of(tum, {}).find("--pose-frame"), std::string::npos);
  const std::string kitti = "1 0 0 5 0 1 0 6 0 0 1 0\n1 0 0 5.5 0 1 0 6 0 0 1 0\n";
  EXPECT_NE(fault_of(kitti, {.pose_frame = PoseFrame{}, .rate_hz = {}}).find("--rate"),
            std::string::npos);
  const auto drive = parse_drive(kitti, "a drive", {.pose_frame = PoseFrame{}, .rate_hz = 10.0});
  EXPECT_EQ(drive.points()[1].x_m, 5.5);
  EXPECT_NEAR(drive.points()[1].t_s, 0.1, 1e-15);
}

TEST(DriveFile, NamesTheLineThatIsNoPose) {
  const DriveOptions options{.pose_frame = PoseFrame{}, .rate_hz = 10.0};
  EXPECT_NE(fault_of("0 1 2 0 0 0 0 1\n1 1 2 0 0 0 0 2\n", options).find("a drive:2:"),
            std::string::npos);
  EXPECT_NE(fault_of("0 1 2 0 0 0 0 1\n0 1 2 0 0 0 0 1\n", options).find("a drive:2: time"),
            std::string::npos);
  EXPECT_NE(fault_of("0 1 2 0 0 0 0 1\n1 99999 2 0 0 0 0 1\n", options).find("a drive:2:"),
            std::string::npos);
  EXPECT_NE(fault_of("1 0 0 5 0 1 0 6 0 0 2 0\n", options).find("rotation"), std::string::npos);
}

TEST(DriveFile, OfASolutionHasThePlaceOfTheBodysCentre) {
  const std::string solution =
      "<?xml version=\"1.0\"?>\n<CommonRoadSolution benchmark_id=\"KS2:SM1:A-1:2020a\">\n"
      "<ksTrajectory planningProblem=\"1\">\n"
      "<ksState><x>1</x><y>2</y><velocity>3</velocity><orientation>0</orientation><time>4</time>"
      "</ksState>\n</ksTrajectory></CommonRoadSolution>";
  EXPECT_NE(fault_of(solution, {}).find("--rate"), std::string::npos);
  const auto row = parse_drive(solution, "a drive", {.rate_hz = 10.0}).points().front();
  EXPECT_NEAR(row.t_s, 0.4, 1e-15);
  EXPECT_NEAR(row.x_m, 1.0 - (0.5 * 4.508 - 0.8312829), 1e-6);
  EXPECT_EQ(row.y_m, 2.0);
  EXPECT_EQ(row.speed_mps, 3.0);
}

TEST(DriveFile, OfAPointMassHasTheSpeedsThatEitherPairOfNamesSays) {
  for (const auto& [along_x, along_y] :
       {std::pair("velocity", "velocityY"), std::pair("xVelocity", "yVelocity")}) {
    const std::string solution = fmt::format(
        "<?xml version=\"1.0\"?>\n<CommonRoadSolution benchmark_id=\"PM2:SM1:A-1:2020a\">\n"
        "<pmTrajectory planningProblem=\"1\">\n"
        "<pmState><x>1</x><y>2</y><{0}>3</{0}><{1}>4</{1}><time>0</time></pmState>\n"
        "<pmState><x>1</x><y>2</y><{0}>0</{0}><{1}>0</{1}><time>1</time></pmState>\n"
        "</pmTrajectory></CommonRoadSolution>",
        along_x, along_y);
    const auto rows = parse_drive(solution, "a drive", {.rate_hz = 10.0}).points();
    EXPECT_NEAR(rows[0].speed_mps, 5.0, 1e-12);
    EXPECT_EQ(rows[1].speed_mps, 0.0);
    for (const auto& row : rows) EXPECT_NEAR(row.heading_rad, std::atan2(4.0, 3.0), 1e-12);
  }
}

std::string point_mass(const std::string& states) {
  return "<?xml version=\"1.0\"?>\n<CommonRoadSolution benchmark_id=\"PM2:SM1:A-1:2020a\">\n"
         "<pmTrajectory planningProblem=\"1\">\n" +
         states + "</pmTrajectory></CommonRoadSolution>";
}

std::string point_mass_state(int step, double y_m, double along_x_mps, double along_y_mps) {
  return fmt::format(
      "<pmState><x>1</x><y>{}</y><xVelocity>{}</xVelocity><yVelocity>{}</yVelocity>"
      "<time>{}</time></pmState>\n",
      y_m, along_x_mps, along_y_mps, step);
}

TEST(DriveFile, OfAPointMassAtRestHeadsWhereItWillGo) {
  const std::string solution =
      point_mass(point_mass_state(0, 5.0, 0.0, 0.0) + point_mass_state(1, 5.0, 0.0, 0.0) +
                 point_mass_state(2, 5.1, 0.0, 1.0) + point_mass_state(3, 5.2, 0.0, 0.0));
  const auto rows = parse_drive(solution, "a drive", {.rate_hz = 10.0}).points();
  ASSERT_EQ(rows.size(), 4u);
  for (const auto& row : rows) EXPECT_NEAR(row.heading_rad, 0.5 * 3.14159265358979, 1e-12);
  EXPECT_NEAR(rows[0].x_m, 1.0, 1e-9);
  EXPECT_NEAR(rows[0].y_m, 5.0 - (0.5 * 4.508 - 0.8312829), 1e-6);
}

TEST(DriveFile, OfAPointMassThatNeverMovesHasNoHeading) {
  const std::string solution =
      point_mass(point_mass_state(0, 5.0, 0.0, 0.0) + point_mass_state(1, 5.0, 0.0, 0.0));
  EXPECT_NE(fault_of(solution, {.rate_hz = 10.0}).find("at rest all along"), std::string::npos);
}

TEST(DriveFile, IsStillATableWhereItIsOne) {
  const std::string table = "t_s,x_m,y_m,heading_rad\n0,1,2,0.5\n";
  EXPECT_EQ(parse_drive(table, "a drive", {}).points().front().heading_rad, 0.5);
}

TEST(DriveFile, SaysThatALogOfAnotherKindIsOne) {
  EXPECT_NE(fault_of("#ROSBAG V2.0\n\x45\0", {}).find("a drive: is a bag of ROS 1, needs"),
            std::string::npos);
  for (const char* start : {"\x89MCAP1\r\n", "\x09MCAP0\r\n", "\x89MCAP0\n\n"}) {
    EXPECT_NE(fault_of(start, {}).find("a drive:byte 0: is MCAP of another version, or damaged"),
              std::string::npos);
  }
  EXPECT_NE(fault_of("x,MCAP\n", {}).find("column t_s"), std::string::npos);
}

/// Along the circle of 20 m, as a camera sees it that sits `seen` in the vehicle: x to the right, y
/// down, z ahead of where it began, 1.6 m above the ground.
std::string circle_as_kitti(const Pose2& seen) {
  std::string text;
  for (int i = 0; i < 50; ++i) {
    const double heading_rad = 0.02 * i;
    const Pose2 axle{20.0 * std::sin(heading_rad), -20.0 * std::cos(heading_rad), heading_rad};
    const Eigen::Vector2d at = axle * Eigen::Vector2d(seen.x_m, seen.y_m);
    const double c = std::cos(heading_rad + seen.heading_rad);
    const double s = std::sin(heading_rad + seen.heading_rad);
    // Its z axis is ahead, (s to the left, c ahead); its x axis is to the right of that.
    text += fmt::format("{} 0 {} {} 0 1 0 -1.6 {} 0 {} {}\n", c, -s, -at.y(), s, c, at.x());
  }
  return text;
}

TEST(DriveFile, OfACameraIsTurnedUpright) {
  for (const Pose2 seen : {Pose2{0, 0, 0}, Pose2{1.08, -0.5, 0.1}}) {
    const auto drive = parse_drive(circle_as_kitti(seen), "a drive",
                                   {.pose_frame = PoseFrame{seen, true}, .rate_hz = 10.0});
    ASSERT_EQ(drive.points().size(), 50u);
    for (int i = 0; i < 50; ++i) {
      const auto& row = drive.points()[static_cast<std::size_t>(i)];
      EXPECT_NEAR(row.x_m, 20.0 * std::sin(0.02 * i), 1e-9);
      EXPECT_NEAR(row.y_m, -20.0 * std::cos(0.02 * i), 1e-9);
      EXPECT_NEAR(row.heading_rad, 0.02 * i, 1e-9);
      EXPECT_NEAR(row.speed_mps, 4.0, 0.01) << i;
    }
  }
}

/// Two steps of a second each, to the side and along z, in TUM's lines.
std::string tum_along_z(double side_m, double along_z_m) {
  return fmt::format("0 0 0 0 0 0 0 1\n1 {0} 0 {1} 0 0 0 1\n2 {2} 0 {3} 0 0 0 1\n", side_m,
                     along_z_m, 2.0 * side_m, 2.0 * along_z_m);
}

TEST(DriveFile, ThatGoesAlongZIsACameras) {
  const DriveOptions upright{.pose_frame = PoseFrame{}}, camera{.pose_frame = PoseFrame{{}, true}};
  const std::string fault = fault_of(tum_along_z(0.1, 5.0), upright);
  EXPECT_NE(fault.find("--pose-frame camera"), std::string::npos) << fault;
  EXPECT_EQ(fault.find('\n'), std::string::npos);
  EXPECT_EQ(fault_of(tum_along_z(0.1, 5.0), camera), "accepted");
  // 0.8 of the way is along z; and what is under 5 m may be noise.
  EXPECT_EQ(fault_of(tum_along_z(3.0, 4.0), upright), "accepted");
  EXPECT_EQ(fault_of(tum_along_z(0.0, 2.4), upright), "accepted");
  EXPECT_NE(fault_of(tum_along_z(0.0, 2.6), upright), "accepted");
}

// As 0.3 degrees the headings would fit a way along x; but a rotation has no unit.
TEST(DriveFile, OfRotationsHasNoHeadingsInDegrees) {
  std::string text;
  for (int i = 0; i < 10; ++i) {
    text += fmt::format("{} {} 0 0 0 0 {} {}\n", i, 2 * i, std::sin(0.15), std::cos(0.15));
  }
  const auto drive = parse_drive(text, "a drive", {.pose_frame = PoseFrame{}});
  EXPECT_NEAR(drive.points().back().heading_rad, 0.3, 1e-12);
  EXPECT_NEAR(drive.points().back().x_m, 18.0, 1e-12);
}

TEST(DriveFile, OfASolutionIsNoCameras) {
  const std::string solution = point_mass(point_mass_state(0, 5.0, 0.0, 1.0));
  EXPECT_NE(
      fault_of(solution, {.pose_frame = PoseFrame{{}, true}, .rate_hz = 10.0}).find("no camera's"),
      std::string::npos);
}

TEST(PoseFrame, TakesACameraOverTheRearAxleOrElsewhere) {
  EXPECT_TRUE(pose_frame("camera", {})->is_camera);
  EXPECT_EQ(pose_frame("camera", {})->pose_in_vehicle.x_m, 0.0);
  const auto offset = pose_frame("camera:1.08,-0.5,0.1", {});
  ASSERT_TRUE(offset);
  EXPECT_TRUE(offset->is_camera);
  EXPECT_EQ(offset->pose_in_vehicle.x_m, 1.08);
  EXPECT_EQ(offset->pose_in_vehicle.y_m, -0.5);
  EXPECT_EQ(offset->pose_in_vehicle.heading_rad, 0.1);
  EXPECT_FALSE(pose_frame("1.08,-0.5", {})->is_camera);
}

/// Straight on at 10 m/s from 0 to 10 s, at these times in tenths of a second; `jump_m` farther
/// from the seventh second on.
DriveOfFile drive_of_log_at(const std::vector<int>& tenths, double jump_m = 0.0) {
  std::vector<tests::McapMessage> messages;
  for (const int i : tenths) {
    const std::int64_t t_ns = 1'700'000'000'000'000'000 + std::int64_t{100'000'000} * i;
    messages.push_back(
        {t_ns, tests::odometry_message(t_ns, i + (i >= 70 ? jump_m : 0.0), 0.0, 0.0, 10.0)});
  }
  const tests::TemporaryFolder folder;
  return read_drive(
      folder.write("a.mcap", tests::mcap_bytes("/odom", "nav_msgs/msg/Odometry", messages, "")),
      {});
}

/// From 0 to 10 s at 10 Hz, without those between two.
std::vector<int> tenths_without(int after, int before) {
  std::vector<int> tenths;
  for (int i = 0; i <= 100; ++i) {
    if (i <= after || i >= before) tenths.push_back(i);
  }
  return tenths;
}

TEST(DriveFile, SaysWhereALogHasNoPose) {
  const DriveOfFile gapped = drive_of_log_at(tenths_without(20, 50));
  ASSERT_EQ(gapped.gaps.size(), 1u);
  EXPECT_NEAR(gapped.gaps[0].from_s, 2.0, 1e-9);
  EXPECT_NEAR(gapped.gaps[0].to_s, 5.0, 1e-9);
  ASSERT_EQ(gapped.notes.size(), 1u);
  EXPECT_EQ(gapped.notes[0].find("1 gap between poses, of 3.000 s after 2.000 s"), 0u)
      << gapped.notes[0];
}

TEST(DriveFile, TakesNoTimeForAGapThatIsShortInItselfOrAmongTheOthers) {
  const DriveOfFile short_ones = drive_of_log_at(tenths_without(20, 25));  // 0.5 s
  EXPECT_TRUE(short_ones.gaps.empty());
  EXPECT_EQ(drive_of_log_at(tenths_without(20, 26)).gaps.size(), 1u);
  const DriveOfFile seldom = drive_of_log_at({0, 10, 20, 30, 80});  // five medians of a second
  EXPECT_TRUE(seldom.gaps.empty() && seldom.notes.empty());
}

TEST(DriveFile, TakesHeadingsOfQuaternionsForRadiansWhateverTheWay) {
  // A body that slides: as degrees -0.48 would fit the way, along 0.02 rad, within 0.03 rad.
  std::vector<tests::McapMessage> messages;
  for (int i = 0; i <= 50; ++i) {
    const std::int64_t t_ns = 1'700'000'000'000'000'000 + std::int64_t{100'000'000} * i;
    messages.push_back({t_ns, tests::odometry_message(t_ns, 1.0 * i, 0.02 * i, -0.48, 10.0)});
  }
  const tests::TemporaryFolder folder;
  const auto log =
      folder.write("a.mcap", tests::mcap_bytes("/odom", "nav_msgs/msg/Odometry", messages, ""));
  EXPECT_NEAR(read_drive(log, {}).drive.points().front().heading_rad, -0.48, 1e-12);
}

TEST(DriveFile, SaysWhichStepsNoCarMakes) {
  EXPECT_TRUE(drive_of_log_at(tenths_without(0, 1), 5.0).notes.empty()) << "6 m in 0.1 s";
  const DriveOfFile jumps = drive_of_log_at(tenths_without(0, 1), 6.0);
  ASSERT_EQ(jumps.notes.size(), 1u);
  EXPECT_EQ(jumps.notes[0].find("1 step of over 60 m/s between poses, 7.000 m in 0.1 s at 7.000 s"),
            0u)
      << jumps.notes[0];
  EXPECT_EQ(notes_text("a.mcap", {"one", "two"}), "note: a.mcap: one\nnote: a.mcap: two\n");
}

TEST(PoseFrame, TakesWordsAndPlaces) {
  EXPECT_EQ(pose_frame("rear-axle", {})->pose_in_vehicle.x_m, 0.0);
  EXPECT_NEAR(pose_frame("centre", {})->pose_in_vehicle.x_m, 0.5 * 4.508 - 0.8312829, 1e-12);
  EXPECT_EQ(pose_frame("1.5,-2,0.25", {})->pose_in_vehicle.heading_rad, 0.25);
  for (const char* words :
       {"", "middle", "1", "1,2,3,4", "1,2,", "nan,0", "camera:", "camera:1", "cameras"}) {
    EXPECT_FALSE(pose_frame(words, {})) << words;
  }
}

TEST(DriveFile, OfArgoverseIsWhatTheLogSays) {
  ROADBED_REAL_DATA_OR_SKIP(real);
  const auto file = real / "argoverse2/argoverse+av2-api/7fab2350/city_SE3_egovehicle.feather";
  const auto drive = read_drive(file, {}).drive;
  // What pyarrow reads.
  EXPECT_EQ(drive.points().size(), 2706u);
  EXPECT_EQ(drive.points().front().x_m, 5172.668216028519);
  EXPECT_EQ(drive.points().back().x_m, 5236.291551457049);
  EXPECT_NEAR(drive.end_s(), 15.949999993, 1e-12);
}

}  // namespace
}  // namespace roadbed::tools
