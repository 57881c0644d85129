#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/logs/containers.h"
#include "roadbed/map/logs/log.h"
#include "roadbed/map/logs/mcap_writer.h"
#include "roadbed/tests/support/endless_rows.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;

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

// A column before those that are read, of 500 pages, which each of a billion rows leads past.
TEST(Bag, RowsThatSharePagesAreRefused) {
  const std::string bag = tests::database_after(
      "create table topics(id integer primary key, name text, type text, serialization_format "
      "text);"
      "insert into topics values(1, '/a', 'n', 'cdr');"
      "create table messages(id integer primary key, pad blob, topic_id integer, timestamp "
      "integer, data blob);"
      "insert into messages values(1, zeroblob(2000000), 1, 1, x'00')");
  const auto read = [](const std::string& bytes) {
    return tests::refusal_of([&] {
      parse_log(bytes, "a.db3",
                {.wants = [](const LogTopic&) { return true; },
                 .take = [](const LogTopic&, const LogMessage&) {}});
    });
  };
  EXPECT_EQ(read(bag), "accepted");
  EXPECT_THAT(read(tests::with_endless_rows(bag, "messages")), HasSubstr("rows that share pages"));
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
