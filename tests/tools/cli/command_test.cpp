#include "roadbed/tools/cli/command.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

#include "roadbed/map/storage/output_file.h"

namespace roadbed::tests {
namespace {

using tools::Exit;
using tools::failure_of;

TEST(FailureOf, AnUnusableInputOrOutputIsTheUsersToMend) {
  const map::InputError input({.file = "town.xodr", .found = "no such file"});
  EXPECT_EQ(failure_of(input).exit, Exit::unusable);
  EXPECT_EQ(failure_of(input).text, "town.xodr: no such file");
  const map::OutputError output({.file = "town.rbm", .found = "exists"});
  EXPECT_EQ(failure_of(output).exit, Exit::unusable);
}

TEST(FailureOf, EverythingElseIsTheProgramsFault) {
  EXPECT_EQ(failure_of(std::bad_alloc()).exit, Exit::internal);
  EXPECT_EQ(failure_of(std::bad_alloc()).text, "out of memory");
  const tools::Failure fault = failure_of(std::logic_error("7 is not 8"));
  EXPECT_EQ(fault.exit, Exit::internal);
  EXPECT_EQ(fault.text, "internal error: 7 is not 8; please report it with the command line");
}

}  // namespace
}  // namespace roadbed::tests
