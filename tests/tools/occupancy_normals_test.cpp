// `occupancy export --normals` as a user runs it.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/Core>
#include <cstring>
#include <string>
#include <vector>

#include "roadbed/map/occupancy/clouds/read_point_cloud.h"
#include "roadbed/tests/support/needs_pcl.h"
#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;

class OccupancyNormals : public NeedsPcl {
 protected:
  // z = 0.3 x - 0.1 y + 5
  std::string plane() const {
    std::string text;
    for (int x = 0; x < 20; ++x) {
      for (int y = 0; y < 20; ++y) {
        const double x_m = 0.25 * x, y_m = 0.25 * y;
        text += fmt::format("{} {} {}\n", x_m, y_m, 0.3 * x_m - 0.1 * y_m + 5.0);
      }
    }
    return folder_.write("plane.xyz", text);
  }

  ProgramRun exported(const std::string& input, const std::string& output) const {
    return run_roadbed({"occupancy", "export", input, "--normals", "9", "-o", output, "--force"});
  }

  // x y z nx ny nz of each point, behind a header's last line.
  static std::vector<std::array<float, 6>> rows(const std::string& file, const char* last_line) {
    const std::string bytes = bytes_of(file);
    const std::size_t start = bytes.find(last_line) + std::strlen(last_line);
    std::vector<std::array<float, 6>> rows((bytes.size() - start) / sizeof(float) / 6);
    std::memcpy(rows.data(), bytes.data() + start, rows.size() * sizeof(rows[0]));
    return rows;
  }

  const TemporaryFolder folder_;
};

TEST_F(OccupancyNormals, OfAPlaneAreThePlanesTurnedUpwards) {
  const Eigen::Vector3f truth = Eigen::Vector3f(-0.3f, 0.1f, 1.0f).normalized();
  for (const auto& [name, last_line] :
       {std::pair("out.ply", "end_header\n"), std::pair("out.pcd", "DATA binary\n")}) {
    const std::string output = folder_ / name;
    ASSERT_EQ(exported(plane(), output).status, 0);
    const auto found = rows(output, last_line);
    ASSERT_EQ(found.size(), 400u);
    for (const auto& row : found) {
      EXPECT_NEAR(row[2], 0.3f * row[0] - 0.1f * row[1] + 5.0f, 1e-5f);
      EXPECT_LT((Eigen::Vector3f(row[3], row[4], row[5]) - truth).norm(), 1e-3f);
    }
  }
  EXPECT_EQ(map::read_point_cloud(folder_ / "out.pcd").points.size(), 400u);
  EXPECT_EQ(map::read_point_cloud(folder_ / "out.ply").points.size(), 400u);
}

TEST_F(OccupancyNormals, OfALevelOctreeLookUp) {
  std::string text;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y)
      text += fmt::format("{} {} 0.55\n", 0.1 * x + 0.05, 0.1 * y + 0.05);
  }
  const std::string octree = folder_ / "level.bt", output = folder_ / "level.ply";
  ASSERT_EQ(
      run_roadbed({"occupancy", "build", folder_.write("level.xyz", text), "-o", octree, "-q"})
          .status,
      0);
  ASSERT_EQ(exported(octree, output).status, 0);
  const auto found = rows(output, "end_header\n");
  ASSERT_EQ(found.size(), 400u);
  for (const auto& row : found) EXPECT_NEAR(row[5], 1.0f, 1e-5f);
}

TEST_F(OccupancyNormals, AreOfPointsOnly) {
  const ProgramRun run =
      run_roadbed({"occupancy", "export", plane(), "--normals", "9", "-o", folder_ / "out.pgm"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, HasSubstr("--normals are for points"));
  EXPECT_EQ(run_roadbed({"occupancy", "export", plane(), "-o", folder_ / "out.pgm"}).status, 3);
}

}  // namespace
}  // namespace roadbed::tests
