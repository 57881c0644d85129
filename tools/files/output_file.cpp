#include "roadbed/tools/files/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace roadbed::tools::inline files {
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
  if (descriptor < 0)
    return;  // the file itself is synced; some systems refuse_output to open folders
  ::fsync(descriptor);
  ::close(descriptor);
}

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw OutputError({.file = file.string(),
                     .found = std::string("cannot be written: ") + std::strerror(errno),
                     .remedy = "free some space and run again: what is done stays done"});
}

// Returns how much of the bytes was written.
std::size_t write_all(int descriptor, std::string_view bytes) {
  std::size_t written = 0;
  while (written < bytes.size()) {
    const ssize_t more = ::write(descriptor, bytes.data() + written, bytes.size() - written);
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) break;
    written += static_cast<std::size_t>(more);
  }
  return written;
}

}  // namespace

void check_writable(const std::filesystem::path& file, bool force) {
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

void write_output(const std::filesystem::path& file, std::string_view bytes) {
  OutputFile output(file);
  output.write(0, bytes);
  output.commit();
}

void BufferedOutput::add(std::string_view bytes) {
  constexpr std::size_t piece = std::size_t{1} << 20;
  buffer_ += bytes;
  if (buffer_.size() >= piece) flush();
}

void BufferedOutput::commit() {
  flush();
  file_.commit();
}

void BufferedOutput::flush() {
  file_.write(written_, buffer_);
  written_ += buffer_.size();
  buffer_.clear();
}

AppendedFile::AppendedFile(std::filesystem::path file) : file_(std::move(file)) {}

AppendedFile::~AppendedFile() {
  if (descriptor_ < 0) return;
  ::fsync(descriptor_);
  ::close(descriptor_);
}

void AppendedFile::open() {
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) refuse(file_);
  size_ = static_cast<std::uint64_t>(status.st_size);
}

std::uint64_t AppendedFile::append(std::string_view line) {
  if (descriptor_ < 0) open();
  const std::string bytes = std::string(line) + '\n';
  const std::size_t written = write_all(descriptor_, bytes);
  if (written < bytes.size()) {
    const int cause = errno;
    // What is left of it if this fails too is no whole line, and passed over by readers.
    if (::ftruncate(descriptor_, static_cast<off_t>(size_)) != 0) size_ += written;
    errno = cause;
    refuse(file_);
  }
  const std::uint64_t begin = size_;
  size_ += bytes.size();
  return begin;
}

}  // namespace roadbed::tools
