#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

namespace roadbed::tools {

struct ServeOptions {
  std::filesystem::path folder;
  std::string job_memory = {};  ///< what the process was limited to, as a size; empty: it was not
};

/// Runs the jobs of the lines of `in` one after the other, and prints the line of each result at
/// once, until there is no more line. Files go below
/// `options.folder`.
/// @throws OutputError if a result cannot be printed.
void serve(std::istream& in, std::ostream& out, const ServeOptions& options);

}  // namespace roadbed::tools
