#include "roadbed/map/storage/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "roadbed/map/files/read_file.h"

namespace roadbed::map::inline storage {
namespace {

[[noreturn]] void refuse_output(const std::filesystem::path& file, const std::string& found,
                                const std::string& remedy) {
  throw OutputError({.file = file.string(), .found = found, .remedy = remedy});
}

[[noreturn]] void refuse_write(const std::filesystem::path& file) {
  refuse_output(file, std::string("cannot be written: ") + std::strerror(errno),
                "free some space or choose another folder");
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

/// Where a link leads, so that it is not the link that is replaced.
std::filesystem::path behind_links(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_symlink(file, error)) return file;
  const std::filesystem::path target = std::filesystem::canonical(file, error);
  return error ? file : target;
}

/// Replaced by a file, a device such as /dev/null would be lost to all programs.
void refuse_other_than_file(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (std::filesystem::is_directory(status))
    refuse_output(file, "is a folder", "name a file in it");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    refuse_output(file, "is a device or a pipe, which a file would replace", "name a file");
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
  if (is_standard_stream(file)) return;
  const auto folder = folder_of(behind_links(file));
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    refuse_output(file, "cannot be written: its folder does not exist", "make the folder first");
  }
  refuse_other_than_file(file);
  if (std::filesystem::exists(file, error) && !force) {
    refuse_output(file, "exists already", "give --force to replace it");
  }
  if (::access(folder.c_str(), W_OK) != 0) {
    refuse_output(file, std::string("cannot be written: ") + std::strerror(errno),
                  "choose a folder that you may write to");
  }
}

void make_output_folder(const std::filesystem::path& folder, bool force) {
  std::error_code error;
  if (std::filesystem::exists(folder, error) && !std::filesystem::is_directory(folder, error)) {
    refuse_output(folder, "exists and is not a folder", "choose another place");
  }
  if (std::filesystem::is_directory(folder, error)) {
    if (!std::filesystem::is_empty(folder, error) && !force) {
      refuse_output(folder, "holds files already", "give --force to replace them");
    }
  } else if (!std::filesystem::create_directories(folder, error)) {
    refuse_output(folder, "cannot be made: " + error.message(),
                  "choose a folder that you may write to");
  }
  if (::access(folder.c_str(), W_OK) != 0) {
    refuse_output(folder, std::string("cannot be written: ") + std::strerror(errno),
                  "choose a folder that you may write to");
  }
}

OutputFile::OutputFile(const std::filesystem::path& file) : file_(behind_links(file)) {
  refuse_other_than_file(file_);
  // Not by mkstemp: its files have rights of their own, and the process's mask, which says what
  // they should be, can only be read by changing it under the feet of other threads.
  static std::atomic<unsigned> next = 0;
  const auto stem = (folder_of(file_) / ("." + file_.filename().string())).string();
  do {
    temporary_ = fmt::format("{}.{}-{}", stem, ::getpid(), next++);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0) {
    temporary_.clear();
    refuse_output(file_, std::string("cannot be written: ") + std::strerror(errno),
                  "choose a folder that you may write to");
  }
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::write(std::uint64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) refuse_write(file_);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void OutputFile::commit() {
  if (::fsync(descriptor_) != 0 || ::rename(temporary_.c_str(), file_.c_str()) != 0) {
    refuse_write(file_);
  }
  temporary_.clear();
  sync_folder(folder_of(file_));
}

void write_to_standard_output(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) refuse_write("standard output");
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void write_output(const std::filesystem::path& file, std::string_view bytes) {
  if (is_standard_stream(file)) return write_to_standard_output(bytes);
  OutputFile output(file);
  output.write(0, bytes);
  output.commit();
}

}  // namespace roadbed::map::storage
