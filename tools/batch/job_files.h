#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "roadbed/tools/batch/job.h"

namespace roadbed::tools::inline batch {

/// An output whose place the batch chose.
struct JobOutput {
  std::string option;
  std::filesystem::path path;  ///< `FOLDER/files/ab/abcdef….suffix`
};

/// The outputs of a job: those it asks for, and those that its command must have. A
/// file's name has its option's in it, unless that is `output` or the suffix says it.
std::vector<JobOutput> outputs_of(const Job& job, const std::string& hash,
                                  const std::filesystem::path& folder);

/// The files that are there of these outputs, relative to the folder, sorted.
std::vector<std::string> files_of(const std::vector<JobOutput>& outputs,
                                  const std::filesystem::path& folder);

/// Removes whatever a job left in the folder, half-written files too.
void remove_files_of(const std::string& hash, const std::filesystem::path& folder);

/// Where the files of a job are: `FOLDER/files/ab`.
std::filesystem::path folder_of_files(const std::string& hash, const std::filesystem::path& folder);

}  // namespace roadbed::tools::batch
