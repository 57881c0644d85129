#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/storage/output_place.h"

namespace roadbed::map::inline storage {

/// What a command may do with a folder that it writes to.
struct OutputFolderOptions {
  bool force = false;  ///< the folder may hold files already
  /// Whether a file of the old folder goes, though there is no new one of its name: one that would
  /// be taken for the new command's. What else the user keeps in it stays.
  std::function<bool(const std::string& name)> is_dropped = [](const std::string&) {
    return false;
  };
  std::vector<std::filesystem::path> inputs = {};  ///< never replaced
};

/// A folder of files that belong together: made beside the old one, under a hidden name, when its
/// first file is there, and put in its place in one step. At every moment there is the old folder,
/// or the new one, whole; without `commit` nothing is left behind, and what a kill left is removed
/// when the same output is written again. Files and the folder have the permissions of those that
/// they replace.
///
/// Where that step cannot be done (the folder is a mount, the current one, or in one that may not
/// be written to; a file system without RENAME_EXCHANGE), the files are put in place one by one, in
/// the order in which they were written: then each is the old one or the new one.
class OutputFolder {
 public:
  /// Makes nothing yet.
  /// @throws OutputError if it cannot be made, or holds something and `force` is not set.
  explicit OutputFolder(const std::filesystem::path& folder, OutputFolderOptions options = {});
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where its files are until they are put in place, for who writes them himself.
  /// @throws OutputError if it cannot be made.
  const std::filesystem::path& in_the_making();

  /// Writes a file of it.
  /// @throws OutputError if it cannot be written.
  void write(std::string_view name, std::string_view bytes);

  /// Puts the folder in place.
  /// @throws OutputError if it cannot be, an input would be replaced, or without `force` if there
  ///         is something by now.
  void commit();

 private:
  void check_parent() const;
  void make_parents();
  std::filesystem::path name_beside_or_in() const;
  void check_inputs() const;
  void keep_permissions_of_files() const;
  void exchange();
  bool exchange_names();
  void put_files_one_by_one();

  OutputPlace place_;
  OutputFolderOptions options_;
  std::vector<std::filesystem::path> made_parents_;  // the outermost last
  std::filesystem::path hidden_;
  int descriptor_ = -1;      // of the folder in the making, locked
  int old_descriptor_ = -1;  // of the one that it replaces, locked too while that is hidden
  bool is_beside_ = true;
  bool has_exchanged_ = false;      // the hidden name is the old folder's
  std::vector<std::string> names_;  // in the order in which they were written
};

/// Makes the folder (with its parents) that a command goes on working in for long.
/// @throws OutputError if it cannot be made, or holds something and `force` is not set.
void make_output_folder(const std::filesystem::path& folder, bool force);

}  // namespace roadbed::map::storage
