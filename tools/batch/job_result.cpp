#include "roadbed/tools/batch/job_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/parse_json.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/tools/batch/job.h"
#include "roadbed/tools/cli/command.h"

namespace roadbed::tools::inline batch {
namespace {

using nlohmann::json;

std::string json_text(const json& value) { return map::json_text(value); }

// Members in this order, so that a reader sees first what became of the job.
std::string line(const JobResult& result, const json& kind, const std::string& rest) {
  return "{\"hash\":" + json_text(result.hash) + ",\"job\":" + json_text(kind) +
         ",\"status\":" + json_text(to_string(result.status)) +
         ",\"exit\":" + (result.exit ? std::to_string(*result.exit) : "null") +
         ",\"reason\":" + json_text(result.reason) +
         ",\"cause\":" + (result.cause ? json_text(to_string(*result.cause)) : "null") + rest +
         ",\"result\":" + (result.document.empty() ? "null" : result.document) +
         ",\"files\":" + json_text(result.files) + ",\"sha256\":" + json_text(result.sha256) + "}";
}

std::string one_line(std::string text) {
  text = map::one_line(std::move(text));
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

constexpr std::size_t kDigits = 16;  // of each part

bool is_document(std::string_view key) {
  return key == "result" || key == "options" || key == "inputs";
}

// The documents of commands are read through, but not kept. Null where there is no object.
json parse_without_documents(std::string_view line) {
  json head = json::object();
  const auto take = [&](std::span<const std::string> keys, json part) {
    if (keys.empty()) {
      if (!part.is_object()) head = nullptr;
    } else if (!is_document(keys.front())) {
      head[keys.front()] = std::move(part);
    }
  };
  try {
    map::parse_json_parts(line, "journal", {.keys_stand_once = false}, 1, take);
  } catch (const json::exception&) {
    return nullptr;
  } catch (const map::InputError&) {  // more than a line of its size may hold
    return nullptr;
  }
  return head;
}

template <typename Value, typename... Values>
std::optional<Value> by_name(const json& text, Values... values) {
  for (const Value value : {values...}) {
    if (text == to_string(value)) return value;
  }
  return {};
}

std::optional<JobHash> hash_in(const json& head) {
  const auto text = head.find("hash");
  return text != head.end() && text->is_string() ? parse_hash(text->get<std::string>())
                                                 : std::nullopt;
}

bool read_texts(const json& head, const char* key, std::vector<std::string>& texts) {
  const auto list = head.find(key);
  if (list == head.end() || !list->is_array()) return false;
  for (const json& text : *list) {
    if (!text.is_string()) return false;
    texts.push_back(text.get<std::string>());
  }
  return true;
}

}  // namespace

std::string_view to_string(JobStatus status) {
  constexpr std::array<std::string_view, 3> names{"done", "no", "failed"};
  return names.at(static_cast<std::size_t>(status));
}

std::string_view to_string(Cause cause) {
  constexpr std::array<std::string_view, 8> names{"line", "input",  "changed", "crash",
                                                  "time", "memory", "disk",    "internal"};
  return names.at(static_cast<std::size_t>(cause));
}

bool may_pass(Cause cause) { return cause != Cause::line && cause != Cause::input; }

std::string line_of(const Job& job, const JobResult& result) {
  return line(result, job.kind->name,
              ",\"inputs\":" + json_text(job.inputs) + ",\"options\":" + json_text(job.options) +
                  ",\"outputs\":" + json_text(job.outputs));
}

std::string line_of_bad_line(std::string_view text, const std::string& reason) {
  return line(failure(hash_of_bad_line(text), Cause::line, static_cast<int>(Exit::usage), reason),
              nullptr, R"(,"inputs":[],"options":{},"outputs":[])");
}

JobResult failure(std::string hash, Cause cause, std::optional<int> exit, std::string reason) {
  return {.hash = std::move(hash),
          .status = JobStatus::failed,
          .exit = exit,
          .reason = one_line(std::move(reason)),
          .cause = cause};
}

std::optional<JobHash> parse_hash(std::string_view text) {
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  if (text.size() != kHashDigits || !std::ranges::all_of(text, is_digit)) return {};
  JobHash hash{};
  for (std::size_t part = 0; part < hash.size(); ++part) {
    const char* const from = text.data() + part * kDigits;
    std::from_chars(from, from + kDigits, hash.at(part), 16);
  }
  return hash;
}

std::string text_of(const JobHash& hash) { return fmt::format("{:016x}", fmt::join(hash, "")); }

std::optional<ResultHead> read_head(std::string_view line) {
  const json head = parse_without_documents(line);
  if (!head.is_object()) return {};
  const auto hash = hash_in(head);
  const auto status = by_name<JobStatus>(head.value("status", json()), JobStatus::done,
                                         JobStatus::no, JobStatus::failed);
  const json cause = head.value("cause", json());
  ResultHead result{
      .hash = {}, .status = JobStatus::failed, .cause = {}, .files = {}, .sha256 = {}};
  if (!hash || !status || !read_texts(head, "files", result.files) ||
      !read_texts(head, "sha256", result.sha256) || result.files.size() != result.sha256.size()) {
    return {};
  }
  result.hash = *hash;
  result.status = *status;
  result.cause = by_name<Cause>(cause, Cause::line, Cause::input, Cause::changed, Cause::crash,
                                Cause::time, Cause::memory, Cause::disk, Cause::internal);
  const bool has_failed = result.status == JobStatus::failed;
  if (has_failed != result.cause.has_value() || (!has_failed && !cause.is_null())) return {};
  return result;
}

}  // namespace roadbed::tools::batch
