#include "roadbed/map/files/unpack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "roadbed/tests/support/packed.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;
using Pack = std::string (*)(std::string_view);

constexpr Pack kPacks[] = {tests::gzipped, tests::zstandard};

std::string random_bytes(std::size_t size) {
  std::mt19937 random(20261125);
  std::string bytes;
  while (bytes.size() < size) bytes.push_back(static_cast<char>(random()));
  return bytes;
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

std::vector<std::string> contents() {
  return {"x", "<OpenDRIVE/>\n", random_bytes(100'000), repeated("road ", 600'000), ""};
}

std::string unpack_refusal(const std::string& bytes, std::size_t most = kMostUnpackedBytes) {
  return tests::refusal_of([&] { unpacked(bytes, "map.gz", most); });
}

TEST(Unpack, GivesBackWhatWasPackedAlsoInSeveralMembers) {
  for (const Pack pack : kPacks) {
    std::string all, all_packed;
    for (const std::string& bytes : contents()) {
      const std::string packed = pack(bytes);
      EXPECT_TRUE(is_packed(packed));
      EXPECT_FALSE(is_packed(bytes));
      EXPECT_TRUE(unpacked(packed, "a") == bytes) << bytes.size();
      all += bytes;
      all_packed += packed;
    }
    EXPECT_TRUE(unpacked(all_packed, "all") == all);
  }
}

// Of another packer: the program gzip, which every Debian has.
TEST(Unpack, AgreesWithGzip) {
  const tests::TemporaryFolder folder;
  const std::string bytes = random_bytes(50'000) + repeated("lane,", 50'000);
  const std::string file = folder.write("bytes", bytes);
  ASSERT_EQ(std::system(("gzip -9 < " + file + " > " + file + ".gz").c_str()), 0);
  EXPECT_TRUE(unpacked(tests::bytes_of(file + ".gz"), "bytes.gz") == bytes);
}

TEST(Unpack, RefusesWhatIsCutOffAnywhereOrFollowedBySomething) {
  const std::string bytes = random_bytes(300) + repeated("road ", 100);
  for (const Pack pack : kPacks) {
    const std::string packed = pack(bytes);
    for (std::size_t size = 4; size < packed.size(); ++size) {
      EXPECT_THAT(unpack_refusal(packed.substr(0, size)), HasSubstr("ends within its")) << size;
    }
    EXPECT_THAT(unpack_refusal(packed + "and more"), HasSubstr("cannot be unpacked"));
  }
}

TEST(Unpack, RefusesOrIgnoresAnyChangedBit) {
  const std::string bytes = random_bytes(60) + repeated("road ", 20);
  for (const Pack pack : kPacks) {
    const std::string packed = pack(bytes);
    for (std::size_t bit = 0; bit < 8 * packed.size(); ++bit) {
      std::string changed = packed;
      changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << bit % 8));
      if (!is_packed(changed)) continue;
      if (unpack_refusal(changed) != "accepted") continue;
      EXPECT_EQ(unpacked(changed, "a"), bytes) << bit;
    }
  }
}

TEST(Unpack, RefusesWhatUnpacksToMoreThanTheLimitAndNothingBelow) {
  constexpr std::size_t most = 3'000'000;
  for (const Pack pack : kPacks) {
    EXPECT_EQ(unpack_refusal(pack(std::string(most, '\0')), most), "accepted");
    const std::string packed = pack(std::string(most + 1, '\0'));
    EXPECT_EQ(unpack_refusal(packed, most),
              "map.gz: unpacks to more than 3000000 bytes, needs no more for " +
                  std::to_string(packed.size()) +
                  " packed ones; unpack it to a file first, if it is no bomb");
    EXPECT_THAT(unpack_refusal(repeated(pack(std::string(most / 3, '\0')), 4), most),
                HasSubstr("unpacks to more than"));
  }
}

TEST(Unpack, StartIsThatOfTheWhole) {
  const std::string bytes = repeated("lane and road ", 50'000);
  for (const Pack pack : kPacks) {
    const std::string packed = pack(bytes);
    for (const std::size_t size : {std::size_t{1}, std::size_t{16}, std::size_t{100'000}}) {
      EXPECT_EQ(unpacked_start(packed, size), bytes.substr(0, size));
    }
    EXPECT_EQ(unpacked_start(packed.substr(0, packed.size() / 2), 16), bytes.substr(0, 16));
    EXPECT_EQ(unpacked_start(packed, 10'000'000), bytes);
  }
}

}  // namespace
}  // namespace roadbed::map
