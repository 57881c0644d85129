// Who lets in whom where a lane ends.
#include "roadbed/planning/maneuvers/zip_merge.h"

#include <gtest/gtest.h>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

constexpr std::size_t kEnd = 7;

/// Cars of 4.5 m that drive on, the first one's front so far before the end.
std::vector<ZipBody> queue(double first_m, double spacing_m, double speed_mps) {
  std::vector<ZipBody> cars;
  for (std::size_t i = 0; i < 6; ++i) {
    cars.push_back(
        {std::to_string(i), first_m + spacing_m * static_cast<double>(i), 4.5, speed_mps});
  }
  return cars;
}

TEST(ZipMerge, EachLetsInOneAndNotTwo) {
  ZipMerge zip;
  const std::vector<ZipBody> waiting{{"100", 5.0, 4.5, 0.0}, {"101", 12.0, 4.5, 0.0}};
  zip.update(kEnd, queue(12.0, 10.0, 1.0), waiting);
  EXPECT_EQ(zip.let_in(kEnd, "0"), "100");  // 2.5 m behind it
  EXPECT_EQ(zip.let_in(kEnd, "1"), "101");
  for (std::size_t other = 2; other < 6; ++other)
    EXPECT_FALSE(zip.let_in(kEnd, std::to_string(other)));
  zip.update(kEnd, queue(12.0, 10.0, 1.0), {{"102", 5.0, 4.5, 0.0}});  // both are in
  EXPECT_EQ(zip.let_in(kEnd, "0"), "100");
  EXPECT_EQ(zip.let_in(kEnd, "2"), "102");
  EXPECT_FALSE(zip.let_in(kEnd + 1, "0"));  // another end
}

TEST(ZipMerge, WhoWouldHaveToBrakeHarderThan2MetresPerSecondSquaredDrivesOn) {
  for (const double speed_mps : {4.0, 8.0, 12.0}) {
    ZipMerge zip;
    const double needed_m = speed_mps * speed_mps / (2.0 * 2.0);
    std::vector<ZipBody> cars = queue(9.5 + needed_m - 0.1, 50.0, speed_mps);
    zip.update(kEnd, cars, {{"100", 5.0, 4.5, 0.0}});
    EXPECT_FALSE(zip.let_in(kEnd, "0"));
    EXPECT_EQ(zip.let_in(kEnd, "1"), "100");
    ZipMerge farther;
    cars = queue(9.5 + needed_m + 0.1, 50.0, speed_mps);
    farther.update(kEnd, cars, {{"100", 5.0, 4.5, 0.0}});
    EXPECT_EQ(farther.let_in(kEnd, "0"), "100");
  }
}

TEST(ZipMerge, WhoDoesNotGoIsNotWaitedForLongerThan8Seconds) {
  ZipMerge zip;
  for (int step = 0; step < 70; ++step)
    zip.update(kEnd, queue(12.0, 10.0, 0.0), {{"100", 5.0, 4.5}});
  EXPECT_TRUE(zip.let_in(kEnd, "0"));
  for (int step = 0; step < 20; ++step)
    zip.update(kEnd, queue(12.0, 10.0, 0.0), {{"100", 5.0, 4.5}});
  EXPECT_FALSE(zip.let_in(kEnd, "0"));
}

TEST(ZipMerge, LaneEndsAreThoseBesideALaneThatGoesOn) {
  const auto ends = lane_ends(map::load_map(tests::data_folder() / "ramp.xodr"));
  ASSERT_EQ(ends.size(), 1U);  // not the road's end, nor the ramp's
  EXPECT_NEAR(ends[0].x_m, 660.0, 1e-6);
  EXPECT_NEAR(ends[0].y_m, -5.25, 1e-6);
}

}  // namespace
}  // namespace roadbed::planning
