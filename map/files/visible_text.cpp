#include "roadbed/map/files/visible_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace roadbed::map::inline files {
namespace {

constexpr char32_t kFirstSeen = 0x20, kDel = 0x7F;

unsigned char byte_at(std::string_view text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0;
}

// Bytes that a character has by its first one, 0 if none begins with it.
std::size_t size_by_first(unsigned char first) {
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4) return 0;
  return first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
}

// Too long a form, a surrogate, or past the last character of Unicode.
bool is_excluded(unsigned char first, unsigned char second) {
  return (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
         (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F);
}

bool is_ascii_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < kFirstSeen || byte == kDel;
}

bool is_plain(char c) {
  return (c >= ' ' && c < static_cast<char>(kDel)) || c == '\n' || c == '\t';
}

void append_escaped(char32_t code, std::string& made) {
  fmt::format_to(std::back_inserter(made), "\\u{:04x}", static_cast<unsigned>(code));
}

}  // namespace

Utf8Character character_at(std::string_view text, std::size_t at) {
  constexpr std::array<unsigned char, 5> first_bits = {0, 0x7F, 0x1F, 0x0F, 0x07};
  const unsigned char first = byte_at(text, at);
  const std::size_t size = size_by_first(first);
  if (size == 0 || is_excluded(first, byte_at(text, at + 1))) return {first, 0};
  char32_t code = first & first_bits[size];
  for (std::size_t i = 1; i < size; ++i) {
    const unsigned char next = byte_at(text, at + i);
    if ((next & 0xC0) != 0x80) return {first, 0};
    code = code << 6 | (next & 0x3FU);
  }
  return {code, size};
}

std::size_t size_of_whole_characters(std::string_view text) {
  constexpr std::size_t longest = 4;
  for (std::size_t back = 1; back < longest && back <= text.size(); ++back) {
    const std::size_t at = text.size() - back;
    const unsigned char byte = byte_at(text, at);
    if ((byte & 0xC0) == 0x80) continue;
    return size_by_first(byte) > back ? at : text.size();
  }
  return text.size();
}

bool is_hidden(char32_t code) {
  if (code < 0xA0) return (code < kFirstSeen && code != '\n' && code != '\t') || code >= kDel;
  return code == 0x61C || code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

void append_visible(std::string_view text, std::string& made) {
  for (std::size_t at = 0; at < text.size();) {
    const auto plain_end =
        std::find_if_not(text.begin() + static_cast<long>(at), text.end(), is_plain);
    const auto end = static_cast<std::size_t>(plain_end - text.begin());
    made.append(text.substr(at, end - at));
    at = end;
    if (at == text.size()) return;
    const Utf8Character character = character_at(text, at);
    if (character.size == 0) {
      fmt::format_to(std::back_inserter(made), "\\x{:02x}", byte_at(text, at));
    } else if (is_hidden(character.code)) {
      append_escaped(character.code, made);
    } else {
      made.append(text.substr(at, character.size));
    }
    at += std::max<std::size_t>(character.size, 1);
  }
}

std::string visible_text(std::string_view text) {
  std::string made;
  made.reserve(text.size());
  append_visible(text, made);
  return made;
}

void make_one_line(std::string& text) {
  if (std::ranges::none_of(text, is_ascii_control)) return;
  std::string made;
  for (const char c : text) {
    if (c == '\n' || c == '\r' || c == '\t' || c == '\v' || c == '\f') {
      made += ' ';
    } else if (is_ascii_control(c)) {
      append_escaped(static_cast<unsigned char>(c), made);
    } else {
      made += c;
    }
  }
  text = std::move(made);
}

std::string one_line(std::string text) {
  make_one_line(text);
  return text;
}

}  // namespace roadbed::map::files
