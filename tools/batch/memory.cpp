#include "roadbed/tools/batch/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <utility>

namespace roadbed::tools::inline batch {
namespace {

constexpr std::array<std::pair<std::string_view, double>, 5> kUnits{
    {{"TB", 1e12}, {"GB", 1e9}, {"MB", 1e6}, {"kB", 1e3}, {"B", 1.0}}};
constexpr double kMost = 1e18;

}  // namespace

std::optional<std::uint64_t> parse_memory_size(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return {};
  std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (unit.starts_with(' ')) unit.remove_prefix(1);
  const auto* const found = std::ranges::find_if(kUnits, [&](const auto& known) {
    return unit == known.first || unit == known.first.substr(0, known.first.size() - 1);
  });
  if (found == kUnits.end()) return {};
  const double bytes = number * found->second;
  if (!(bytes >= 1.0 && bytes <= kMost)) return {};
  return static_cast<std::uint64_t>(bytes);
}

std::string memory_size_text(std::uint64_t bytes) {
  const auto size = static_cast<double>(bytes);
  const auto* const unit =
      std::ranges::find_if(kUnits, [&](const auto& u) { return size >= u.second; });
  return unit == kUnits.end() ? "0 B" : fmt::format("{:.3g} {}", size / unit->second, unit->first);
}

ProcessMemory memory_of_process(pid_t process) {
  std::ifstream file(fmt::format("/proc/{}/statm", process));
  std::uint64_t reserved = 0, resident = 0;
  file >> reserved >> resident;
  const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return {.reserved = reserved * page, .resident = resident * page};
}

void limit_memory(std::uint64_t bytes) {
  const rlim_t most = memory_of_process(::getpid()).reserved + bytes;
  const rlimit limit{.rlim_cur = most, .rlim_max = most};
  ::setrlimit(RLIMIT_AS, &limit);
}

void MemoryGate::enter() {
  constexpr std::chrono::milliseconds pause{50};  // a running job may give some back before its end
  std::unique_lock lock(mutex_);
  while (running_ > 0 && resident_() > limit_) left_.wait_for(lock, pause);
  ++running_;
}

void MemoryGate::leave() {
  {
    const std::scoped_lock lock(mutex_);
    --running_;
  }
  left_.notify_one();
}

}  // namespace roadbed::tools::batch
