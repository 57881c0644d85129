#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/tools/batch/job_result.h"

namespace roadbed::tools::inline batch {

/// A job as a list of the worst ones shows it.
struct WorstCase {
  std::size_t line = 0;  ///< of the file of jobs
  JobStatus status = JobStatus::done;
  double badness = 0.0;
  std::string hash, about;  ///< its inputs and options, as words
  std::string text;         ///< its verdict, or why it failed
  std::vector<std::string> files = {};
};

/// Jobs of one kind: how they came out, and the worst of them, worst first: failed ones, then those
/// whose answer is no, then by what their kind is judged by, then by line.
class KindSummary {
 public:
  explicit KindSummary(std::size_t most) : most_(most) {}

  void add(WorstCase job);

  std::size_t count(JobStatus status) const { return counts_.at(static_cast<std::size_t>(status)); }
  std::size_t count() const { return counts_[0] + counts_[1] + counts_[2]; }
  std::vector<WorstCase> worst() const;

 private:
  std::size_t most_;
  std::array<std::size_t, 3> counts_{};
  std::vector<WorstCase> worst_;  // a heap, the least bad of them first
};

/// What the results of a batch come to. Memory: that of the worst cases.
class BatchSummary {
 public:
  /// @param most  worst cases that are kept of each kind.
  explicit BatchSummary(std::size_t most) : most_(most) {}

  /// @param result  a line of results.jsonl.
  /// @throws std::invalid_argument if it is none.
  void add(std::size_t line, std::string_view result);

  /// By name of the kind; that of lines which are no jobs is empty.
  const std::map<std::string, KindSummary>& kinds() const { return kinds_; }

  std::size_t count(JobStatus status) const;
  std::size_t count() const;

  /// The bytes of `summary.json`, with at most so many worst cases a kind.
  std::string document(std::size_t most_worst) const;

 private:
  std::size_t most_;
  std::map<std::string, KindSummary> kinds_;
};

/// "1,234,567".
std::string with_commas(std::size_t number);

}  // namespace roadbed::tools::batch
