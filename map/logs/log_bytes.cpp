#include "roadbed/map/logs/log_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline logs {

LogBytes::LogBytes(const std::filesystem::path& file) : name_(file.string()) {
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    throw InputError({.file = name_,
                      .found = std::string("cannot be opened: ") + std::strerror(errno),
                      .remedy = "check its rights"});
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

LogBytes::LogBytes(std::string_view bytes, std::string name)
    : name_(std::move(name)), bytes_(bytes), size_(bytes.size()) {}

LogBytes::~LogBytes() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::string_view LogBytes::read(std::uint64_t offset, std::uint64_t count) {
  if (offset > size_ || size_ - offset < count) {
    throw InputError({.file = name_,
                      .place = fmt::format("byte {}", offset),
                      .found = fmt::format("ends at byte {}", size_),
                      .needed = fmt::format("{} bytes more", count),
                      .remedy = "copy the log anew, or let its own tool recover what there is"});
  }
  if (descriptor_ < 0) return bytes_.substr(offset, count);
  if (buffer_.size() < count) buffer_.resize(count);
  std::size_t there = 0;
  while (there < count) {
    const ssize_t got = ::pread(descriptor_, buffer_.data() + there, count - there,
                                static_cast<off_t>(offset + there));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      throw InputError(
          {.file = name_, .found = "cannot be read to its end", .remedy = "check the disk"});
    }
    there += static_cast<std::size_t>(got);
  }
  return std::string_view(buffer_).substr(0, count);
}

}  // namespace roadbed::map::logs
