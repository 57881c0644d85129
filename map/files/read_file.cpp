#include "roadbed/map/files/read_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline files {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& found,
                         const std::string& remedy) {
  throw InputError({.file = file.string(), .found = found, .remedy = remedy});
}

void check_regular(const std::filesystem::path& file) {
  std::error_code status_error;
  const auto status = std::filesystem::status(file, status_error);
  if (!std::filesystem::exists(status)) refuse(file, "no such file", "check the path");
  if (std::filesystem::is_directory(status)) refuse(file, "is a folder", "name a file in it");
  if (!std::filesystem::is_regular_file(status)) {
    refuse(file, "is not a regular file", "name a file");
  }
}

}  // namespace

std::string read_file(const std::filesystem::path& file) {
  return read_file_start(file, std::numeric_limits<std::size_t>::max());
}

std::string read_file_start(const std::filesystem::path& file, std::size_t size) {
  check_regular(file);
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    refuse(file, std::string("cannot be opened: ") + std::strerror(errno), "check its rights");
  }
  std::string bytes(std::min<std::uintmax_t>(size, std::filesystem::file_size(file)), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) refuse(file, "cannot be read to its end", "check the disk");
  if (bytes.empty()) refuse(file, "is empty", "check how it was made");
  return bytes;
}

}  // namespace roadbed::map::files
