#include "roadbed/map/files/input_error.h"

#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::inline files {
namespace {

// Keeps the message on one line whatever the input held.
std::string printable(const std::string& text) {
  constexpr std::size_t longest = 400;
  if (text.size() <= longest) return one_line(text);
  const std::string start = text.substr(0, longest);
  return one_line(start.substr(0, size_of_whole_characters(start))) + "…";
}

std::string message_of(const InputError::Parts& parts) {
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
    : std::runtime_error(message_of(parts)), parts_(std::make_shared<const Parts>(parts)) {}

}  // namespace roadbed::map::files
