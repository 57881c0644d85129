#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline storage {

/// An output that cannot be written, for want of space or rights: no fault of the inputs.
class OutputError : public InputError {
 public:
  using InputError::InputError;
};

[[noreturn]] void refuse_output(const std::filesystem::path& output, const std::string& found,
                                const std::string& remedy);

/// Says why, by errno.
[[noreturn]] void refuse_write(const std::filesystem::path& output);

/// No output replaces an input, under whatever name.
/// @throws OutputError if `output` is one of `inputs`.
void refuse_input(const std::filesystem::path& output,
                  const std::vector<std::filesystem::path>& inputs);

/// Where an output goes, and what is there now.
struct OutputPlace {
  std::filesystem::path path;  ///< behind links, so that it is not the link that is replaced
  std::optional<struct stat> there;
};

/// Looks at the place of an output.
/// @throws OutputError if it cannot be looked at, for any other reason than that nothing is there;
///         if it is a link that leads nowhere, or one that somebody else left in a folder where
///         everybody may make files.
OutputPlace look_at_output(const std::filesystem::path& output);

/// The folder that a file or folder is in.
std::filesystem::path folder_around(const std::filesystem::path& path);

/// Name `number` of an output in the making: hidden, beside it, and the same in each run, so that a
/// later one finds what a run that was killed has left. Whoever writes has the file locked by
/// flock.
std::filesystem::path name_in_the_making(const std::filesystem::path& output, unsigned number);

/// Removes what runs that were killed left of this output in the making.
void remove_abandoned(const std::filesystem::path& output);

/// Takes a name in the making that nobody uses. `make` makes it, and says whether it did; errno is
/// EEXIST where it is taken.
/// @throws OutputError if it cannot be made.
std::filesystem::path take_name(const std::filesystem::path& output,
                                const std::function<bool(const std::filesystem::path&)>& make);

/// Whether what was opened stands under a name still.
bool is_still_there(const std::filesystem::path& name, int descriptor);

/// Locks what was just opened under a name; false if somebody took it for abandoned meanwhile.
bool lock_in_the_making(int descriptor);

/// Gives what is open the permissions, and where that is allowed the owner, of what it replaces.
/// Never gives another group what the old one had.
/// @throws OutputError if it cannot have them.
void keep_permissions(int descriptor, const struct stat& old, const std::filesystem::path& output);

/// Renames if nothing is there. Returns false with errno, EEXIST where something is.
bool rename_to_free_name(const std::filesystem::path& from, const std::filesystem::path& to);

/// Waits until the names in a folder are on the disk.
void sync_folder(const std::filesystem::path& folder);

}  // namespace roadbed::map::storage
