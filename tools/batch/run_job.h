#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "roadbed/tools/batch/job_result.h"
#include "roadbed/tools/cli/inputs.h"

namespace roadbed::tools::inline batch {

/// Runs a job in this process and thread, by the command that it names. Whatever goes wrong is its
/// result; then none of its files is left.
/// @param hash    the job's, see hash_of.
/// @param folder  of the batch; the job's files go below `files/`.
/// @param inputs  where it gets what it reads.
JobResult run_job(const Job& job, const std::string& hash, const std::filesystem::path& folder,
                  const std::shared_ptr<const Inputs>& inputs);

/// What the job's command says of its options, before it reads anything; nothing if all is well.
std::string fault_of_options(const Job& job);

}  // namespace roadbed::tools
