#pragma once

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iosfwd>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/batch/file_hashes.h"
#include "roadbed/tools/batch/input_cache.h"
#include "roadbed/tools/batch/job_lines.h"
#include "roadbed/tools/batch/job_runner.h"
#include "roadbed/tools/batch/memory.h"
#include "roadbed/tools/batch/result_store.h"
#include "roadbed/tools/cli/progress_bar.h"
#include "roadbed/tools/files/streamed_output.h"

namespace roadbed::tools::inline batch {

struct BatchOptions {
  std::filesystem::path jobs_file, folder;
  int threads = 1;
  std::uint64_t memory_bytes = 0;  ///< of this process and those of its jobs; half of it for inputs
  bool isolates = false;           ///< jobs run in processes of their own
  JobLimits limits;                ///< kept with `isolates` only
  bool merges = false;             ///< no job runs, and what has failed stands
};

/// Number of jobs in a file, one a line that is not blank.
/// @throws InputError if it cannot be read.
std::size_t count_jobs(const std::filesystem::path& jobs_file);

/// Prints the jobs that have no result which stands, each once: its hash, a tab, its line. Lines
/// that are no jobs are left out.
/// @throws InputError if the file of jobs cannot be read.
void list_missing(const BatchOptions& options, const JobKinds& kinds, const ResultStore& store,
                  std::ostream& out);

/// Brings the jobs of a file to their results: those that have none that stands run, in threads.
/// Memory: about 150 bytes a job beside the store, and the jobs that run.
class BatchRun {
 public:
  /// @param kinds, store, progress  live as long as this.
  /// @throws InputError if the file of jobs cannot be read.
  BatchRun(const BatchOptions& options, const JobKinds& kinds, ResultStore& store,
           ProgressBar& progress);

  /// Until all are done or a stop is asked for, see StopSignal.
  /// @throws OutputError if a result cannot be kept; what was kept before stays.
  void run();

  /// Whether every job has its result.
  bool is_complete() const { return is_complete_ && missing_ == 0; }

  /// Jobs without a result, where none may run.
  std::size_t missing() const { return missing_; }

  /// The results of the lines taken, in their order; lines of one job have one result.
  const std::vector<LineResult>& order() const { return order_; }

  /// Lines whose results were there before.
  std::size_t were_there() const { return were_there_; }

 private:
  struct Taken {
    std::size_t index;
    JobLines::Line line;
  };

  void work(JobRunner& runner);
  std::optional<Taken> take();
  void bring(const Taken& taken, JobRunner& runner);
  bool claim(std::size_t index, const JobHash& hash, const Job* job);
  void run_job_of(const JobLines::Line& line, const Job& job, const std::string& hash,
                  JobRunner& runner);
  void keep_time(const Job& job, const std::string& hash, double wall_s);
  std::uint64_t resident() const;
  std::uint64_t least_resident() const;
  void stop_others();

  const BatchOptions& options_;
  ResultStore& store_;
  ProgressBar& progress_;
  const JobKinds& kinds_;
  FileHashes files_;
  std::shared_ptr<const InputCache> inputs_;
  AppendedFile timings_;
  std::unique_ptr<std::istream> stream_;
  JobLines lines_;
  MemoryGate gate_;
  std::vector<std::unique_ptr<JobRunner>> runners_;

  std::mutex mutex_;  // of all that follows
  std::vector<LineResult> order_;
  std::map<JobHash, bool> were_there_by_hash_;  // of all jobs taken
  std::size_t were_there_ = 0, missing_ = 0;
  bool is_complete_ = false, has_failed_ = false;
};

/// While it lives, the first SIGINT or SIGTERM only asks to stop; the second of either ends the
/// process. A reader that has gone away is an error of writing, not the end of the process, and so
/// is a file that may not grow.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  static bool is_asked();

 private:
  struct sigaction interrupt_ {
  }, terminate_{}, pipe_{}, file_size_{};
};

}  // namespace roadbed::tools::batch
