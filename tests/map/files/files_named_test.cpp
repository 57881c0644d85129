#include "roadbed/map/files/files_named.h"

#include <gmock/gmock.h>

#include <string>

#include "roadbed/tests/support/program_run.h"

namespace roadbed::map {
namespace {

TEST(FilesNamed, AreThoseThatHoldAndEndSoInTheOrderOfTheirNumbers) {
  const tests::TemporaryFolder folder;
  for (const char* name : {"a_10.json", "a_9.json", "b_7.json", "a_8.txt", "of_a_11.json"}) {
    folder.write(name, "");
  }
  std::vector<std::string> names;
  for (const auto& file : files_named(folder.path(), "a_", ".json")) {
    names.push_back(file.filename().string());
  }
  EXPECT_THAT(names, testing::ElementsAre("a_9.json", "a_10.json", "of_a_11.json"));
  EXPECT_THAT(files_named(folder / "none", "", ""), testing::IsEmpty());
}

}  // namespace
}  // namespace roadbed::map
