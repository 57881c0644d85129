#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace roadbed::map::inline files {

/// The entries of a folder whose names hold one text and end with another, in the order of the
/// numbers that they end with: shorter names first, then by letters. None where the folder cannot
/// be read.
std::vector<std::filesystem::path> files_named(const std::filesystem::path& folder,
                                               std::string_view part, std::string_view end);

}  // namespace roadbed::map::files
