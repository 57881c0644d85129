#include "roadbed/map/occupancy/laz/laz_points.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/map/occupancy/laz/point_steps.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kPoints = 300;
constexpr double kScale_m = 0.001;

/// Of tests/peers/check_laz.py, which laspy and LASzip packed.
PointSteps formula(std::int64_t i) {
  return {static_cast<std::int32_t>(37 * i - i * i % 101),
          static_cast<std::int32_t>(5000 - 11 * i + i % 7 * 13),
          static_cast<std::int32_t>(i * i * i % 997 - (i % 50 == 0 ? 200'000 : 0))};
}

std::string packed(int format, const char* kind = "format") {
  return tests::bytes_of(tests::tests_folder() / "map/occupancy/laz" /
                         fmt::format("{}_{}.laz", kind, format));
}

void expect_formula(const PointCloud& cloud) {
  ASSERT_EQ(cloud.points.size(), kPoints);
  for (std::int64_t i = 0; i < kPoints; ++i) {
    const PointSteps steps = formula(i);
    const Eigen::Vector3d expected(steps[0], steps[1], steps[2]);
    const Eigen::Vector3d found = cloud.in_source(static_cast<std::size_t>(i));
    // Points are floats: 200 m to 2⁻²⁴ of it.
    EXPECT_LT((found - kScale_m * expected).cwiseAbs().maxCoeff(), 2e-5) << "point " << i;
  }
}

std::string refusal(const std::string& bytes) {
  return tests::refusal_of([&] { parse_point_cloud(bytes, "a.laz"); });
}

class LazFormats : public testing::TestWithParam<int> {};

TEST_P(LazFormats, AreUnpackedToEachPoint) {
  expect_formula(parse_point_cloud(packed(GetParam()), "a.laz"));
}

TEST_P(LazFormats, AreRefusedWhereTheyEnd) {
  const std::string bytes = packed(GetParam());
  const auto table = bytes.size() - 20;  // of chunks, which nobody needs
  for (std::size_t size = 0; size < table; size += 97) {
    EXPECT_NE(refusal(bytes.substr(0, size)), "accepted") << size;
  }
}

INSTANTIATE_TEST_SUITE_P(Points, LazFormats, testing::Values(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10));

/// Of 70 points, the last one of 20; two at a time are decoded in turn.
class LazChunks : public testing::TestWithParam<int> {};

TEST_P(LazChunks, AreUnpackedToEachPoint) {
  expect_formula(parse_point_cloud(packed(GetParam(), "chunks"), "a.laz"));
}

TEST_P(LazChunks, AreRefusedWhereTheyEnd) {
  const std::string bytes = packed(GetParam(), "chunks");
  const auto table = integer_at<std::uint64_t>(bytes, integer_at<std::uint32_t>(bytes, 96));
  for (std::size_t size = 0; size < table; size += 97) {
    EXPECT_NE(refusal(bytes.substr(0, size)), "accepted") << size;
  }
}

TEST_P(LazChunks, AreFoundWhereTheyAreWhateverTheirTableSays) {
  const std::string bytes = packed(GetParam(), "chunks");
  const std::size_t place = integer_at<std::uint32_t>(bytes, 96);
  const auto table = integer_at<std::uint64_t>(bytes, place);
  std::mt19937 random(26);
  for (int i = 0; i < 200; ++i) {
    std::string wrong = bytes;
    const std::size_t at =
        i % 4 == 0 ? place + random() % 8 : table + random() % (wrong.size() - table);
    wrong[at] = static_cast<char>(random() & 0xffu);
    expect_formula(parse_point_cloud(wrong, "a.laz"));
  }
}

INSTANTIATE_TEST_SUITE_P(Points, LazChunks, testing::Values(1, 3, 7));

TEST(Laz, RefusesMorePointsThanItsBytesCanHold) {
  std::string bytes = packed(3);
  ASSERT_GT(bytes.size(), 200u);
  const std::uint32_t many = 4'000'000'000u;
  for (std::size_t i = 0; i < 4; ++i) bytes[107 + i] = static_cast<char>(many >> 8 * i);
  EXPECT_THAT(refusal(bytes), HasSubstr("4000000000 in"));
}

/// An endless chunk table in a few bytes: zeros are the likeliest sizes, soon for next to no bits.
TEST(Laz, TakesNoMoreOfATableThanItsPointsHaveChunks) {
  std::string bytes = packed(3, "chunks");
  const std::size_t place = integer_at<std::uint32_t>(bytes, 96);
  const std::size_t table = bytes.size();
  for (std::size_t i = 0; i < 8; ++i) bytes[place + i] = static_cast<char>(table >> 8 * i);
  bytes += std::string(4, '\0') + std::string(4, '\xff') + std::string(100'000, '\0');
  expect_formula(parse_point_cloud(bytes, "a.laz"));
}

/// Times that switch between sequences for ever: each bit of a megabyte is thousands of switches.
TEST(Laz, RefusesTimesThatNeverEnd) {
  std::string bytes = packed(1);
  bytes.resize(integer_at<std::uint32_t>(bytes, 96) + 8 + 28);  // with the first point
  EXPECT_THAT(refusal(bytes + std::string(1'000'000, '\xff')), HasSubstr("breaks off 299 points"));
}

TEST(Laz, RefusesWhatLaszipDoesNotKnow) {
  const std::string bytes = packed(0);
  const std::size_t record = bytes.find("laszip encoded") - 2 + 54;
  for (const auto& [offset, value] : {std::pair{0, 9}, {2, 1}, {32, 77}, {36, 21}, {38, 3}}) {
    std::string wrong = bytes;
    wrong[record + static_cast<std::size_t>(offset)] = static_cast<char>(value);
    EXPECT_THAT(refusal(wrong), HasSubstr("laszip encoded")) << offset;
  }
}

TEST(Laz, OfOneCloudInFourPackingsIsOneCloud) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const PointCloud plain = read_point_cloud(folder / "occupancy/libLAS+libLAS/1.2-with-color.las");
  for (const char* file :
       {"simple.laz", "laszip-generated.laz", "simple-laszip-compressor-version-1.2r0.laz"}) {
    const PointCloud cloud = read_point_cloud(folder / "occupancy/PDAL+PDAL" / file);
    EXPECT_EQ(cloud.points, plain.points) << file;
    EXPECT_EQ(cloud.origin_in_source, plain.origin_in_source) << file;
  }
  // COPC orders them anew.
  const PointCloud copc = read_point_cloud(folder / "occupancy/PDAL+PDAL/1.2-with-color.copc.laz");
  const auto places = [](const PointCloud& cloud) {
    std::multiset<std::array<double, 3>> all;
    for (const auto& point : cloud.points) {
      const Eigen::Vector3d at = point.cast<double>() + cloud.origin_in_source;
      all.insert({std::round(100 * at.x()), std::round(100 * at.y()), std::round(100 * at.z())});
    }
    return all;
  };
  EXPECT_EQ(places(copc), places(plain));
}

}  // namespace
}  // namespace roadbed::map
