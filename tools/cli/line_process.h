#pragma once

#include <sys/types.h>

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace roadbed::tools::inline cli {

/// A child process that answers each line of its standard input with a line on its standard output;
/// started when it is first asked. It dies with the thread that started it, and a Ctrl-C on the
/// terminal does not reach it. One thread asks. Signals of broken pipes (SIGPIPE) have to be off.
class LineProcess {
 public:
  struct Program {
    std::string file;                ///< path of it: "/bin/sh", "/proc/self/exe"
    std::vector<std::string> words;  ///< its arguments, its own name first
    std::string what;                ///< it is, for messages: "a process of its own for jobs"
    std::string remedy;              ///< where it cannot be started
    bool restarts = false;           ///< where it ended between two lines, over none
  };

  explicit LineProcess(Program program);
  ~LineProcess();
  LineProcess(const LineProcess&) = delete;
  LineProcess& operator=(const LineProcess&) = delete;

  /// What came of a line: the line that answers it, or how the process ended over it.
  struct Answer {
    std::string line = {};
    bool is_late = false;    ///< it was killed as it took too long
    std::string death = {};  ///< "killed by signal 11 (SIGSEGV)"
  };

  /// @param limit_s  wall clock that the question and its answer may take.
  /// @throws OutputError if no process can be started.
  Answer ask(const std::string& line, std::optional<double> limit_s);

  /// Lines that the process which runs now has answered.
  int answered() const { return answered_; }

  /// Ends the process; the next question starts another one.
  void end();

  /// 0: none runs. May be asked by another thread.
  pid_t process() const { return process_; }

 private:
  void start();
  std::string reap();

  Program program_;
  std::atomic<pid_t> process_ = 0;
  int input_ = -1, output_ = -1, answered_ = 0;
};

/// Turns off the signal of broken pipes (SIGPIPE) while it lives.
class NoPipeSignal {
 public:
  NoPipeSignal();
  ~NoPipeSignal();
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;

 private:
  void (*before_)(int);
};

}  // namespace roadbed::tools::cli
