#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::tests {

/// A folder of its own for a test, empty at first, removed at the end.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(
      const std::filesystem::path& within = std::filesystem::temp_directory_path());
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

  /// Writes a file in it. Returns its path.
  std::string write(std::string_view name, std::string_view bytes) const;

 private:
  std::filesystem::path path_;
};

/// What a run of the program left: its exit status (128 + signal if it was killed) and both
/// streams.
struct ProgramRun {
  int status = 0;
  std::string out, err;
};

/// The `roadbed` program that was built beside the tests.
std::filesystem::path program_file();

/// Runs it.
ProgramRun run_roadbed(const std::vector<std::string>& arguments);

/// The same with another file of the program.
ProgramRun run_program(const std::filesystem::path& program,
                       const std::vector<std::string>& arguments);

/// The same with a file, or a pipe that somebody writes to, as standard input.
ProgramRun run_roadbed_reading(const std::string& input, const std::vector<std::string>& arguments);

/// The same with this as standard output, which is closed if negative.
ProgramRun run_roadbed_into(int descriptor, const std::vector<std::string>& arguments);

/// The bytes of a file, as a test wants them.
std::string bytes_of(const std::filesystem::path& file);

/// Names of all files below a folder, relative to it, sorted; hidden ones too.
std::vector<std::string> files_below(const std::filesystem::path& folder);

}  // namespace roadbed::tests
