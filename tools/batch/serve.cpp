#include "roadbed/tools/batch/serve.h"

#include <fmt/format.h>

#include <iostream>

#include "roadbed/map/input_error.h"
#include "roadbed/tools/batch/job_files.h"
#include "roadbed/tools/batch/job_hash.h"
#include "roadbed/tools/batch/job_lines.h"
#include "roadbed/tools/batch/run_job.h"
#include "roadbed/tools/support/output_file.h"

namespace roadbed::tools {
namespace {

std::string answer(const JobLines::Line& line, const JobKinds& kinds, FileHashes& files,
                   const ServeOptions& options) {
  if (line.is_too_long) {
    return line_of_bad_line(line.text,
                            fmt::format("job: is longer than {} bytes", line.text.size()));
  }
  try {
    const Job job = parse_job(line.text, kinds);
    const std::string hash = hash_of(job, files);
    JobResult result = run_job(job, hash, options.folder);
    if (hash_of(job, files) != hash) {
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

void serve(std::istream& in, std::ostream& out, const ServeOptions& options) {
  const JobKinds kinds;
  FileHashes files;
  JobLines lines(in);
  while (const auto line = lines.next()) {
    out << answer(*line, kinds, files, options) << '\n' << std::flush;
    if (!out) {
      throw OutputError({.file = "standard output",
                         .place = {},
                         .element = {},
                         .found = "cannot be written",
                         .needed = {},
                         .remedy = "read it to its end"});
    }
  }
}

}  // namespace roadbed::tools
