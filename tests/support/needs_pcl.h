#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "roadbed/tests/support/program_run.h"

namespace roadbed::tests {

/// A test that is skipped where roadbed was built without PCL.
class NeedsPcl : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(program_file().parent_path() / "../lib/libroadbed_pcl.so")) {
      GTEST_SKIP() << "built without PCL";
    }
  }
};

}  // namespace roadbed::tests
