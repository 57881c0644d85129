#pragma once

#include <filesystem>

#include <gtest/gtest.h>

namespace roadbed::tests {

/// Where maps, scenarios and clouds made by others are: `ROADBED_REAL_DATA`, else a folder beside
/// the project; empty if there is none.
std::filesystem::path real_data_folder();

/// Maps, scenarios and clouds of this project.
std::filesystem::path data_folder();

/// The sources of the tests, with the files that some of them keep beside themselves.
std::filesystem::path tests_folder();

}  // namespace roadbed::tests

/// Skips the test with its reason where the real data is not there; else defines `folder`.
// NOLINTBEGIN(bugprone-macro-parentheses): a name to define stands without parentheses.
#define ROADBED_REAL_DATA_OR_SKIP(folder)                                    \
  const std::filesystem::path folder = ::roadbed::tests::real_data_folder(); \
  if (folder.empty()) GTEST_SKIP() << "no real data: set ROADBED_REAL_DATA to its folder"
// NOLINTEND(bugprone-macro-parentheses)
