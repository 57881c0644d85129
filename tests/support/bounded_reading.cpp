#include "roadbed/tests/support/bounded_reading.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <functional>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/validate_file.h"

namespace roadbed::tests {
namespace {

constexpr bool kMeasuresMemory =
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    false;
#else
    true;
#endif

using Work = std::function<std::string(const std::string&)>;

struct Reading {
  std::string outcome;  // what the work returns, or the refusal
  long peak_bytes = 0;  // of a process that does nothing else
};

std::string outcome_of(const Work& work, const std::string& bytes) {
  try {
    return work(bytes);
  } catch (const map::InputError& error) {
    return error.what();
  }
}

Reading read_in_a_child(const Work& work, const std::string& bytes) {
  int pipe_ends[2];
  if (::pipe(pipe_ends) != 0) throw std::runtime_error("pipe failed");
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string outcome = outcome_of(work, bytes);
    const auto written =
        ::write(pipe_ends[1], outcome.data(), std::min<std::size_t>(outcome.size(), 4000));
    ::_exit(written > 0 ? 0 : 1);
  }
  ::close(pipe_ends[1]);
  Reading reading;
  char buffer[4096];
  for (ssize_t got = 0; (got = ::read(pipe_ends[0], buffer, sizeof buffer)) > 0;) {
    reading.outcome.append(buffer, static_cast<std::size_t>(got));
  }
  ::close(pipe_ends[0]);
  int state = 0;
  rusage usage{};
  ::wait4(child, &state, 0, &usage);
  if (!WIFEXITED(state) || WEXITSTATUS(state) != 0) reading.outcome = "crashed";
  reading.peak_bytes = usage.ru_maxrss * 1024;
  return reading;
}

void expect_bounded(const Work& work, const std::string& bytes, const std::string& outcome) {
  const Reading reading = read_in_a_child(work, bytes);
  EXPECT_THAT(reading.outcome, testing::HasSubstr(outcome));
  if (!kMeasuresMemory) return;
  EXPECT_LT(reading.peak_bytes, 256'000'000 + 8 * static_cast<long>(bytes.size()))
      << "of " << bytes.size() << " bytes";
}

}  // namespace

void expect_read_in_bounds(const std::string& bytes, const std::string& outcome) {
  const Work read = [](const std::string& text) {
    return fmt::format("read {} lanes", map::parse_map(text, "made.map").lanes().size());
  };
  expect_bounded(read, bytes, outcome);
}

void expect_validated_in_bounds(const std::string& bytes, const std::string& outcome) {
  const Work validate = [](const std::string& text) {
    return fmt::format("{} findings", map::validate_bytes(text, "made.map").findings.size());
  };
  expect_bounded(validate, bytes, outcome);
}

std::string repeated(int times, const std::string& text) {
  std::string all;
  all.reserve(static_cast<std::size_t>(times) * text.size());
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

}  // namespace roadbed::tests
