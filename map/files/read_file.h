#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace roadbed::map::inline files {

/// The bytes of a regular file.
/// @throws InputError if it is missing, not a regular file, unreadable or empty.
std::string read_file(const std::filesystem::path& file);

/// Its first bytes, at most `size`.
/// @throws InputError as read_file does.
std::string read_file_start(const std::filesystem::path& file, std::size_t size);

}  // namespace roadbed::map::files
