#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>

#include "roadbed/tools/batch/job_kinds.h"
#include "roadbed/tools/cli/line_process.h"

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

/// A child process `roadbed batch --serve`.
class ServeProcess : public LineProcess {
 public:
  /// @param job_memory  a size for `--job-memory`; empty: none.
  /// @param memory  a size for `--memory`; empty: none.
  ServeProcess(const std::filesystem::path& folder, const std::string& job_memory,
               const std::string& memory);
};

}  // namespace roadbed::tools::batch
