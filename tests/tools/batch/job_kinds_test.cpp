#include "roadbed/tools/batch/job_kinds.h"
#include "roadbed/tools/commands/commands.h"

#include <gtest/gtest.h>

namespace roadbed::tests {
namespace {

using tools::ArgumentInfo;

TEST(JobKinds, EveryPathOfEveryKindIsDeclaredAsReadOrWritten) {
  const tools::JobKinds& kinds = tools::job_kinds();
  ASSERT_EQ(kinds.all().size(), 5U);
  for (const tools::JobKind& kind : kinds.all()) {
    for (const ArgumentInfo& argument : kind.arguments) {
      const bool is_path = argument.kind == ArgumentInfo::Kind::path;
      EXPECT_EQ(is_path, argument.use != ArgumentInfo::Use::none)
          << kind.name << " " << argument.name;
    }
  }
}

TEST(JobKinds, EveryKindPrintsJson) {
  const tools::JobKinds& kinds = tools::job_kinds();
  for (const tools::JobKind& kind : kinds.all()) {
    EXPECT_NE(kind.option("json"), nullptr) << kind.name;
  }
}

TEST(JobKinds, OnlyOnePositionalArgumentIsReadAtMost) {
  const tools::JobKinds& kinds = tools::job_kinds();
  for (const tools::JobKind& kind : kinds.all()) {
    int count = 0;
    for (const ArgumentInfo& argument : kind.arguments) count += argument.is_positional;
    EXPECT_LE(count, 1) << kind.name;
  }
}

}  // namespace
}  // namespace roadbed::tests
