#include "roadbed/tools/batch/serve_process.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <memory>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/batch/input_cache.h"
#include "roadbed/tools/batch/job.h"
#include "roadbed/tools/batch/job_lines.h"
#include "roadbed/tools/batch/job_result.h"
#include "roadbed/tools/batch/job_runner.h"
#include "roadbed/tools/batch/memory.h"

namespace roadbed::tools::inline batch {
namespace {

constexpr std::size_t kHashAndTab = kHashDigits + 1;

/// What all jobs of a process share.
struct Shared {
  const JobKinds& kinds;
  FileHashes files;
  std::shared_ptr<const InputCache> inputs;
};

JobResult result_of(const Job& job, const std::string& hash, const Shared& shared,
                    const ServeOptions& options) {
  JobResult result = run_job(job, hash, options.folder, shared.inputs);
  // What stayed loaded of other jobs is not to be this one's lack of memory.
  const bool may_be_others = result.cause == Cause::memory && shared.inputs->shrink(0);
  return may_be_others ? run_job(job, hash, options.folder, shared.inputs) : result;
}

// The hash before a job, if there is one; cut off from the line.
std::string take_hash(std::string& text) {
  const std::size_t tab = text.find('\t');
  if (tab == std::string::npos || !parse_hash(std::string_view(text).substr(0, tab))) return {};
  std::string hash = text.substr(0, tab);
  text.erase(0, tab + 1);
  return hash;
}

std::string answer(JobLines::Line& line, Shared& shared, const ServeOptions& options) {
  if (line.is_too_long) {
    return line_of_bad_line(line.text,
                            fmt::format("job: is longer than {} bytes", line.text.size()));
  }
  const std::string asked = take_hash(line.text);
  try {
    const Job job = parse_job(line.text, shared.kinds);
    const std::string hash = hash_of(job, shared.files);
    if (!asked.empty() && asked != hash) {
      return line_of(job, failure(asked, Cause::changed, {}, "an input has changed meanwhile"));
    }
    JobResult result = result_of(job, hash, shared, options);
    if (hash_of(job, shared.files) != hash) {
      remove_files_of(hash, options.folder);
      result = failure(hash, Cause::changed, {}, "an input changed while the job ran");
    }
    if (result.cause == Cause::memory && !options.job_memory.empty()) {
      result.reason = "needed more than " + options.job_memory;
    }
    return line_of(job, result);
  } catch (const map::InputError& error) {
    return line_of_bad_line(line.text, error.what());
  }
}

}  // namespace

void serve(std::istream& in, std::ostream& out, const JobKinds& kinds,
           const ServeOptions& options) {
  Shared shared{.kinds = kinds, .files = {}, .inputs = nullptr};
  shared.inputs = std::make_shared<const InputCache>(shared.files, options.memory_bytes / 2, [] {
    return memory_of_process(::getpid()).resident;
  });
  JobLines lines(in, JobLines::kLongest + kHashAndTab);
  while (auto line = lines.next()) {
    out << answer(*line, shared, options) << '\n' << std::flush;
    if (!out) return;
  }
}

}  // namespace roadbed::tools::batch
