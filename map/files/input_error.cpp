#include "roadbed/map/files/input_error.h"

#include <fmt/format.h>

namespace roadbed::map::inline files {
namespace {

// Keeps the message on one line whatever bytes the input held.
std::string printable(const std::string& text) {
  constexpr std::size_t longest = 400;
  std::string line;
  for (const char c : text.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      line += fmt::format("\\x{:02x}", byte);
    } else {
      line += c;
    }
  }
  return text.size() > longest ? line + "…" : line;
}

std::string one_line(const InputError::Parts& parts) {
  std::string message = printable(parts.file);
  const auto append = [&message](const char* sign, const std::string& part) {
    if (!part.empty()) message.append(sign).append(printable(part));
  };
  append(":", parts.place);
  append(": ", parts.element);
  append(": ", parts.found);
  append(", needs ", parts.needed);
  append("; ", parts.remedy);
  return message;
}

}  // namespace

InputError::InputError(const Parts& parts)
    : std::runtime_error(one_line(parts)), parts_(std::make_shared<const Parts>(parts)) {}

}  // namespace roadbed::map::files
