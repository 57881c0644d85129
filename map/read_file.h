#pragma once

#include <filesystem>
#include <string>

namespace roadbed::map {

/// The bytes of a regular file.
/// @throws InputError if it is missing, not a regular file, unreadable or empty.
std::string read_file(const std::filesystem::path& file);

}  // namespace roadbed::map
