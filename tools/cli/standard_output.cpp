#include "roadbed/tools/cli/standard_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>

#include "roadbed/map/files/visible_text.h"
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
  write_pending(true);
  std::cout.rdbuf(before_);
}

bool StandardOutput::finish() { return write_pending(true); }

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

// A character whose end is still to come stays in the buffer.
bool StandardOutput::write_pending(bool with_cut_character) {
  const std::string_view pending(pbase(), static_cast<std::size_t>(pptr() - pbase()));
  if (pending.empty()) return error_ == 0;
  const std::size_t whole =
      with_cut_character ? pending.size() : map::size_of_whole_characters(pending);
  shown_.clear();
  map::append_visible(pending.substr(0, whole), shown_);
  write(shown_);
  const std::string cut(pending.substr(whole));
  setp(pbase(), epptr());
  std::ranges::copy(cut, pbase());
  pbump(static_cast<int>(cut.size()));
  return error_ == 0;
}

void StandardOutput::write(std::string_view text) {
  while (error_ == 0 && !text.empty()) {
    const ssize_t size = ::write(STDOUT_FILENO, text.data(), text.size());
    if (size >= 0) {
      text.remove_prefix(static_cast<std::size_t>(size));
    } else if (errno != EINTR) {
      error_ = errno;
    }
  }
}

void hold_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0 || errno != EBADF) continue;
    // Open for the wrong use; the lowest number that is free is this one.
    static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

}  // namespace roadbed::tools::cli
