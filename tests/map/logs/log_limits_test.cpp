#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/logs/containers.h"
#include "roadbed/map/logs/log.h"
#include "roadbed/map/logs/mcap_writer.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

// Each of 65,536 channels may keep the name of one schema.
TEST(Mcap, NamesOfMoreThan512BytesAreRefused) {
  const auto read = [](std::size_t bytes) {
    McapWriter writer("a test");
    const std::uint16_t topic =
        writer.add_topic({"/a", std::string(bytes, 'n'), "cdr"}, {"ros2msg", ""});
    writer.write(topic, 1, "x");
    return tests::refusal_of([&] {
      parse_log(writer.finish(), "a.mcap",
                {.wants = [](const LogTopic&) { return true; },
                 .take = [](const LogTopic&, const LogMessage&) {}});
    });
  };
  EXPECT_EQ(read(512), "accepted");
  EXPECT_NE(read(513).find("a name of 513 bytes, needs at most 512"), std::string::npos)
      << read(513);
}

TEST(BagFolder, NamesEachFileOnce) {
  const auto read = [](const std::string& files) {
    return tests::refusal_of([&] { files_in_metadata("relative_file_paths:\n" + files, "bag"); });
  };
  EXPECT_EQ(read("- a.db3\n- b.db3\n"), "accepted");
  EXPECT_NE(read("- a.db3\n- b.db3\n- \"a.db3\"\n").find("\"a.db3\" again"), std::string::npos);
}

}  // namespace
}  // namespace roadbed::map
