#include "roadbed/tools/batch/batch_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "roadbed/map/files/json_text.h"
#include "roadbed/tools/batch/job_result.h"
#include "roadbed/tools/cli/build_id.h"

namespace roadbed::tools::inline batch {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// Lines differ, so no two are equally bad.
bool is_worse(const WorstCase& a, const WorstCase& b) {
  return std::tuple(b.status, b.badness, a.line) < std::tuple(a.status, a.badness, b.line);
}

JobStatus status_of(const json& result) {
  for (const JobStatus status : {JobStatus::done, JobStatus::no, JobStatus::failed}) {
    if (result.at("status") == to_string(status)) return status;
  }
  throw std::invalid_argument("BatchSummary: the line has no status");
}

void add_option(const std::string& option, const json& value, std::string& words) {
  if (value.is_array()) {
    for (const json& element : value) add_option(option, element, words);
    return;
  }
  words += " --" + option;
  if (value.is_boolean()) return;
  words += " " + (value.is_string() ? value.get<std::string>() : value.dump());
}

std::string about(const json& result) {
  std::string words;
  for (const json& input : result.at("inputs")) words += " " + input.get<std::string>();
  for (const auto& [option, value] : result.at("options").items()) add_option(option, value, words);
  return words.empty() ? "" : words.substr(1);
}

JobVerdict verdict(const std::string& kind, JobStatus status, const json& result) {
  if (status == JobStatus::failed) return {result.at("reason").get<std::string>(), 0.0};
  try {
    return verdict_of(kind, result.at("result"));
  } catch (const std::invalid_argument&) {  // of another version of the program, in a journal
    return {"what it printed is not known", 0.0};
  }
}

ordered_json counts_json(std::size_t all, std::size_t done, std::size_t no, std::size_t failed) {
  return {{"jobs", all}, {"done", done}, {"no", no}, {"failed", failed}};
}

ordered_json worst_json(const WorstCase& job) {
  return {{"line", job.line},   {"hash", job.hash}, {"status", to_string(job.status)},
          {"about", job.about}, {"text", job.text}, {"files", job.files}};
}

ordered_json kind_json(const KindSummary& kind, std::size_t most_worst) {
  ordered_json list = ordered_json::array();
  for (const WorstCase& job : kind.worst()) {
    if (list.size() < most_worst) list.push_back(worst_json(job));
  }
  ordered_json summary = counts_json(kind.count(), kind.count(JobStatus::done),
                                     kind.count(JobStatus::no), kind.count(JobStatus::failed));
  summary["worst"] = std::move(list);
  return summary;
}

}  // namespace

void KindSummary::add(WorstCase job) {
  ++counts_.at(static_cast<std::size_t>(job.status));
  worst_.push_back(std::move(job));
  std::ranges::push_heap(worst_, is_worse);
  if (worst_.size() <= most_) return;
  std::ranges::pop_heap(worst_, is_worse);
  worst_.pop_back();
}

std::vector<WorstCase> KindSummary::worst() const {
  std::vector<WorstCase> sorted = worst_;
  std::ranges::sort(sorted, is_worse);
  return sorted;
}

void BatchSummary::add(std::size_t line, std::string_view result_line) {
  try {
    const json result = json::parse(result_line);
    const json& kind_name = result.at("job");
    const std::string kind = kind_name.is_null() ? "" : kind_name.get<std::string>();
    const JobStatus status = status_of(result);
    JobVerdict found = verdict(kind, status, result);
    kinds_.try_emplace(kind, most_)
        .first->second.add({.line = line,
                            .status = status,
                            .badness = found.badness,
                            .hash = result.at("hash").get<std::string>(),
                            .about = about(result),
                            .text = std::move(found.text),
                            .files = result.at("files").get<std::vector<std::string>>()});
  } catch (const json::exception& error) {
    throw std::invalid_argument(fmt::format("BatchSummary: no result: {}", error.what()));
  }
}

std::size_t BatchSummary::count(JobStatus status) const {
  std::size_t sum = 0;
  for (const auto& [name, kind] : kinds_) sum += kind.count(status);
  return sum;
}

std::size_t BatchSummary::count() const {
  return count(JobStatus::done) + count(JobStatus::no) + count(JobStatus::failed);
}

std::string BatchSummary::document(std::size_t most_worst) const {
  ordered_json whole = {{"roadbed_batch", 1}, {"version", version()}};
  whole.update(
      counts_json(count(), count(JobStatus::done), count(JobStatus::no), count(JobStatus::failed)));
  whole["kinds"] = ordered_json::object();
  for (const auto& [kind, summary] : kinds_) {
    whole["kinds"][kind.empty() ? "(no job)" : kind] = kind_json(summary, most_worst);
  }
  return map::json_text(whole, 2) + "\n";
}

std::string with_commas(std::size_t number) {
  std::string text = std::to_string(number);
  constexpr std::size_t group = 3;
  for (std::size_t place = text.size(); place > group;) {
    place -= group;
    text.insert(place, 1, ',');
  }
  return text;
}

}  // namespace roadbed::tools::batch
