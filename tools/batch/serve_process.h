#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace roadbed::tools::inline batch {

/// A child process `roadbed batch --serve`, which is started when it is first asked. It dies with
/// the thread that started it, and a Ctrl-C on the terminal does not reach it. One thread asks.
class ServeProcess {
 public:
  /// @param job_memory  a size for `--job-memory`; empty: none.
  /// @param memory  a size for `--memory`; empty: none.
  ServeProcess(std::filesystem::path folder, std::string job_memory, std::string memory);
  ~ServeProcess();
  ServeProcess(const ServeProcess&) = delete;
  ServeProcess& operator=(const ServeProcess&) = delete;

  /// What came of a line: the result's line, or how the process ended over it.
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

  std::filesystem::path folder_;
  std::string job_memory_, memory_;
  std::atomic<pid_t> process_ = 0;
  int input_ = -1, output_ = -1, answered_ = 0;
};

}  // namespace roadbed::tools::batch
