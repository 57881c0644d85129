#include "roadbed/tools/files/streamed_output.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "roadbed/map/files/read_file.h"

namespace roadbed::tools::inline files {
namespace {

[[noreturn]] void refuse_line(const std::filesystem::path& file) {
  throw map::OutputError({.file = file.string(),
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

BufferedOutput::BufferedOutput(const std::filesystem::path& file, bool force) {
  if (!map::is_standard_stream(file)) file_.emplace(file, force);
}

void BufferedOutput::add(std::string_view bytes) {
  constexpr std::size_t piece = std::size_t{1} << 20;
  buffer_ += bytes;
  if (file_ && buffer_.size() >= piece) flush();
}

void BufferedOutput::commit() {
  if (!file_) return map::write_to_standard_output(buffer_);
  flush();
  file_->commit();
}

void BufferedOutput::flush() {
  file_->write(written_, buffer_);
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
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) refuse_line(file_);
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
    refuse_line(file_);
  }
  const std::uint64_t begin = size_;
  size_ += bytes.size();
  return begin;
}

}  // namespace roadbed::tools::files
