#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {

/// A post at (10.05, 1.05), one cell of 0.1 m wide, from the ground to 2 m; farther off two from
/// there to 2.5 m, so that those heights were looked at.
inline std::string post_pcd() {
  std::string points;
  int count = 0;
  for (double z = 0.05; z < 2.0; z += 0.05, ++count) {
    points += "10.05 1.05 " + std::to_string(z) + "\n";
  }
  for (double z = 2.05; z < 2.5; z += 0.05, count += 2) {
    points += "8.05 4.05 " + std::to_string(z) + "\n16.05 4.05 " + std::to_string(z) + "\n";
  }
  const std::string number = std::to_string(count);
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + number +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + number + "\nDATA ascii\n" + points;
}

inline std::string along_x_csv(double y) {
  return "t_s,x_m,y_m,heading_rad\n0,0," + std::to_string(y) + ",0\n10,20," + std::to_string(y) +
         ",0\n";
}

/// Drives that hit the post, pass near it and far from it, and one that cannot be read.
class AuditCommand : public testing::Test {
 protected:
  void SetUp() override {
    const std::string cloud = folder_.write("post.pcd", post_pcd());
    ASSERT_EQ(run_roadbed({"occupancy", "build", cloud, "-o", octree_, "--quiet"}).status, 0);
    std::filesystem::create_directories(folder_ / "drives/far/deeper");
    folder_.write("drives/hit.csv", along_x_csv(1.0));
    folder_.write("drives/near.csv", along_x_csv(0.0));
    folder_.write("drives/far/deeper/trajectory.csv", along_x_csv(-3.0));
    folder_.write("drives/far/deeper/other.csv", "not a drive");
    folder_.write("drives/broken.csv", "t_s,x_m\n0,1\n");
  }

  ProgramRun audit(std::vector<std::string> more) const {
    more.insert(more.begin(), {"audit", "--occupancy", octree_, "--unknown", "free"});
    return run_roadbed(more);
  }

  TemporaryFolder folder_;
  std::string octree_ = folder_ / "post.bt", drives_ = folder_ / "drives";
};

}  // namespace roadbed::tests
