#include "roadbed/map/storage/output_file.h"

#include <gtest/gtest.h>
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
        write_output(file, new_bytes);
        write_output(file, old_bytes);
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
}

TEST(OutputFile, ThatIsNotCommittedLeavesTheFolderAsItWas) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("map.rbm", "old");
  { OutputFile(file).write(0, "new"); }
  EXPECT_EQ(tests::bytes_of(file), "old");
  const auto files = std::filesystem::directory_iterator(file.parent_path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(OutputFile, MayBeWrittenInAnyOrder) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("map.rbm", "old");
  OutputFile output(file);
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
  write_output(link, "new");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(tests::bytes_of(file), "new");
}

TEST(OutputFile, IsNeverPutInThePlaceOfAPipe) {
  const tests::TemporaryFolder folder;
  const auto pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(map::check_writable(pipe, true), OutputError);
  EXPECT_THROW(write_output(pipe, "bytes"), OutputError);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_EQ(tests::files_below(folder.path()), std::vector<std::string>{});
}

}  // namespace
}  // namespace roadbed::map
