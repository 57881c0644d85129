#pragma once

#include <filesystem>

namespace roadbed::tools::inline batch {

/// Whether a folder is one that batches have been at work in.
bool is_of_batch(const std::filesystem::path& folder);

/// @throws OutputError if the jobs are read from a file that a batch in the folder writes.
void refuse_own_file(const std::filesystem::path& folder, const std::filesystem::path& jobs_file);

/// Keeps a folder to one run at a time, by flock on the file `lock` in it: gone with the process,
/// however it ends.
class FolderLock {
 public:
  /// @throws InputError if another run has it; OutputError if the file cannot be made, or a name
  ///         that is the batch's own is a link.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// Marks a folder as being worked in, by the file `unfinished` in it. Where the mark was left
/// behind by a run that was killed, half-written files are swept away first: those of the pages,
/// and those below `files`, `journal` and `tables`, and no others.
class UnfinishedMark {
 public:
  /// @throws OutputError if the mark cannot be made.
  explicit UnfinishedMark(const std::filesystem::path& folder);

  /// All is finished.
  void remove();

 private:
  std::filesystem::path mark_;
};

}  // namespace roadbed::tools::batch
