#include "roadbed/tools/batch/buffered_output.h"

namespace roadbed::tools::inline batch {

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

}  // namespace roadbed::tools
