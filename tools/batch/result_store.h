#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/batch/job_result.h"
#include "roadbed/tools/files/streamed_output.h"

namespace roadbed::tools::inline batch {

/// A line of a file of jobs, by its result.
struct LineResult {
  std::size_t line;  ///< from 1
  JobHash hash;
};

/// The results of a folder, as its journals hold them: `FOLDER/journal/NAME.jsonl`, a line each in
/// the order in which they came. Memory: about 120 bytes a result. May be used by several threads.
class ResultStore {
 public:
  /// Reads all journals, and makes nothing; of several results of a job an answer counts before a
  /// failure, else the last one of the last journal by name. What is no whole line does not
  /// count.
  /// @throws InputError if a journal cannot be read.
  explicit ResultStore(std::filesystem::path folder);

  /// Whether there is a result that the same job would come to again, or just any with
  /// `keeps_failed`. A line that is no result, or one of another job, and one whose files are gone
  /// or not as they were, do not count. Reads these files.
  /// @param job  null for a line that is none.
  bool stands(const JobHash& hash, const Job* job, bool keeps_failed = false) const;

  /// Adds a result to this run's journal, in place of any before.
  /// @throws OutputError if it cannot be written.
  void add(std::string_view line);

  /// The line of a result that is there.
  /// @throws std::invalid_argument if there is none; InputError if its journal cannot be read.
  std::string line(const JobHash& hash) const;

  std::size_t size() const { return entries_.size(); }

  /// Journals that were there.
  std::size_t journals() const { return journals_.size() - 1; }

 private:
  struct Entry {
    std::uint32_t journal;
    bool is_answer, may_change;
    std::uint64_t begin, size;
  };
  struct HashOfHash {
    std::size_t operator()(const JobHash& hash) const { return hash[0]; }
  };

  void read_journal(std::uint32_t index);
  void note(const ResultHead& head, const Entry& entry);

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> journals_;  // the last one is this run's
  std::unique_ptr<AppendedFile> own_;            // made with its first result
  mutable std::mutex mutex_;
  std::unordered_map<JobHash, Entry, HashOfHash> entries_;
};

}  // namespace roadbed::tools::batch
