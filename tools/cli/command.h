#pragma once

#include <exception>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "roadbed/tools/cli/arguments.h"
#include "roadbed/tools/cli/inputs.h"

namespace roadbed::tools::inline cli {

/// Exit status of the program.
enum class Exit {
  ok = 0,
  no = 1,        ///< the answer is no: conflict, no route, goal not reached, …; outputs are kept
  usage = 2,     ///< the command line is wrong
  unusable = 3,  ///< an input is unusable or missing, or an output cannot be written; none is left
  internal = 4,  ///< the program's own fault, or it ran out of memory; no output is left
};

/// What an exception that ended a command comes to: its exit status, and a line for the user.
struct Failure {
  Exit exit;
  std::string text;
};
Failure failure_of(const std::exception& error);

/// Options that every command has.
struct CommonOptions {
  bool quiet = false;
  int threads = 0;  ///< 0: as many as the command itself would choose, mostly one
  /// Whether the process runs this command only, which may then set up its heap.
  bool is_alone = true;
  /// Files that the command line names as inputs, and those that these name; no output replaces
  /// one.
  std::vector<std::filesystem::path> input_files = {};
  /// Where it gets what it may share with other runs in the process; never null.
  std::shared_ptr<const Inputs> inputs = std::make_shared<const Inputs>();

  /// For commands that choose one thread for each processor, up to 4.
  int several_threads() const;
};

/// Where a command prints: results to `out`, everything else to `err`.
struct Streams {
  std::ostream& out;
  std::ostream& err;
};

/// One command of the program. `declare` names options and touches no file; `run` does the work.
class Command {
 public:
  virtual ~Command() = default;
  virtual void declare(Arguments& arguments) = 0;
  virtual Exit run(const Streams& streams, const CommonOptions& common) = 0;
};

}  // namespace roadbed::tools::cli
