#include "roadbed/map/read_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "roadbed/map/input_error.h"

namespace roadbed::map {

std::string read_file(const std::filesystem::path& file) {
  std::error_code status_error;
  const auto status = std::filesystem::status(file, status_error);
  const auto refuse = [&](const std::string& found, const std::string& remedy) {
    throw InputError({.file = file.string(),
                      .place = {},
                      .element = {},
                      .found = found,
                      .needed = {},
                      .remedy = remedy});
  };
  if (!std::filesystem::exists(status)) refuse("no such file", "check the path");
  if (std::filesystem::is_directory(status)) refuse("is a folder", "name a file in it");
  if (!std::filesystem::is_regular_file(status)) refuse("is not a regular file", "name a file");

  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) refuse(std::string("cannot be opened: ") + std::strerror(errno), "check its rights");
  std::string bytes(std::filesystem::file_size(file), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) refuse("cannot be read to its end", "check the disk");
  if (bytes.empty()) refuse("is empty", "check how it was made");
  return bytes;
}

}  // namespace roadbed::map
