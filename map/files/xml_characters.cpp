#include "roadbed/map/files/xml_characters.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <pugixml.hpp>
#include <sstream>
#include <utility>

namespace roadbed::map::inline files {
namespace {

constexpr std::array<std::pair<std::string_view, char>, 5> kNamed = {
    {{"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}}};

void append_utf8(std::uint32_t code, std::string& text) {
  const auto byte = [&](std::uint32_t bits) { text += static_cast<char>(bits); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xc0 | code >> 6);
    byte(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    byte(0xe0 | code >> 12);
    byte(0x80 | (code >> 6 & 0x3f));
    byte(0x80 | (code & 0x3f));
  } else {
    byte(0xf0 | code >> 18);
    byte(0x80 | (code >> 12 & 0x3f));
    byte(0x80 | (code >> 6 & 0x3f));
    byte(0x80 | (code & 0x3f));
  }
}

// The character "#228" or "#xe4", 0 if it names none.
std::uint32_t numbered(std::string_view name) {
  const bool hexadecimal = name.starts_with("#x");
  name.remove_prefix(hexadecimal ? 2 : 1);
  std::uint32_t code = 0;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data(), end, code, hexadecimal ? 16 : 10);
  const bool is_character = code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
  return error == std::errc() && stop == end && is_character ? code : 0;
}

// Appends what "name" in "&name;" stands for; false if it is nothing known.
bool append_reference(std::string_view name, std::string& text) {
  if (name.starts_with('#')) {
    const std::uint32_t code = numbered(name);
    if (code != 0) append_utf8(code, text);
    return code != 0;
  }
  const auto known = std::find_if(kNamed.begin(), kNamed.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  if (known != kNamed.end()) text += known->second;
  return known != kNamed.end();
}

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

bool continues(std::string_view text, std::size_t at) {
  return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
}

unsigned char byte_at(std::string_view text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0;
}

// Length of the well-formed UTF-8 sequence at a place, 0 if there is none (Unicode table 3-7).
std::size_t sequence_length(std::string_view text, std::size_t at) {
  const unsigned char first = byte_at(text, at), second = byte_at(text, at + 1);
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4 || !continues(text, at + 1)) return 0;
  if (first < 0xE0) return 2;
  if (!continues(text, at + 2)) return 0;
  if (first == 0xE0 && second < 0xA0) return 0;
  if (first == 0xED && second > 0x9F) return 0;  // surrogates
  if (first < 0xF0) return 3;
  if (first == 0xF0 && second < 0x90) return 0;
  if (first == 0xF4 && second > 0x8F) return 0;
  return continues(text, at + 3) ? 4 : 0;
}

enum class Markup { xml, html };

std::string_view entity(char letter, Markup markup) {
  switch (letter) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return markup == Markup::html ? "&#39;" : std::string_view();
    default:
      return {};
  }
}

// What stands for a control character, empty if it stays.
std::string_view control(char letter, Markup markup) {
  const auto code = static_cast<unsigned char>(letter);
  if (markup == Markup::xml) return code < 0x20 ? " " : std::string_view();
  const bool stays = (code >= 0x20 && code != 0x7F) || letter == '\t' || letter == '\n';
  return stays ? std::string_view() : kReplacement;
}

std::string escaped(std::string_view text, Markup markup) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = sequence_length(text, at);
    if (length == 0) {
      result += kReplacement;
    } else if (const auto replaced = entity(text[at], markup); !replaced.empty()) {
      result += replaced;
    } else if (const auto instead = control(text[at], markup); !instead.empty()) {
      result += instead;
    } else {
      result += text.substr(at, length);
    }
    at += length == 0 ? 1 : length;
  }
  return result;
}

}  // namespace

std::string decode_xml(std::string_view raw) {
  constexpr std::size_t longest = 12;  // of a reference
  std::string text;
  text.reserve(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const char c = raw[i];
    const std::size_t end = c == '&' ? raw.substr(i, longest).find(';') : raw.npos;
    if (end != raw.npos && append_reference(raw.substr(i + 1, end - 1), text)) {
      i += end;
    } else if (c == '\r' || c == '\n' || c == '\t') {
      text += ' ';
      if (c == '\r' && raw.substr(i + 1).starts_with('\n')) ++i;
    } else {
      text += c;
    }
  }
  return text;
}

std::string xml_text(std::string_view text) { return escaped(text, Markup::xml); }

std::string html_text(std::string_view text) { return escaped(text, Markup::html); }

bool looks_like_xml(const std::string& bytes) {
  const auto first = bytes.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  return first != std::string::npos && bytes[first] == '<';
}

bool is_other_encoding(std::string_view bytes) {
  if (bytes.size() < 2) return false;
  // Byte order marks of UTF-16, or a zero in what would be "<?" or "<o".
  if (bytes.starts_with("\xfe\xff") || bytes.starts_with("\xff\xfe")) return true;
  if (bytes[0] == '\0' || bytes[1] == '\0') return true;
  const auto end = bytes.substr(0, 256).find("?>");
  if (end == bytes.npos) return false;
  std::string declaration(bytes.substr(0, end));
  for (char& c : declaration) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return declaration.find("8859-1") != std::string::npos ||
         declaration.find("latin1") != std::string::npos;
}

std::string in_utf8(std::string bytes) {
  if (!is_other_encoding(bytes)) return bytes;
  pugi::xml_document document;
  // Of a fragment the breaks before the root are kept, too.
  constexpr unsigned all = pugi::parse_full | pugi::parse_ws_pcdata | pugi::parse_fragment;
  if (!document.load_buffer(bytes.data(), bytes.size(), all)) return bytes;
  std::ostringstream text;
  document.save(text, "", pugi::format_raw | pugi::format_no_declaration, pugi::encoding_utf8);
  return std::move(text).str();
}

}  // namespace roadbed::map::files
