#include "roadbed/map/storage/output_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/map/storage/output_file.h"
#include "roadbed/tests/support/program_run.h"

namespace roadbed::map {
namespace {

namespace fs = std::filesystem;

constexpr int kFiles = 5;

void write_all(const fs::path& place, const std::string& bytes, bool force) {
  OutputFolder folder(place, {.force = force});
  for (int i = 0; i < kFiles; ++i) folder.write(std::to_string(i), bytes);
  folder.commit();
}

std::string all_bytes(const fs::path& place) {
  std::string all;
  for (const std::string& file : tests::files_below(place)) all += tests::bytes_of(place / file);
  return all;
}

TEST(OutputFolder, IsTheOldOneOrTheNewOneWheneverTheWriterIsKilled) {
  const tests::TemporaryFolder around;
  const fs::path place = around / "drive";
  write_all(place, "old", false);
  const std::string old_bytes = all_bytes(place), new_bytes = "newnewnewnewnew";
  for (int round = 0; round < 60; ++round) {
    const pid_t writer = ::fork();
    ASSERT_GE(writer, 0);
    if (writer == 0) {
      for (;;) {  // until it is killed
        write_all(place, "new", true);
        write_all(place, "old", true);
      }
    }
    ::usleep(static_cast<useconds_t>(500 + 377 * round));
    ::kill(writer, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(writer, &status, 0), writer);
    EXPECT_TRUE(WIFSIGNALED(status));
    const std::string bytes = all_bytes(place);
    ASSERT_TRUE(bytes == old_bytes || bytes == new_bytes) << "round " << round << ": " << bytes;
  }
  write_all(place, "new", true);
  EXPECT_EQ(tests::files_below(around.path()).size(), static_cast<std::size_t>(kFiles));
}

// Each under a hidden name of its own, none taken for what a killed one left.
TEST(OutputFolder, IsWholeWhereManyWriteItAtOnce) {
  const tests::TemporaryFolder around;
  const fs::path place = around / "drive";
  std::vector<pid_t> writers;
  for (const char letter : {'a', 'b', 'c', 'd', 'e', 'f'}) {
    const pid_t writer = ::fork();
    ASSERT_GE(writer, 0);
    if (writer == 0) {
      try {
        for (int round = 0; round < 40; ++round) write_all(place, std::string(1, letter), true);
      } catch (const OutputError& error) {
        std::fprintf(stderr, "%s\n", error.what());
        ::_exit(1);
      }
      ::_exit(0);
    }
    writers.push_back(writer);
  }
  for (const pid_t writer : writers) {
    int status = 0;
    ASSERT_EQ(::waitpid(writer, &status, 0), writer);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  const std::string bytes = all_bytes(place);
  EXPECT_EQ(bytes, std::string(kFiles, bytes[0]));
  write_all(place, "z", true);
  EXPECT_EQ(tests::files_below(around.path()).size(), static_cast<std::size_t>(kFiles));
}

TEST(OutputFolder, LeavesNothingWithoutCommit) {
  const tests::TemporaryFolder around;
  { OutputFolder(around / "made/for/it/drive").write("a", "bytes"); }
  EXPECT_TRUE(fs::is_empty(around.path()));
}

TEST(OutputFolder, KeepsWhatElseTheUserHasInIt) {
  const tests::TemporaryFolder around;
  const fs::path place = around / "drive";
  write_all(place, "old", false);
  around.write("drive/notes.txt", "mine");
  around.write("drive/solution.xml", "of the old drive");
  fs::create_directories(place / "deep/er");
  around.write("drive/deep/er/file", "mine too");
  OutputFolder folder(place, {.force = true, .is_dropped = [](const std::string& name) {
                                return name == "solution.xml";
                              }});
  folder.write("0", "new");
  folder.commit();
  EXPECT_EQ(tests::bytes_of(place / "notes.txt"), "mine");
  EXPECT_EQ(tests::bytes_of(place / "deep/er/file"), "mine too");
  EXPECT_EQ(tests::bytes_of(place / "0"), "new");
  EXPECT_EQ(tests::bytes_of(place / "1"), "old");
  EXPECT_FALSE(fs::exists(place / "solution.xml"));
}

TEST(OutputFolder, OfTheCurrentFolderStaysTheSameFolder) {
  const tests::TemporaryFolder around;
  const fs::path place = around / "drive", before = fs::current_path();
  write_all(place, "old", false);
  around.write("drive/notes.txt", "mine");
  struct stat old {
  }, now{};
  ASSERT_EQ(::stat(place.c_str(), &old), 0);
  fs::current_path(place);
  write_all(".", "new", true);
  fs::current_path(before);
  ASSERT_EQ(::stat(place.c_str(), &now), 0);
  EXPECT_EQ(now.st_ino, old.st_ino);
  EXPECT_EQ(tests::files_below(place).size(), kFiles + 1U);
  EXPECT_EQ(tests::bytes_of(place / "3"), "new");
}

TEST(OutputFolder, HasThePermissionsOfWhatItReplaces) {
  const tests::TemporaryFolder around;
  const fs::path place = around / "drive";
  write_all(place, "old", false);
  ASSERT_EQ(::chmod(place.c_str(), 0750), 0);
  ASSERT_EQ(::chmod((place / "2").c_str(), 0600), 0);
  write_all(place, "new", true);
  struct stat status {};
  ASSERT_EQ(::stat(place.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0750U);
  ASSERT_EQ(::stat((place / "2").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
}

TEST(OutputFolder, IsNotPutInThePlaceOfWhatOthersMadeMeanwhile) {
  const tests::TemporaryFolder around;
  for (const bool was_there : {false, true}) {
    const fs::path place = around / (was_there ? "a" : "b");
    if (was_there) fs::create_directory(place);
    OutputFolder folder(place);
    folder.write("0", "ours");
    fs::create_directory(place);
    write_output(place / "0", "theirs", false);
    EXPECT_THROW(folder.commit(), OutputError);
    EXPECT_EQ(tests::bytes_of(place / "0"), "theirs");
  }
}

TEST(OutputFolder, ReplacesNothingWhereAFolderHasTheNameOfAFile) {
  const tests::TemporaryFolder around;
  const fs::path place = around / "drive";
  write_all(place, "old", false);
  fs::remove(place / "4");
  fs::create_directory(place / "4");
  EXPECT_THROW(write_all(place, "new", true), OutputError);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(tests::bytes_of(place / std::to_string(i)), "old");
}

TEST(OutputFolder, NeverReplacesAnInput) {
  const tests::TemporaryFolder around;
  const fs::path place = around / "drive";
  write_all(place, "old", false);
  OutputFolder folder(place, {.force = true, .inputs = {place / "../drive/0"}});
  folder.write("0", "new");
  EXPECT_THROW(folder.commit(), OutputError);
  EXPECT_EQ(tests::bytes_of(place / "0"), "old");
}

TEST(OutputFolder, IsRefusedWhereItHoldsFilesOrIsNone) {
  const tests::TemporaryFolder around;
  const fs::path place = around / "drive";
  write_all(place, "old", false);
  EXPECT_THROW(OutputFolder{place}, OutputError);
  EXPECT_THROW(OutputFolder(place / "0", {.force = true}), OutputError);
  fs::create_symlink("nowhere", around / "link");
  EXPECT_THROW(OutputFolder(around / "link", {.force = true}), OutputError);
}

}  // namespace
}  // namespace roadbed::map
