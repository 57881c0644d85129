#include "roadbed/tools/batch/result_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/storage/output_folder.h"
#include "roadbed/tools/batch/batch_summary.h"
#include "roadbed/tools/batch/job.h"
#include "roadbed/tools/batch/job_lines.h"
#include "roadbed/tools/files/streamed_output.h"

namespace roadbed::tools::inline batch {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestResult = std::size_t{1} << 30;

std::vector<fs::path> journals_in(const fs::path& folder) {
  std::vector<fs::path> journals;
  if (!map::is_there(folder)) return journals;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (map::is_file(entry.path()) && entry.path().extension() == ".jsonl") {
      journals.push_back(entry.path());
    }
  }
  std::ranges::sort(journals);
  return journals;
}

// Journals of our own are numbered; others may have any name.
fs::path next_journal(const fs::path& folder) {
  for (unsigned number = 1;; ++number) {
    fs::path journal = folder / fmt::format("{:06}.jsonl", number);
    if (!map::is_there(journal)) return journal;
  }
}

[[noreturn]] void refuse(const fs::path& journal) {
  throw map::InputError({.file = journal.string(),
                         .found = "cannot be read",
                         .remedy = "check its rights, or remove it: its jobs run again"});
}

bool is_as_it_was(const fs::path& folder, const std::string& file, const std::string& sha256) {
  const fs::path path = fs::path(file).lexically_normal();
  if (path.is_absolute() || *path.begin() == "..") return false;
  try {
    return sha256_of_output(folder / path) == sha256;
  } catch (const map::InputError&) {  // it is gone
    return false;
  }
}

bool are_as_they_were(const ResultHead& head, const fs::path& folder) {
  return std::ranges::equal(head.files, head.sha256, [&](const auto& file, const auto& sha256) {
    return is_as_it_was(folder, file, sha256);
  });
}

// Journals are no more to be believed than other inputs.
bool is_result_of(const std::string& line, const Job* job) {
  const auto result = nlohmann::json::parse(line, nullptr, false);
  try {
    BatchSummary(1).add(1, line);
  } catch (const std::invalid_argument&) {
    return false;
  }
  if (job == nullptr) return result.at("job").is_null();
  return result.at("job") == job->kind->name && result.at("inputs") == job->inputs &&
         result.at("options") == job->options &&
         result.value("outputs", nlohmann::json()) == job->outputs;
}

}  // namespace

ResultStore::ResultStore(fs::path folder) : folder_(std::move(folder)) {
  const fs::path journals = folder_ / "journal";
  journals_ = journals_in(journals);
  for (std::uint32_t i = 0; i < journals_.size(); ++i) read_journal(i);
  journals_.push_back(next_journal(journals));
}

void ResultStore::read_journal(std::uint32_t index) {
  std::ifstream stream(journals_[index], std::ios::binary);
  if (!stream) refuse(journals_[index]);
  JobLines lines(stream, kLongestResult);
  while (const auto line = lines.next()) {
    if (!line->is_whole || line->is_too_long) continue;
    const auto head = read_head(line->text);
    if (!head) continue;
    note(*head, {.journal = index,
                 .is_answer = head->status != JobStatus::failed,
                 .may_change = head->may_change(),
                 .begin = line->begin,
                 .size = line->text.size()});
  }
}

void ResultStore::note(const ResultHead& head, const Entry& entry) {
  const auto [found, is_new] = entries_.try_emplace(head.hash, entry);
  if (is_new || entry.is_answer || !found->second.is_answer) found->second = entry;
}

bool ResultStore::stands(const JobHash& hash, const Job* job, bool keeps_failed) const {
  {
    const std::scoped_lock lock(mutex_);
    const auto found = entries_.find(hash);
    if (found == entries_.end() || (found->second.may_change && !keeps_failed)) return false;
  }
  const std::string text = line(hash);
  const auto head = read_head(text);
  return head && head->hash == hash && is_result_of(text, job) && are_as_they_were(*head, folder_);
}

void ResultStore::add(std::string_view line) {
  const auto head = read_head(line);
  if (!head) throw std::invalid_argument("ResultStore::add: the line is no result");
  const std::scoped_lock lock(mutex_);
  if (!own_) {
    map::make_output_folder(folder_ / "journal", true);
    own_ = std::make_unique<AppendedFile>(journals_.back());
  }
  const std::uint64_t begin = own_->append(line);
  entries_[head->hash] = {.journal = static_cast<std::uint32_t>(journals_.size() - 1),
                          .is_answer = head->status != JobStatus::failed,
                          .may_change = head->may_change(),
                          .begin = begin,
                          .size = line.size()};
}

std::string ResultStore::line(const JobHash& hash) const {
  const std::scoped_lock lock(mutex_);
  const auto found = entries_.find(hash);
  if (found == entries_.end()) {
    throw std::invalid_argument("ResultStore::line: no result of " + text_of(hash));
  }
  const Entry& entry = found->second;
  std::ifstream stream(journals_[entry.journal], std::ios::binary);
  std::string line(entry.size, '\0');
  stream.seekg(static_cast<std::streamoff>(entry.begin));
  stream.read(line.data(), static_cast<std::streamsize>(line.size()));
  if (!stream) refuse(journals_[entry.journal]);
  return line;
}

}  // namespace roadbed::tools::batch
