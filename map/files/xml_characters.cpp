#include "roadbed/map/files/xml_characters.h"

#include <fmt/format.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <pugixml.hpp>
#include <sstream>
#include <utility>

#include "roadbed/map/files/visible_text.h"

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

// What stands for a character that is not written as it is, empty if it stays.
std::string instead_of(char32_t code, Markup markup) {
  if (code < 0x80) {
    const std::string_view named = entity(static_cast<char>(code), markup);
    if (!named.empty()) return std::string(named);
  }
  if (code == 0xFFFE || code == 0xFFFF) return std::string(kReplacement);
  const bool is_space = code == '\t' || code == '\n';
  if (markup == Markup::xml) {
    if (code < 0x20) return " ";
    return is_hidden(code) ? fmt::format("&#x{:x};", static_cast<unsigned>(code)) : std::string();
  }
  if (code < 0x20 || code == 0x7F) return is_space ? std::string() : std::string(kReplacement);
  return is_hidden(code) ? fmt::format("\\u{:04x}", static_cast<unsigned>(code)) : std::string();
}

std::string escaped(std::string_view text, Markup markup) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const Utf8Character character = character_at(text, at);
    const std::string instead =
        character.size == 0 ? std::string(kReplacement) : instead_of(character.code, markup);
    const std::size_t size = std::max<std::size_t>(character.size, 1);
    result += instead.empty() ? text.substr(at, size) : std::string_view(instead);
    at += size;
  }
  return result;
}

bool is_raw_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7F;
}

// Without branches, so that it becomes vector code: files are long, and hardly any has one.
bool may_hold_controls(std::string_view xml) {
  unsigned char any = 0;
  for (const char c : xml) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_space = (byte == '\t') | (byte == '\n') | (byte == '\r');
    any |= static_cast<unsigned char>(((byte < 0x20) & !is_space) | (byte == 0x7F));
  }
  return any != 0 || xml.find("&#") != xml.npos;
}

struct Reference {
  std::size_t size = 0;  // 0: there is none
  char control = '\0';
};

// The reference to a control character that a text begins with. Numbers wrap as pugixml's do, which
// takes any count of digits.
Reference control_reference(std::string_view text) {
  if (!text.starts_with("&#")) return {};
  const bool hexadecimal = text.substr(2).starts_with('x');
  const std::size_t begin = hexadecimal ? 3 : 2;
  std::size_t end = begin;
  std::uint32_t code = 0;
  for (; end < text.size() && std::isxdigit(static_cast<unsigned char>(text[end])) != 0; ++end) {
    const auto digit = static_cast<std::uint32_t>(text[end] <= '9' ? text[end] - '0'
                                                                   : (text[end] | 0x20) - 'a' + 10);
    if (digit >= 10 && !hexadecimal) return {};
    code = (hexadecimal ? 16 : 10) * code + digit;
  }
  const bool is_control = code < 0x20 || code == 0x7F;
  if (end == begin || !text.substr(end).starts_with(';') || !is_control) return {};
  return {end + 1, static_cast<char>(code)};
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
  make_one_line(text);  // also of what stood there by number
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

std::string without_controls(std::string bytes) {
  const bool is_wide = bytes.starts_with("\xfe\xff") || bytes.starts_with("\xff\xfe") ||
                       std::string_view(bytes).substr(0, 2).find('\0') != std::string_view::npos;
  if (is_wide) bytes = in_utf8(std::move(bytes));
  if (!may_hold_controls(bytes)) return bytes;
  std::string text;
  text.reserve(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const Reference reference =
        bytes[i] == '&' ? control_reference(std::string_view(bytes).substr(i)) : Reference{};
    if (reference.size > 0) {
      text += one_line(std::string(1, reference.control));
      i += reference.size - 1;
    } else if (is_raw_control(bytes[i])) {
      text += one_line(std::string(1, bytes[i]));
    } else {
      text += bytes[i];
    }
  }
  return text;
}

void declare_utf8(pugi::xml_node declaration) {
  if (declaration.type() != pugi::node_declaration) return;
  constexpr std::array<const char*, 8> read = {"UTF-16", "UTF-16LE",   "UTF-16BE", "UTF-32",
                                               "UCS-2",  "ISO-8859-1", "latin1",   "US-ASCII"};
  pugi::xml_attribute encoding = declaration.attribute("encoding");
  if (std::ranges::any_of(
          read, [&](const char* name) { return ::strcasecmp(encoding.value(), name) == 0; })) {
    encoding.set_value("UTF-8");
  }
}

std::string in_utf8(std::string bytes) {
  if (!is_other_encoding(bytes)) return bytes;
  pugi::xml_document document;
  // Of a fragment the breaks before the root are kept, too.
  constexpr unsigned all = pugi::parse_full | pugi::parse_ws_pcdata | pugi::parse_fragment;
  if (!document.load_buffer(bytes.data(), bytes.size(), all)) return bytes;
  declare_utf8(document.first_child());
  std::ostringstream text;
  document.save(text, "", pugi::format_raw | pugi::format_no_declaration, pugi::encoding_utf8);
  return std::move(text).str();
}

}  // namespace roadbed::map::files
