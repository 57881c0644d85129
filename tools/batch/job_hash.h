#pragma once

#include <string>
#include <string_view>

#include "roadbed/tools/batch/file_hashes.h"
#include "roadbed/tools/batch/job.h"

namespace roadbed::tools::inline batch {

/// What a job is known by: SHA-256 (64 hexadecimal digits) over the program's build (see build_id),
/// the job as its line says it (the order of options and outputs does not matter), and the contents
/// of every file that it reads. Two jobs of one hash have one result.
std::string hash_of(const Job& job, FileHashes& files);

/// That of a line which is no job.
std::string hash_of_bad_line(std::string_view line);

}  // namespace roadbed::tools
