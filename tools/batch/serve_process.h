#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>

#include "roadbed/tools/batch/job_kinds.h"

namespace roadbed::tools::inline batch {

struct ServeOptions {
  std::filesystem::path folder;
  std::string job_memory = {};  ///< what the process was limited to, as a size; empty: it was not
  std::uint64_t memory_bytes = 0;  ///< of this process; inputs stay loaded while it has half of it
};

/// Runs the jobs of the lines of `in` one after the other, and prints the line of each result at
/// once, until there is no more line, or `out` takes no more. Files go below `options.folder`.
///
/// Before a job there may stand a hash and a tab: what it is known by to whoever asks. Its files go
/// by that name, and if its inputs are not those of that hash, they have changed.
void serve(std::istream& in, std::ostream& out, const JobKinds& kinds, const ServeOptions& options);

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
