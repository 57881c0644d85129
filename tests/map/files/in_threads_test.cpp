#include "roadbed/map/files/in_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace roadbed::tests {
namespace {

constexpr std::size_t kCount = 1000;

TEST(InThreads, DoesEachPieceOnceForAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 7, 64}) {
    std::vector<std::atomic<int>> done(kCount);
    map::in_threads(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    for (const auto& times : done) EXPECT_EQ(times, 1) << threads;
  }
}

TEST(InThreads, ThrowsForAnyNumberOfThreadsWhatOneAloneWouldHaveMet) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    for (const int threads : {1, 2, 3, 8}) {
      std::string met = "nothing";
      try {
        map::in_threads(kCount, threads, [](std::size_t i) {
          if (i % 7 == 5) throw std::runtime_error(std::to_string(i));
        });
      } catch (const std::runtime_error& error) {
        met = error.what();
      }
      EXPECT_EQ(met, "5") << threads << " threads";
    }
  }
}

TEST(InThreads, EndsAllThatRunBeforeItThrows) {
  std::atomic<int> running = 0;
  const auto work = [&](std::size_t i) {
    ++running;
    if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    --running;
    if (i == 0) throw std::runtime_error("first");
  };
  EXPECT_THROW(map::in_threads(kCount, 4, work), std::runtime_error);
  EXPECT_EQ(running, 0);
}

TEST(InThreads, MakesWhatAThreadHasForItselfOnceForEach) {
  std::atomic<int> made = 0;
  std::vector<std::atomic<int>> done(kCount);
  const auto make = [&] { return std::make_unique<std::thread::id>((++made, std::thread::id())); };
  map::in_threads(done.size(), 3, make, [&](auto& own, std::size_t i) {
    if (*own == std::thread::id()) *own = std::this_thread::get_id();
    EXPECT_EQ(*own, std::this_thread::get_id());
    ++done[i];
  });
  EXPECT_GE(made, 1);
  EXPECT_LE(made, 3);
  for (const auto& times : done) EXPECT_EQ(times, 1);

  map::in_threads(
      0, 3, [&] { return ++made; }, [](int&, std::size_t) { FAIL(); });
  EXPECT_LE(made, 3) << "there was nothing to do";
  const auto fails = []() -> int { throw std::runtime_error("make"); };
  EXPECT_THROW(map::in_threads(9, 3, fails, [](int&, std::size_t) {}), std::runtime_error);
}

}  // namespace
}  // namespace roadbed::tests
