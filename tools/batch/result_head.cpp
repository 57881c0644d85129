#include "roadbed/tools/batch/result_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

namespace roadbed::tools::inline batch {
namespace {

using nlohmann::json;

constexpr std::size_t kDigits = 16;  // of each part

// The documents of commands are read through, but not kept.
json parse_without_documents(std::string_view line) {
  constexpr int kMember = 1;
  const auto keep = [is_document = false](int depth, json::parse_event_t event,
                                          json& value) mutable {
    if (event == json::parse_event_t::key && depth == kMember) {
      is_document = value == "result" || value == "options" || value == "inputs";
    }
    return !is_document || event == json::parse_event_t::key ||
           (depth == 0 && event == json::parse_event_t::object_end);
  };
  return json::parse(line, keep, false);
}

template <typename Value, typename... Values>
std::optional<Value> by_name(const json& text, Values... values) {
  for (const Value value : {values...}) {
    if (text == name(value)) return value;
  }
  return {};
}

std::optional<JobHash> hash_in(const json& head) {
  const auto text = head.find("hash");
  return text != head.end() && text->is_string() ? parse_hash(text->get<std::string>())
                                                 : std::nullopt;
}

bool read_files(const json& head, std::vector<std::string>& files) {
  const auto list = head.find("files");
  if (list == head.end() || !list->is_array()) return false;
  for (const json& file : *list) {
    if (!file.is_string()) return false;
    files.push_back(file.get<std::string>());
  }
  return true;
}

}  // namespace

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
  ResultHead result{.hash = {}, .status = JobStatus::failed, .cause = {}, .files = {}};
  if (!hash || !status || !read_files(head, result.files)) return {};
  result.hash = *hash;
  result.status = *status;
  result.cause = by_name<Cause>(cause, Cause::line, Cause::input, Cause::changed, Cause::crash,
                                Cause::time, Cause::memory, Cause::disk, Cause::internal);
  const bool has_failed = result.status == JobStatus::failed;
  if (has_failed != result.cause.has_value() || (!has_failed && !cause.is_null())) return {};
  return result;
}

}  // namespace roadbed::tools
