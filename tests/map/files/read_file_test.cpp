#include "roadbed/map/files/read_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/sha256.h"
#include "roadbed/map/gis/write.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/packed.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;
using tests::TemporaryFolder;

/// A named pipe that somebody writes to once.
class WrittenPipe {
 public:
  WrittenPipe(std::string file, std::string bytes) : file_(std::move(file)) {
    if (::mkfifo(file_.c_str(), 0600) != 0) throw std::runtime_error("mkfifo failed");
    writer_ = std::thread(
        [this, bytes = std::move(bytes)] { std::ofstream(file_, std::ios::binary) << bytes; });
  }
  ~WrittenPipe() { writer_.join(); }
  WrittenPipe(const WrittenPipe&) = delete;
  WrittenPipe& operator=(const WrittenPipe&) = delete;

 private:
  std::string file_;
  std::thread writer_;
};

std::string refusal_of(const std::filesystem::path& file) {
  return tests::refusal_of([&] { read_file(file); });
}

std::string town() { return tests::bytes_of(tests::data_folder() / "town.xodr"); }

TEST(ReadFile, GivesWhatIsPackedUnpackedAndHashesTheFilesOwnBytes) {
  const TemporaryFolder folder;
  const std::string bytes = town();
  for (const std::string& packed : {tests::gzipped(bytes), tests::zstandard(bytes)}) {
    const std::string file = folder.write("town.xodr", packed);  // told by content
    EXPECT_TRUE(read_file(file) == bytes);
    EXPECT_EQ(read_file_start(file, 100'000), bytes.substr(0, 100'000));
    EXPECT_EQ(stored_start(file, 16), packed.substr(0, 16));
    EXPECT_EQ(sha256_of_file(file), sha256_of_bytes(packed));
    EXPECT_EQ(format_of(std::filesystem::path(file))->name, "OpenDRIVE");
    EXPECT_TRUE(write_csv(load_map(file)) == write_csv(parse_map(bytes, "town.xodr")));
  }
  EXPECT_THAT(refusal_of(folder.write("none.gz", tests::gzipped(""))),
              HasSubstr("is empty when unpacked"));
}

TEST(ReadFile, KeepsWhatAPipeGave) {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe", bytes = town();
  const std::string packed = tests::gzipped(bytes);
  const WrittenPipe written(pipe, packed);
  ASSERT_TRUE(is_stream(pipe));
  EXPECT_EQ(read_file_start(pipe, 20), bytes.substr(0, 20));
  EXPECT_EQ(stored_start(pipe, 20), "");
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(read_file(pipe) == bytes);
  EXPECT_EQ(stream_sha256(pipe), sha256_of_bytes(packed));
  EXPECT_EQ(load_map(pipe).lanes().size(), parse_map(bytes, "town").lanes().size());
}

TEST(ReadFile, OfAPipeIsNoHashThatAnybodyCouldCheck) {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);  // nobody writes: it is not even opened
  try {
    sha256_of_file(pipe);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              pipe +
                  ": is a stream, whose bytes cannot be hashed again later, needs a file; write "
                  "it to a file first");
  }
}

TEST(ReadFile, LoadsACompiledMapPieceByPieceOnlyFromAPlainFile) {
  const TemporaryFolder folder;
  const std::string bytes = write_compiled_map(parse_map(town(), "town.xodr"));
  const RoadMap plain = load_map(folder.write("town.rbm", bytes));
  const RoadMap packed = load_map(folder.write("town.rbm.zst", tests::zstandard(bytes)));
  const WrittenPipe written(folder / "pipe", bytes);
  const RoadMap piped = load_map(folder / "pipe");
  EXPECT_LT(loaded_chunks(plain).loaded, loaded_chunks(plain).of);
  const std::string lines = write_csv(plain);
  EXPECT_TRUE(write_csv(packed) == lines);
  EXPECT_TRUE(write_csv(piped) == lines);
}

TEST(ReadFile, RefusesDevicesFoldersAndWhatIsMissingOrEmpty) {
  const TemporaryFolder folder;
  EXPECT_EQ(refusal_of("/dev/zero"),
            "/dev/zero: is a device; name a file, or - for standard input");
  EXPECT_THAT(refusal_of(folder.path()), HasSubstr("is a folder"));
  EXPECT_THAT(refusal_of(folder / "no"), HasSubstr("no such file"));
  EXPECT_THAT(refusal_of(folder.write("none", "")), HasSubstr("is empty"));
}

TEST(ReadFile, SuffixOfAnInputLeavesOutHowItIsPacked) {
  EXPECT_EQ(suffix_of_input("a/scan.xyz"), ".xyz");
  EXPECT_EQ(suffix_of_input("a/scan.xyz.gz"), ".xyz");
  EXPECT_EQ(suffix_of_input("scan.b.pts.zst"), ".pts");
  EXPECT_EQ(suffix_of_input("-"), "");
}

}  // namespace
}  // namespace roadbed::map
