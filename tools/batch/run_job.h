#pragma once

#include <filesystem>
#include <string>

#include "roadbed/tools/batch/job_result.h"

namespace roadbed::tools {

/// Runs a job in this process and thread, by the command that it names. Whatever goes wrong is its
/// result; then none of its files is left.
/// @param hash    the job's, see hash_of.
/// @param folder  of the batch; the job's files go below `files/`.
JobResult run_job(const Job& job, const std::string& hash, const std::filesystem::path& folder);

}  // namespace roadbed::tools
