#include "roadbed/tools/batch/input_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/sha256sum.h"

namespace roadbed::tools {
namespace {

constexpr std::uint64_t kMuch = 1ULL << 60;

class InputCacheTest : public testing::Test {
 protected:
  /// The bytes of a file, made whenever they are not kept.
  std::shared_ptr<const std::string> text(const std::string& file) const {
    return cache_->of<std::string>(
        "text", {file}, [&] { return std::make_shared<const std::string>(tests::bytes_of(file)); });
  }

  std::string file(int index) const { return (folder_ / std::to_string(index)).string(); }

  const tests::TemporaryFolder folder_;
  FileHashes hashes_;
  std::atomic<std::uint64_t> resident_ = 0;
  const std::shared_ptr<const InputCache> cache_ =
      std::make_shared<const InputCache>(hashes_, kMuch, [this] { return resident_.load(); });
};

TEST_F(InputCacheTest, GivesTheSameMapAgainAndThatIsTheOneOfTheFile) {
  const auto town = tests::data_folder() / "town.xodr";
  const auto first = cache_->road_map(town), second = cache_->road_map(town);
  EXPECT_EQ(first, second);
  EXPECT_EQ(cache_->made(), 1U);
  EXPECT_EQ(first->lanes().size(), Inputs().road_map(town)->lanes().size());
}

TEST_F(InputCacheTest, TellsKindsOfThingsAndFilesApart) {
  folder_.write("0", "zero");
  folder_.write("1", "one");
  EXPECT_EQ(*text(file(0)), "zero");
  EXPECT_EQ(*text(file(1)), "one");
  const auto size = cache_->of<std::size_t>("size", {file(0)},
                                            [] { return std::make_shared<const std::size_t>(4); });
  EXPECT_EQ(*size, 4U);
  EXPECT_EQ(cache_->made(), 3U);
}

TEST_F(InputCacheTest, MakesAThingAnewOnceItsFileHasChangedAndWhenItIsChangedBack) {
  folder_.write("0", "old");
  EXPECT_EQ(*text(file(0)), "old");
  folder_.write("0", "new and longer");
  EXPECT_EQ(*text(file(0)), "new and longer");
  folder_.write("0", "old");
  EXPECT_EQ(*text(file(0)), "old");
  EXPECT_EQ(cache_->made(), 3U);
}

TEST_F(InputCacheTest, DoesNotKeepWhatAFileHeldWhichChangedWhileItWasRead) {
  folder_.write("0", "old");
  const auto torn = cache_->of<std::string>("text", {file(0)}, [&] {
    folder_.write("0", "new and longer");
    return std::make_shared<const std::string>("torn");
  });
  EXPECT_EQ(*torn, "torn");
  EXPECT_EQ(*text(file(0)), "new and longer");
}

TEST_F(InputCacheTest, ThrowsForEachThatAsksAndKeepsNothing) {
  const auto missing = folder_ / "town.xodr";
  EXPECT_THROW(cache_->road_map(missing), map::InputError);
  EXPECT_THROW(cache_->road_map(missing), map::InputError);
  folder_.write("town.xodr", tests::bytes_of(tests::data_folder() / "town.xodr"));
  EXPECT_GT(cache_->road_map(missing)->lanes().size(), 10U);
}

TEST_F(InputCacheTest, LetsTheLeastRecentlyUsedGoAndNothingThatIsInUse) {
  for (int i = 0; i < 4; ++i) folder_.write(std::to_string(i), std::to_string(i));
  const auto in_use = text(file(0));
  text(file(1));
  text(file(2));
  text(file(1));
  resident_ = 2 * kMuch;  // whatever is let go of, it is too much
  text(file(3));          // all idle ones go
  resident_ = 0;
  const std::size_t made = cache_->made();
  EXPECT_EQ(text(file(0)), in_use);
  EXPECT_EQ(cache_->made(), made);
  text(file(1));
  text(file(2));
  EXPECT_EQ(cache_->made(), made + 2);
}

TEST_F(InputCacheTest, KeepsABoundedNumberOfThings) {
  const int count = static_cast<int>(InputCache::kMost) + 1;
  for (int i = 0; i < count; ++i) folder_.write(std::to_string(i), std::to_string(i));
  for (int i = 0; i < count; ++i) text(file(i));
  text(file(count - 1));
  text(file(1));
  EXPECT_EQ(cache_->made(), static_cast<std::size_t>(count));
  text(file(0));
  EXPECT_EQ(cache_->made(), static_cast<std::size_t>(count) + 1);
}

TEST_F(InputCacheTest, MakesAThingOnceForThreadsThatAskAtTheSameTime) {
  const auto town = tests::data_folder() / "town.xodr";
  std::vector<std::shared_ptr<const map::RoadMap>> maps(8);
  {
    std::vector<std::jthread> threads;
    for (auto& map : maps) threads.emplace_back([&] { map = cache_->road_map(town); });
  }
  EXPECT_EQ(std::set(maps.begin(), maps.end()).size(), 1U);
  EXPECT_EQ(cache_->made(), 1U);
}

TEST(RecentlyUsed, DropsTheOneThatWasUsedLeastRecently) {
  RecentlyUsed<int> values(2);
  values.put("a", 1);
  values.put("b", 2);
  EXPECT_NE(values.find("a"), nullptr);
  values.put("c", 3);
  EXPECT_EQ(values.find("b"), nullptr);
  EXPECT_EQ(*values.find("a"), 1);
  values.put("a", 4);
  EXPECT_EQ(*values.find("a"), 4);
  EXPECT_EQ(values.size(), 2U);
}

TEST(FileHashes, HashOfAFileFollowsItsBytesAndItsStateItsTimeOfChangeToo) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("a", "one");
  const auto time = std::filesystem::last_write_time(file);
  FileHashes hashes;
  for (const std::filesystem::path& path : {file, folder.path()}) {
    const std::string hash = hashes.of(path), state = hashes.state_of(path);
    EXPECT_EQ(hashes.state_of(path), state);
    folder.write("a", "two and more");
    EXPECT_NE(hashes.of(path), hash);
    folder.write("a", "one");
    std::filesystem::last_write_time(file, time + std::chrono::seconds(path == file ? 5 : 9));
    EXPECT_EQ(hashes.of(path), hash);
    EXPECT_NE(hashes.state_of(path), state);
  }
}

TEST(FileHashes, AreWhatSha256sumMakesOfTheBytes) {
  const tests::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "b");
  const std::filesystem::path large = folder.write("b/large", std::string(700'001, 'x'));
  const std::filesystem::path small = folder.write("a", "one");
  FileHashes hashes;
  const std::string of_small = tests::sha256sum_of(small), of_large = tests::sha256sum_of(large);
  EXPECT_EQ(hashes.of(small), of_small);
  EXPECT_EQ(hashes.of(large), of_large);
  const std::string zero(1, '\0');
  EXPECT_EQ(
      hashes.of(folder.path()),
      tests::sha256sum_of_bytes("a" + zero + of_small + "\nb/large" + zero + of_large + "\n"));
}

}  // namespace
}  // namespace roadbed::tools
