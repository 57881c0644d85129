#pragma once

#include <filesystem>
#include <string>

namespace roadbed::tests {

/// A browser that can run without a screen; empty if this machine has none.
std::filesystem::path find_browser();

/// The page after its scripts have run, as HTML; empty if the browser failed.
/// @param fragment  "#t=1" or empty.
std::string page_after_scripts(const std::filesystem::path& browser, const std::string& html,
                               const std::string& fragment);

}  // namespace roadbed::tests

/// Skips the test with its reason where there is no browser; else defines `browser`.
#define ROADBED_BROWSER_OR_SKIP(browser)                                  \
  const std::filesystem::path browser = ::roadbed::tests::find_browser(); \
  if (browser.empty()) GTEST_SKIP() << "no chromium found to run the page's scripts"
