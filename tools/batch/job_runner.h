#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "roadbed/tools/batch/job.h"
#include "roadbed/tools/batch/job_result.h"
#include "roadbed/tools/batch/serve_process.h"
#include "roadbed/tools/cli/inputs.h"

namespace roadbed::tools::inline batch {

/// Runs jobs, one after the other.
class JobRunner {
 public:
  virtual ~JobRunner() = default;

  /// @param text  the job's line.
  /// @returns the line of its result.
  virtual std::string run(const Job& job, const std::string& hash, const std::string& text) = 0;

  /// After the last job, in the thread that ran them.
  virtual void finish() {}

  /// The process in which it runs them, if that is another one; 0 if there is none.
  virtual pid_t process() const { return 0; }
};

/// In the thread that asks.
class ThreadRunner : public JobRunner {
 public:
  /// @param inputs  that it shares with other threads.
  ThreadRunner(std::filesystem::path folder, std::shared_ptr<const Inputs> inputs)
      : folder_(std::move(folder)), inputs_(std::move(inputs)) {}
  std::string run(const Job& job, const std::string& hash, const std::string& text) override;

 private:
  std::filesystem::path folder_;
  std::shared_ptr<const Inputs> inputs_;
};

/// What a job may take.
struct JobLimits {
  std::optional<double> time_s = {};  ///< wall clock
  std::string memory = {};            ///< a size; empty: no limit
  std::string process_memory = {};    ///< a size: that of its process when inputs stay loaded in it
};

/// In a process of its own, which is started anew when a job brings it down.
class ProcessRunner : public JobRunner {
 public:
  ProcessRunner(std::filesystem::path folder, JobLimits limits)
      : folder_(folder),
        limits_(std::move(limits)),
        process_(std::move(folder), limits_.memory, limits_.process_memory) {}
  std::string run(const Job& job, const std::string& hash, const std::string& text) override;
  void finish() override { process_.end(); }
  pid_t process() const override { return process_.process(); }

 private:
  std::filesystem::path folder_;
  JobLimits limits_;
  ServeProcess process_;
};

/// Runs a job in this process and thread, by the command that it names. Whatever goes wrong is its
/// result; then none of its files is left.
/// @param hash    the job's, see hash_of.
/// @param folder  of the batch; the job's files go below `files/`.
/// @param inputs  where it gets what it reads.
JobResult run_job(const Job& job, const std::string& hash, const std::filesystem::path& folder,
                  const std::shared_ptr<const Inputs>& inputs);

/// What the job's command says of its options, before it reads anything; nothing if all is well.
std::string fault_of_options(const Job& job);

}  // namespace roadbed::tools::batch
