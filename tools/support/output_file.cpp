#include "roadbed/tools/support/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "roadbed/map/input_error.h"

namespace roadbed::tools {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& found,
                         const std::string& remedy) {
  throw map::InputError({.file = file.string(),
                         .place = {},
                         .element = {},
                         .found = found,
                         .needed = {},
                         .remedy = remedy});
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

void write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw std::system_error(errno, std::generic_category());
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // the file itself is synced; some systems refuse to open folders
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void check_writable(const std::filesystem::path& file, bool force) {
  const auto folder = folder_of(file);
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    refuse(file, "cannot be written: its folder does not exist", "make the folder first");
  }
  if (std::filesystem::is_directory(file, error)) refuse(file, "is a folder", "name a file in it");
  if (std::filesystem::exists(file, error) && !force) {
    refuse(file, "exists already", "give --force to replace it");
  }
  if (::access(folder.c_str(), W_OK) != 0) {
    refuse(file, std::string("cannot be written: ") + std::strerror(errno),
           "choose a folder that you may write to");
  }
}

void make_output_folder(const std::filesystem::path& folder, bool force) {
  std::error_code error;
  if (std::filesystem::exists(folder, error) && !std::filesystem::is_directory(folder, error)) {
    refuse(folder, "exists and is not a folder", "choose another place");
  }
  if (std::filesystem::is_directory(folder, error)) {
    if (!std::filesystem::is_empty(folder, error) && !force) {
      refuse(folder, "holds files already", "give --force to replace them");
    }
  } else if (!std::filesystem::create_directories(folder, error)) {
    refuse(folder, "cannot be made: " + error.message(), "choose a folder that you may write to");
  }
  if (::access(folder.c_str(), W_OK) != 0) {
    refuse(folder, std::string("cannot be written: ") + std::strerror(errno),
           "choose a folder that you may write to");
  }
}

void write_output(const std::filesystem::path& file, std::string_view bytes) {
  std::string temporary = (folder_of(file) / ("." + file.filename().string() + ".XXXXXX")).string();
  const int descriptor = ::mkostemp(temporary.data(), O_CLOEXEC);
  if (descriptor < 0) {
    refuse(file, std::string("cannot be written: ") + std::strerror(errno),
           "choose a folder that you may write to");
  }
  try {
    write_all(descriptor, bytes);
    const mode_t mask = ::umask(0);
    ::umask(mask);
    if (::fchmod(descriptor, 0666 & ~mask) != 0 || ::fsync(descriptor) != 0) {
      throw std::system_error(errno, std::generic_category());
    }
    if (::rename(temporary.c_str(), file.c_str()) != 0) {
      throw std::system_error(errno, std::generic_category());
    }
  } catch (const std::system_error& error) {
    ::close(descriptor);
    ::unlink(temporary.c_str());
    refuse(file, std::string("cannot be written: ") + error.code().message(),
           "free some space or choose another folder");
  }
  ::close(descriptor);
  sync_folder(folder_of(file));
}

}  // namespace roadbed::tools
