#include "roadbed/tools/batch/job_lines.h"

#include <algorithm>

namespace roadbed::tools::inline batch {
namespace {

bool is_blank(const std::string& text) {
  return text.find_first_not_of(" \t\r") == std::string::npos;
}

}  // namespace

std::optional<JobLines::Line> JobLines::next() {
  std::optional<Line> line = read();
  while (line && is_blank(line->text) && !line->is_too_long) line = read();
  return line;
}

std::optional<JobLines::Line> JobLines::read() {
  using Traits = std::istream::traits_type;
  std::streambuf& bytes = *input_.rdbuf();
  if (Traits::eq_int_type(bytes.sgetc(), Traits::eof())) return {};
  Line line{
      .number = ++number_, .begin = bytes_, .text = {}, .is_too_long = false, .is_whole = false};
  for (auto sign = bytes.sbumpc(); !Traits::eq_int_type(sign, Traits::eof());
       sign = bytes.sbumpc()) {
    ++bytes_;
    if (Traits::to_char_type(sign) == '\n') {
      line.is_whole = true;
      break;
    }
    if (line.text.size() < longest_) {
      line.text += Traits::to_char_type(sign);
    } else {
      line.is_too_long = true;
    }
  }
  return line;
}

}  // namespace roadbed::tools::batch
