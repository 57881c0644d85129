#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/tools/batch/job_result.h"

namespace roadbed::tools::inline batch {

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
  std::vector<std::string> files;

  /// Whether the same job may come to something else another time.
  bool may_change() const { return cause && may_pass(*cause); }
};

/// None if the line is no whole result, as one that was cut off.
std::optional<ResultHead> read_head(std::string_view line);

}  // namespace roadbed::tools
