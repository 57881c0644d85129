#include "roadbed/tools/cli/standard_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>

#include "roadbed/map/storage/output_file.h"

namespace roadbed::tools::inline cli {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 16;

}  // namespace

StandardOutput::StandardOutput()
    : buffer_(kBufferSize),
      is_terminal_(::isatty(STDOUT_FILENO) == 1),
      before_(std::cout.rdbuf(this)) {
  setp(buffer_.data(), buffer_.data() + buffer_.size() - 1);  // the last is that of overflow()
}

StandardOutput::~StandardOutput() {
  write_pending();
  std::cout.rdbuf(before_);
}

bool StandardOutput::finish() { return write_pending(); }

std::string StandardOutput::fault() const {
  return map::OutputError(
             {.file = "standard output",
              .found = std::string("cannot be written: ") + std::strerror(error_),
              .remedy =
                  "send it to a file on a disk with free space, or to a program that reads it "
                  "to its end"})
      .what();
}

StandardOutput::int_type StandardOutput::overflow(int_type sign) {
  if (error_ != 0) return traits_type::eof();
  if (!traits_type::eq_int_type(sign, traits_type::eof())) {
    *pptr() = traits_type::to_char_type(sign);
    pbump(1);
  }
  return write_pending() ? traits_type::not_eof(sign) : traits_type::eof();
}

std::streamsize StandardOutput::xsputn(const char* text, std::streamsize size) {
  const std::streamsize taken = std::streambuf::xsputn(text, size);
  return is_terminal_ && !write_pending() ? 0 : taken;
}

int StandardOutput::sync() { return write_pending() ? 0 : -1; }

bool StandardOutput::write_pending() {
  const char* from = pbase();
  while (error_ == 0 && from < pptr()) {
    const ssize_t size = ::write(STDOUT_FILENO, from, static_cast<std::size_t>(pptr() - from));
    if (size >= 0) {
      from += size;
    } else if (errno != EINTR) {
      error_ = errno;
    }
  }
  if (pptr() != pbase()) setp(pbase(), epptr());
  return error_ == 0;
}

void hold_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    // Open for the wrong use; the lowest number that is free is this one.
    static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

}  // namespace roadbed::tools::cli
