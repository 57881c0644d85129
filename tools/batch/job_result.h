#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/tools/batch/job.h"

namespace roadbed::tools::inline batch {

enum class JobStatus {
  done,    ///< exit status 0
  no,      ///< exit status 1 with an answer: conflict, no route, findings, goal not reached
  failed,  ///< there is no answer
};

std::string_view to_string(JobStatus status);

/// Why a job has no answer. Some of it is the job's own fault, so that it fails again.
enum class Cause {
  line,      ///< the line is no job
  input,     ///< an input is unusable
  changed,   ///< an input changed meanwhile
  crash,     ///< its process died
  time,      ///< it took longer than allowed
  memory,    ///< it needed more than there was
  disk,      ///< an output could not be written
  internal,  ///< a fault of the program
};

std::string_view to_string(Cause cause);

/// Whether the same job may have an answer another time.
bool may_pass(Cause cause);

/// What became of a job. Holds neither time, thread nor host.
struct JobResult {
  std::string hash;
  JobStatus status = JobStatus::failed;
  std::optional<int> exit = {};     ///< the command's; none where it did not end, or not run
  std::string reason = {};          ///< of `no` and `failed`, one line
  std::optional<Cause> cause = {};  ///< of `failed`
  std::string document = {};        ///< JSON that the command printed, on one line; may be empty
  std::vector<std::string> files = {};   ///< relative to the folder of the batch
  std::vector<std::string> sha256 = {};  ///< of each of them, hexadecimal
};

/// The line of a result, without its end:
/// `{"hash":…,"job":…,"status":…,"exit":…,"reason":…,"cause":…,"inputs":…,"options":…,"outputs":…,
/// "result":…,"files":…,"sha256":…}`.
std::string line_of(const Job& job, const JobResult& result);

/// The line of one that is no job.
std::string line_of_bad_line(std::string_view line, const std::string& reason);

/// A job that failed.
JobResult failure(std::string hash, Cause cause, std::optional<int> exit, std::string reason);

/// The 256 bits of a job's hash.
using JobHash = std::array<std::uint64_t, 4>;

/// Hexadecimal digits of a job's hash as text.
constexpr std::size_t kHashDigits = 64;

/// None if the text is not so many hexadecimal digits in lower case.
std::optional<JobHash> parse_hash(std::string_view text);

std::string text_of(const JobHash& hash);

/// What of a result's line says whether it stands.
struct ResultHead {
  JobHash hash;
  JobStatus status;
  std::optional<Cause> cause;
  std::vector<std::string> files, sha256;  ///< as many of both

  /// Whether the same job may come to something else another time.
  bool may_change() const { return cause && may_pass(*cause); }
};

/// None if the line is no whole result, as one that was cut off.
std::optional<ResultHead> read_head(std::string_view line);

/// What a job's document comes to.
struct JobVerdict {
  std::string text;      ///< "conflict, least clearance 0.120 m"
  double badness = 0.0;  ///< greater is worse, among jobs of one kind and status
};

/// @param kind      name of the command.
/// @param document  the JSON that it printed.
/// @throws std::invalid_argument if it is not what that command prints.
JobVerdict verdict_of(std::string_view kind, const nlohmann::json& document);

}  // namespace roadbed::tools::batch
