#include "roadbed/tests/support/browser.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace roadbed::tests {
namespace {

// A folder of its own that goes away with it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "roadbed.XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no scratch folder");
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  std::string output;
  std::array<char, 65536> block{};
  while (const std::size_t read = std::fread(block.data(), 1, block.size(), pipe.get())) {
    output.append(block.data(), read);
  }
  return output;
}

}  // namespace

std::filesystem::path find_browser() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
      const std::filesystem::path file = std::filesystem::path(folder) / name;
      if (::access(file.c_str(), X_OK) == 0) return file;
    }
  }
  return {};
}

std::string page_after_scripts(const std::filesystem::path& browser, const std::string& html,
                               const std::string& fragment) {
  // Frames come by the clock, which the budget of virtual time does not wait for; timeouts it does.
  constexpr std::string_view kHead = "<head>";
  constexpr std::string_view kFramesInVirtualTime =
      "<script>requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 16);"
      "cancelAnimationFrame = clearTimeout;</script>";
  std::string shown = html;
  if (const auto head = shown.find(kHead); head != std::string::npos) {
    shown.insert(head + kHead.size(), kFramesInVirtualTime);
  }
  // Of the window's height, a browser without a screen leaves 900 px to the page.
  const ScratchFolder folder;
  const std::filesystem::path page = folder.path() / "page.html";
  std::ofstream(page, std::ios::binary) << shown;
  return output_of(fmt::format(
      "timeout 120 '{}' --headless --no-sandbox --disable-gpu --user-data-dir='{}' "
      "--window-size=1400,1043 --virtual-time-budget=20000 --dump-dom 'file://{}{}' 2>/dev/null",
      browser.string(), (folder.path() / "profile").string(), page.string(), fragment));
}

}  // namespace roadbed::tests
