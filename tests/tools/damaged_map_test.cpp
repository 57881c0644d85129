// Many routes at once in a compiled map whose bytes have changed: refused in one line, by whichever
// thread meets it.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/reseal.h"

namespace roadbed::tests {
namespace {

class DamagedMap : public testing::Test {
 protected:
  void SetUp() override {
    const std::string compiled = folder_ / "town.rbm";
    const std::string source = (data_folder() / "town.xodr").string();
    const ProgramRun import = run_roadbed({"import", source, "-o", compiled});
    ASSERT_EQ(import.status, 0) << import.err;
    whole_ = bytes_of(compiled);
    pairs_ = folder_.write("pairs.csv",
                           "from,to\n"
                           "lane:1/0/-1@10,lane:7/0/1@55\n"
                           "lane:7/0/1@55,lane:1/0/-1@10\n"
                           "lane:1/3/1@6,lane:1/3/1@60\n"
                           "lane:1/0/-1@10,lane:1/3/1@60\n");
    ASSERT_EQ(routes(compiled, 2).status, 0);
  }

  ProgramRun routes(const std::string& map, int threads) const {
    return run_roadbed({"route", map, "--batch", pairs_, "--threads", std::to_string(threads)});
  }

  /// The map with a bit flipped somewhere in the given one of so many equal pieces.
  std::string with_flip(std::size_t piece, std::size_t pieces) {
    const std::size_t from = whole_.size() * piece / pieces;
    const std::size_t size = whole_.size() * (piece + 1) / pieces - from;
    std::string bytes = whole_;
    char& byte = bytes[from + random_() % size];
    byte = static_cast<char>(byte ^ (1 << random_() % 8));
    return bytes;
  }

  /// Returns whether the map was refused.
  bool is_refused_or_used(const std::string& bytes) {
    const std::string map = folder_.write("damaged.rbm", bytes);
    const ProgramRun run = routes(map, 2), alone = routes(map, 1);
    EXPECT_TRUE(run.status <= 1 || run.status == 3) << run.err;
    EXPECT_EQ(run.err, alone.err);
    EXPECT_EQ(run.out, alone.out);
    if (run.status == 0 || !run.out.empty()) return false;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    EXPECT_TRUE(run.err.starts_with("roadbed: ")) << run.err;
    return true;
  }

  TemporaryFolder folder_;
  std::string whole_, pairs_;
  std::mt19937 random_{20270114};
};

TEST_F(DamagedMap, IsRefusedByManyRoutesInOneLineForAnyNumberOfThreads) {
  constexpr std::size_t pieces = 60;
  int refused = 0;
  for (std::size_t i = 0; i < pieces; ++i) refused += is_refused_or_used(with_flip(i, pieces));
  EXPECT_GT(refused, 20);
}

TEST_F(DamagedMap, WithRightChecksumsIsRefusedOrUsedByManyRoutes) {
  constexpr std::size_t pieces = 40;
  for (std::size_t i = 0; i < pieces; ++i) {
    std::string bytes = with_flip(i, pieces);
    reseal(bytes);
    is_refused_or_used(bytes);
  }
}

}  // namespace
}  // namespace roadbed::tests
