#include "roadbed/tools/batch/job_result.h"

#include <algorithm>
#include <array>
#include <utility>

#include "roadbed/tools/batch/job_hash.h"

namespace roadbed::tools::inline batch {
namespace {

using nlohmann::json;

constexpr int kUsage = 2;

std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

// Members in this order, so that a reader sees first what became of the job.
std::string line(const JobResult& result, const json& kind, const std::string& rest) {
  return "{\"hash\":" + text_of(result.hash) + ",\"job\":" + text_of(kind) +
         ",\"status\":" + text_of(name(result.status)) +
         ",\"exit\":" + (result.exit ? std::to_string(*result.exit) : "null") +
         ",\"reason\":" + text_of(result.reason) +
         ",\"cause\":" + (result.cause ? text_of(name(*result.cause)) : "null") + rest +
         ",\"result\":" + (result.document.empty() ? "null" : result.document) +
         ",\"files\":" + text_of(result.files) + "}";
}

std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

}  // namespace

std::string_view name(JobStatus status) {
  constexpr std::array<std::string_view, 3> names{"done", "no", "failed"};
  return names.at(static_cast<std::size_t>(status));
}

std::string_view name(Cause cause) {
  constexpr std::array<std::string_view, 8> names{"line", "input",  "changed", "crash",
                                                  "time", "memory", "disk",    "internal"};
  return names.at(static_cast<std::size_t>(cause));
}

bool may_pass(Cause cause) { return cause != Cause::line && cause != Cause::input; }

std::string line_of(const Job& job, const JobResult& result) {
  return line(result, job.kind->name,
              ",\"inputs\":" + text_of(job.inputs) + ",\"options\":" + text_of(job.options) +
                  ",\"outputs\":" + text_of(job.outputs));
}

std::string line_of_bad_line(std::string_view text, const std::string& reason) {
  return line(failure(hash_of_bad_line(text), Cause::line, kUsage, reason), nullptr,
              R"(,"inputs":[],"options":{},"outputs":[])");
}

JobResult failure(std::string hash, Cause cause, std::optional<int> exit, std::string reason) {
  return {.hash = std::move(hash),
          .status = JobStatus::failed,
          .exit = exit,
          .reason = one_line(std::move(reason)),
          .cause = cause};
}

}  // namespace roadbed::tools
