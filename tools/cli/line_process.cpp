#include "roadbed/tools/cli/line_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/storage/output_file.h"

namespace roadbed::tools::inline cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kCannotRun = 127;

[[noreturn]] void refuse(const LineProcess::Program& program, const char* call) {
  throw map::OutputError(
      {.file = program.what,
       .found = fmt::format("cannot be started: {}: {}", call, std::strerror(errno)),
       .remedy = program.remedy});
}

struct Pipe {
  int read_end = -1, write_end = -1;
};

Pipe make_pipe(const LineProcess::Program& program) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse(program, "pipe");
  return {.read_end = ends[0], .write_end = ends[1]};
}

/// Between fork and exec, where other threads' locks may be held for ever: system calls only.
[[noreturn]] void become(const char* file, char* const* words, const Pipe& to_child,
                         const Pipe& from_child, pid_t parent) {
  const int input = to_child.read_end, output = from_child.write_end;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::setpgid(0, 0);
  const bool is_orphan = ::getppid() != parent;
  if (is_orphan || ::dup2(input, STDIN_FILENO) < 0 || ::dup2(output, STDOUT_FILENO) < 0) {
    ::_exit(kCannotRun);
  }
  ::execv(file, words);
  ::_exit(kCannotRun);
}

std::string death_of(int status) {
  if (!WIFSIGNALED(status)) {
    return fmt::format("its process ended with exit status {}", WEXITSTATUS(status));
  }
  const int signal = WTERMSIG(status);
  const char* const name = ::sigabbrev_np(signal);
  return fmt::format("killed by signal {}{}", signal,
                     name == nullptr ? "" : fmt::format(" (SIG{})", name));
}

std::optional<Clock::time_point> deadline_in(const std::optional<double>& limit_s) {
  if (!limit_s) return {};
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(*limit_s));
}

enum class Sending { sent, broken, late };

// Milliseconds to wait for, -1 for ever.
int wait_ms(const std::optional<Clock::time_point>& deadline) {
  if (!deadline) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(*deadline - Clock::now());
  constexpr std::int64_t most = 1'000'000;
  return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, most));
}

/// Waits until the descriptor can be read from or written to, or its other end is gone.
/// @returns false at the deadline.
bool wait_for(int descriptor, short events, const std::optional<Clock::time_point>& deadline) {
  for (;;) {
    pollfd ready{.fd = descriptor, .events = events, .revents = 0};
    if (::poll(&ready, 1, wait_ms(deadline)) > 0) return true;
    if (deadline && Clock::now() >= *deadline) return false;
  }
}

/// Sends a line, with its end.
Sending send_line(int descriptor, std::string_view rest,
                  const std::optional<Clock::time_point>& deadline) {
  while (!rest.empty()) {
    if (!wait_for(descriptor, POLLOUT, deadline)) return Sending::late;
    const ssize_t written = ::write(descriptor, rest.data(), rest.size());
    if (written < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (written < 0) return Sending::broken;
    rest.remove_prefix(static_cast<std::size_t>(written));
  }
  return Sending::sent;
}

enum class Reading { line, end, late, too_long };

constexpr std::size_t kMostAnswerBytes = std::size_t{1} << 28;

/// Reads up to the end of a line.
Reading read_line(int descriptor, const std::optional<Clock::time_point>& deadline,
                  std::string& line) {
  std::vector<char> piece(std::size_t{1} << 16);
  for (;;) {
    if (!wait_for(descriptor, POLLIN, deadline)) return Reading::late;
    const ssize_t size = ::read(descriptor, piece.data(), piece.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return Reading::end;
    line.append(piece.data(), static_cast<std::size_t>(size));
    if (line.size() > kMostAnswerBytes) return Reading::too_long;
    if (line.back() == '\n') {
      line.pop_back();
      return Reading::line;
    }
  }
}

}  // namespace

LineProcess::LineProcess(Program program) : program_(std::move(program)) {}

LineProcess::~LineProcess() { end(); }

void LineProcess::start() {
  std::vector<char*> words;
  for (std::string& word : program_.words) words.push_back(word.data());
  words.push_back(nullptr);
  const Pipe to_child = make_pipe(program_), from_child = make_pipe(program_);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become(program_.file.c_str(), words.data(), to_child, from_child, parent);
  ::close(to_child.read_end);
  ::close(from_child.write_end);
  input_ = to_child.write_end;
  ::fcntl(input_, F_SETFL, O_NONBLOCK);  // a process that hangs may leave its line unread
  output_ = from_child.read_end;
  answered_ = 0;
  process_ = std::max(child, 0);
  if (child < 0) {
    ::close(std::exchange(input_, -1));
    ::close(std::exchange(output_, -1));
    refuse(program_, "fork");
  }
}

std::string LineProcess::reap() {
  ::close(std::exchange(input_, -1));
  ::close(std::exchange(output_, -1));
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = 0;
  return death_of(status);
}

void LineProcess::end() {
  if (process_ == 0) return;
  ::kill(-process_, SIGKILL);  // and what it started
  ::kill(process_, SIGKILL);   // which may not lead its group yet
  reap();
}

LineProcess::Answer LineProcess::ask(const std::string& line, std::optional<double> limit_s) {
  if (process_ == 0) start();
  const std::string bytes = line + "\n";
  const auto deadline = deadline_in(limit_s);
  Sending sending = send_line(input_, bytes, deadline);
  if (sending == Sending::broken && program_.restarts) {
    end();
    start();
    sending = send_line(input_, bytes, deadline);
  }
  if (sending == Sending::broken) return {.death = reap()};
  if (sending == Sending::late) {
    end();
    return {.is_late = true};
  }
  Answer answer;
  switch (read_line(output_, deadline, answer.line)) {
    case Reading::line:
      ++answered_;
      break;
    case Reading::late:
      answer = {.is_late = true};
      end();
      break;
    case Reading::too_long:
      answer = {.death = "killed as its line is longer than 256 MiB"};
      end();
      break;
    case Reading::end:
      answer = {.death = reap()};
      break;
  }
  return answer;
}

NoPipeSignal::NoPipeSignal() : before_(::signal(SIGPIPE, SIG_IGN)) {}
NoPipeSignal::~NoPipeSignal() { ::signal(SIGPIPE, before_); }

}  // namespace roadbed::tools::cli
