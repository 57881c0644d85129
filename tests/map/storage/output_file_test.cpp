#include "roadbed/map/storage/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"

namespace roadbed::map {
namespace {

TEST(OutputFile, IsTheOldOneOrTheNewOneWheneverTheWriterIsKilled) {
  const tests::TemporaryFolder folder;
  const std::string old_bytes(2'000'000, 'o'), new_bytes(3'000'000, 'n');
  const std::filesystem::path file = folder.write("map.rbm", old_bytes);
  for (int round = 0; round < 40; ++round) {
    const pid_t writer = ::fork();
    ASSERT_GE(writer, 0);
    if (writer == 0) {
      for (;;) {  // until it is killed
        write_output(file, new_bytes, true);
        write_output(file, old_bytes, true);
      }
    }
    ::usleep(static_cast<useconds_t>(500 + 377 * round));
    ::kill(writer, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(writer, &status, 0), writer);
    EXPECT_TRUE(WIFSIGNALED(status));
    const std::string bytes = tests::bytes_of(file);
    ASSERT_TRUE(bytes == old_bytes || bytes == new_bytes) << "round " << round;
  }
  write_output(file, new_bytes, true);
  EXPECT_EQ(tests::files_below(folder.path()), std::vector<std::string>{"map.rbm"});
}

TEST(OutputFile, ThatIsNotCommittedLeavesTheFolderAsItWas) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("map.rbm", "old");
  { OutputFile(file, true).write(0, "new"); }
  EXPECT_EQ(tests::bytes_of(file), "old");
  const auto files = std::filesystem::directory_iterator(file.parent_path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(OutputFile, MayBeWrittenInAnyOrder) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("map.rbm", "old");
  OutputFile output(file, true);
  output.write(4, "body");
  output.write(0, "head");
  output.commit();
  EXPECT_EQ(tests::bytes_of(file), "headbody");
}

TEST(OutputFile, ThroughALinkReplacesWhatItLeadsTo) {
  const tests::TemporaryFolder folder;
  const auto file = folder / "file.txt", link = folder / "link.txt";
  folder.write("file.txt", "old");
  std::filesystem::create_symlink("file.txt", link);
  write_output(link, "new", true);
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(tests::bytes_of(file), "new");
}

TEST(OutputFile, IsNeverPutInThePlaceOfAPipe) {
  const tests::TemporaryFolder folder;
  const auto pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(map::check_writable(pipe, true), OutputError);
  EXPECT_THROW(write_output(pipe, "bytes", true), OutputError);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_EQ(tests::files_below(folder.path()), std::vector<std::string>{});
}

mode_t permissions_of(const std::filesystem::path& file) {
  struct stat status {};
  EXPECT_EQ(::stat(file.c_str(), &status), 0);
  return status.st_mode & 0777;
}

TEST(OutputFile, HasThePermissionsOfWhatItReplaces) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("map.rbm", "old");
  for (const mode_t mode : {0600, 0640, 0444, 0777}) {
    ASSERT_EQ(::chmod(file.c_str(), mode), 0);
    write_output(file, "new", true);
    EXPECT_EQ(permissions_of(file), mode);
  }
}

TEST(OutputFile, HasTheOwnerOfWhatItReplaces) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root may give files away";
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("map.rbm", "old");
  ASSERT_EQ(::chown(file.c_str(), 4321, 8765), 0);
  write_output(file, "new", true);
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, 4321U);
  EXPECT_EQ(status.st_gid, 8765U);
}

TEST(OutputFile, IsNotPutInThePlaceOfWhatOthersMadeMeanwhile) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder / "map.rbm";
  OutputFile output(file, false);
  output.write(0, "ours");
  folder.write("map.rbm", "theirs");
  EXPECT_THROW(output.commit(), OutputError);
  EXPECT_EQ(tests::bytes_of(file), "theirs");
  OutputFile forced(file, true);
  forced.write(0, "ours");
  forced.commit();
  EXPECT_EQ(tests::bytes_of(file), "ours");
}

TEST(OutputFile, IsNotPutInThePlaceOfALinkThatOthersMadeMeanwhile) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path target = folder.write("theirs", "theirs"), file = folder / "map.rbm";
  OutputFile output(file, false);
  output.write(0, "ours");
  std::filesystem::create_symlink(target, file);
  EXPECT_THROW(output.commit(), OutputError);
  EXPECT_EQ(tests::bytes_of(target), "theirs");
}

TEST(OutputFile, IsRefusedWhereItCannotBeLookedAt) {
  const tests::TemporaryFolder folder;
  std::filesystem::create_symlink("nothing", folder / "nowhere");
  std::filesystem::create_symlink("loop", folder / "loop");
  for (const char* name : {"nowhere", "loop"}) {
    EXPECT_THROW(check_writable(folder / name, true), OutputError) << name;
    EXPECT_THROW(write_output(folder / name, "bytes", true), OutputError) << name;
    EXPECT_TRUE(std::filesystem::is_symlink(folder / name));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "nothing"));
}

TEST(OutputFile, IsNotWrittenThroughALinkThatAnotherUserPutIntoASharedFolder) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root may make links of other users";
  const tests::TemporaryFolder mine, shared;
  const std::filesystem::path target = mine.write("precious", "mine"), link = shared / "map.rbm";
  ASSERT_EQ(::chmod(shared.path().c_str(), 01777), 0);
  std::filesystem::create_symlink(target, link);
  ASSERT_EQ(::lchown(link.c_str(), 65534, 65534), 0);
  EXPECT_THROW(check_writable(link, true), OutputError);
  EXPECT_THROW(write_output(link, "bytes", true), OutputError);
  EXPECT_EQ(tests::bytes_of(target), "mine");
}

TEST(OutputFile, RemovesWhatAKilledRunLeftOfItAndNothingThatIsInTheMaking) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder / "map.rbm";
  folder.write(".map.rbm.roadbed-0", "left");
  folder.write(".map.rbm.roadbed-1", "left");
  const int made = ::open(folder.write(".map.rbm.roadbed-2", "made").c_str(), O_RDONLY);
  ASSERT_EQ(::flock(made, LOCK_EX | LOCK_NB), 0);
  folder.write(".other.rbm.roadbed-0", "other");
  write_output(file, "new", false);
  const std::vector<std::string> left{".map.rbm.roadbed-2", ".other.rbm.roadbed-0", "map.rbm"};
  EXPECT_EQ(tests::files_below(folder.path()), left);
  ::close(made);
}

TEST(OutputFile, MayHaveTheLongestName) {
  const tests::TemporaryFolder folder;
  const std::string name(255, 'n');
  write_output(folder / name, "old", false);
  write_output(folder / name, "new", true);
  EXPECT_EQ(tests::bytes_of(folder / name), "new");
}

TEST(OutputFiles, AreAllWrittenBeforeOneIsPutInPlace) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path first = folder.write("first", "old");
  OutputFiles files(true);
  files.add(first, "new");
  EXPECT_THROW(files.add(folder / "missing" / "second", "new"), OutputError);
  EXPECT_EQ(tests::bytes_of(first), "old");
  files.add(folder / "third", "new");
  files.commit();
  EXPECT_EQ(tests::bytes_of(first), "new");
  EXPECT_EQ(tests::bytes_of(folder / "third"), "new");
}

}  // namespace
}  // namespace roadbed::map
