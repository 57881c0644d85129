#include "roadbed/tools/batch/job_runner.h"

#include <fmt/format.h>

#include "roadbed/tools/batch/job_files.h"
#include "roadbed/tools/batch/result_head.h"
#include "roadbed/tools/batch/run_job.h"

namespace roadbed::tools::inline batch {

std::string ThreadRunner::run(const Job& job, const std::string& hash, const std::string&) {
  return line_of(job, run_job(job, hash, folder_, inputs_));
}

std::string ProcessRunner::run(const Job& job, const std::string& hash, const std::string& text) {
  const int answered_before = process_.process() == 0 ? 0 : process_.answered();
  const ServeProcess::Answer answer = process_.ask(hash + "\t" + text, limits_.time_s);
  const auto failed = [&](Cause cause, const std::string& reason) {
    remove_files_of(hash, folder_);
    return line_of(job, failure(hash, cause, {}, reason));
  };
  if (answer.is_late) {
    return failed(Cause::time, fmt::format("took longer than {} s", *limits_.time_s));
  }
  if (!answer.death.empty()) return failed(Cause::crash, answer.death);
  const auto head = read_head(answer.line);
  if (!head) return failed(Cause::internal, "its process answered with no result");
  if (text_of(head->hash) != hash) {
    return failed(Cause::internal, "its process answered with the result of another job");
  }
  if (head->cause != Cause::memory) return answer.line;
  process_.end();  // its heap may be in pieces
  // Memory that earlier jobs left to the process must not be counted as the job's.
  return answered_before > 0 ? run(job, hash, text) : answer.line;
}

}  // namespace roadbed::tools
