#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/tools/batch/file_hashes.h"
#include "roadbed/tools/batch/job_kinds.h"

namespace roadbed::tools::inline batch {

/// One run of a command, as a line of JSON says it:
/// `{"job":"audit","options":{"occupancy":"street.bt","trajectory":"a.csv"},"outputs":["report"]}`.
struct Job {
  const JobKind* kind = nullptr;
  std::vector<std::string> inputs = {};   ///< positional arguments
  nlohmann::json options = {};            ///< by long name; flags that are false are left out
  std::vector<std::string> outputs = {};  ///< options whose files the batch names, sorted
};

/// @param kinds  lives as long as the job.
/// @throws InputError saying what is wrong: no JSON, a key that is unknown or stands twice, a kind
///         or an option that there is not, an option that the batch sets itself, a wrong type.
Job parse_job(std::string_view line, const JobKinds& kinds);

/// The words of the command line but for its outputs, without the command's name.
std::vector<std::string> words_of_options(const Job& job);

/// Files and folders that the job reads, as it names them, in a fixed order.
struct JobInput {
  std::string path;
  const FilesNamed* named;  ///< never null, but may be empty
};
std::vector<JobInput> inputs_of(const Job& job);

/// What a job is known by: SHA-256 (64 hexadecimal digits) over the program's build and its
/// libraries (see build_id), the job as its line says it (the order of options and outputs does not
/// matter), and the contents of every file that it reads. Two jobs of one hash have one result.
std::string hash_of(const Job& job, FileHashes& files);

/// That of a line which is no job.
std::string hash_of_bad_line(std::string_view line);

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

/// SHA-256 of a file that a job wrote, which may be empty.
/// @throws InputError if it cannot be read.
std::string sha256_of_output(const std::filesystem::path& file);

/// Removes whatever a job left in the folder, half-written files too.
void remove_files_of(const std::string& hash, const std::filesystem::path& folder);

/// Where the files of a job are: `FOLDER/files/ab`.
std::filesystem::path folder_of_files(const std::string& hash, const std::filesystem::path& folder);

}  // namespace roadbed::tools::batch
