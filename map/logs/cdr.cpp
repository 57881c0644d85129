#include "roadbed/map/logs/cdr.h"

#include <fmt/format.h>

#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::inline logs {

Cdr::Cdr(std::string_view message, std::string file, std::string place)
    : file_(std::move(file)), place_(std::move(place)) {
  constexpr std::size_t head = 4;
  if (message.size() < head || message[0] != 0 || (message[1] != 0 && message[1] != 1)) {
    refuse("does not begin as plain CDR", "00 00 or 00 01 and two bytes more");
  }
  is_big_ = message[1] == 0;
  body_ = message.substr(head);
}

std::string Cdr::text() {
  const auto size = number<std::uint32_t>();
  std::string_view bytes = take(size);
  if (bytes.ends_with('\0')) bytes.remove_suffix(1);
  return one_line(std::string(bytes));
}

std::uint32_t Cdr::count(std::size_t least_bytes) {
  const auto elements = number<std::uint32_t>();
  if (elements > (body_.size() - at_) / least_bytes) {
    refuse(fmt::format("says that {} elements follow in {} bytes", elements, body_.size() - at_),
           fmt::format("{} bytes for each", least_bytes));
  }
  return elements;
}

std::string_view Cdr::take(std::size_t count) {
  if (count > body_.size() - at_) {
    refuse(fmt::format("has {} bytes left", body_.size() - at_), fmt::format("{} bytes", count));
  }
  const std::string_view taken = body_.substr(at_, count);
  at_ += count;
  return taken;
}

void Cdr::refuse(const std::string& found, const std::string& needed) const {
  throw InputError({.file = file_,
                    .place = place_,
                    .element = "message",
                    .found = found,
                    .needed = needed,
                    .remedy = "look whether its type is the one that the topic says"});
}

void Cdr::align(std::size_t size) { take((size - at_ % size) % size); }

}  // namespace roadbed::map::logs
