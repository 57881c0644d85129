#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "roadbed/tools/batch/file_hashes.h"
#include "roadbed/tools/batch/recently_used.h"
#include "roadbed/tools/cli/inputs.h"

namespace roadbed::tools::inline batch {

/// Inputs that stay loaded, for many jobs on the same files. A thing is kept under its files' names
/// and counts as long as these are as they were before and after it was made, in their bytes and in
/// their time of change: else it is made anew. So a job gets what it would load itself.
///
/// At most `kMost` things are kept. Those that no job has in use go, the least recently used first,
/// whenever one is made while memory is above the limit.
class InputCache final : public Inputs {
 public:
  static constexpr std::size_t kMost = 64;

  /// @param files  that jobs are known by; lives as long as this.
  /// @param resident  bytes that are taken now; may be asked by several threads.
  InputCache(FileHashes& files, std::uint64_t limit, std::function<std::uint64_t()> resident);

  /// Lets go of what no job has in use until memory is within `limit` bytes. Returns whether there
  /// was any.
  bool shrink(std::uint64_t limit) const;

  /// How often a thing was made.
  std::size_t made() const;

 private:
  /// A thing, or none yet; one thread makes it, others wait.
  struct Slot {
    std::mutex mutex;
    std::string state;  // of its files
    Thing thing;
  };

  Thing get(const std::string& what, const std::vector<std::filesystem::path>& files,
            const std::function<Thing()>& make) const override;
  std::shared_ptr<Slot> slot_of(const std::string& name) const;
  std::string state_of(const std::vector<std::filesystem::path>& files) const;

  FileHashes& files_;
  std::uint64_t limit_;
  std::function<std::uint64_t()> resident_;
  mutable std::mutex mutex_;  // of what follows
  mutable RecentlyUsed<std::shared_ptr<Slot>> slots_{kMost};
  mutable std::size_t made_ = 0;
};

}  // namespace roadbed::tools::batch
