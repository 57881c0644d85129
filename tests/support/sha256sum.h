#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace roadbed::tests {

/// The SHA-256 of a file, or of bytes, as coreutils' sha256sum prints it.
std::string sha256sum_of(const std::filesystem::path& file);
std::string sha256sum_of_bytes(std::string_view bytes);

}  // namespace roadbed::tests
