#pragma once

#include <filesystem>
#include <string_view>

namespace roadbed::tools {

/// Checks before the work begins that `file` can be written later.
/// @throws InputError if its folder is missing or not writable, or the file exists and `force` is
///         not set.
void check_writable(const std::filesystem::path& file, bool force);

/// Makes the folder (with its parents) that a command writes several files to.
/// @throws InputError if it cannot be made, or holds something and `force` is not set.
void make_output_folder(const std::filesystem::path& folder, bool force);

/// Writes the bytes to a temporary file beside `file`, syncs it and renames it: at every moment
/// there is the old file, or the new one, whole.
/// @throws InputError if it cannot be written; nothing is left behind then.
void write_output(const std::filesystem::path& file, std::string_view bytes);

}  // namespace roadbed::tools
