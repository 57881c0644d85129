#include "roadbed/map/files/xml_places.h"

#include <utility>

namespace roadbed::map::inline files {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Behind a comment, a section of characters or an instruction that begins here; else `at`.
std::size_t behind_other(std::string_view text, std::size_t at) {
  if (at + 1 >= text.size() || (text[at + 1] != '!' && text[at + 1] != '?')) return at;
  for (const auto& [begin, end] : {std::pair<std::string_view, std::string_view>{"<!--", "-->"},
                                   {"<![CDATA[", "]]>"},
                                   {"<?", "?>"}}) {
    if (text.substr(at, begin.size()) != begin) continue;
    const std::size_t found = text.find(end, at + begin.size());
    return found == std::string_view::npos ? text.size() : found + end.size();
  }
  return at;
}

}  // namespace

std::size_t xml_tag_end(std::string_view text, std::size_t at) {
  char quote = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      return at + 1;
    }
  }
  return text.size();
}

std::string_view xml_tag_name(std::string_view text, std::size_t at) {
  const std::size_t end = text.find_first_of(" \t\r\n/>", at + 1);
  return text.substr(at + 1, end - at - 1);
}

std::optional<TextSpan> xml_value_in(std::string_view tag, std::string_view name) {
  std::size_t i = 0;
  const auto skip = [&](const auto& fits) {
    while (i < tag.size() && fits(tag[i])) ++i;
  };
  skip([](char c) { return !is_blank(c) && c != '>'; });  // "<name"
  while (i < tag.size()) {
    skip(is_blank);
    const std::size_t from = i;
    skip([](char c) { return !is_blank(c) && c != '=' && c != '>'; });
    const std::string_view found = tag.substr(from, i - from);
    skip(is_blank);
    if (i >= tag.size() || tag[i] != '=') return {};
    ++i;
    skip(is_blank);
    if (i >= tag.size()) return {};
    const std::size_t value = i + 1, close = tag.find(tag[i], value);
    if (close == std::string_view::npos) return {};
    if (found == name) return TextSpan{value, close - value};
    i = close + 1;
  }
  return {};
}

std::size_t xml_content_end(std::string_view text, std::size_t tag_end) {
  int depth = 0;
  for (std::size_t at = text.find('<', tag_end); at != std::string_view::npos;
       at = text.find('<', at)) {
    if (const std::size_t next = behind_other(text, at); next != at) {
      at = next;
      continue;
    }
    const std::size_t end = xml_tag_end(text, at);
    if (text.substr(at, 2) == "</") {
      if (depth-- == 0) return at;
    } else if (text[end - 2] != '/') {
      ++depth;
    }
    at = end;
  }
  return text.size();
}

std::string_view xml_element_at(std::string_view text, std::size_t at) {
  const std::size_t end = xml_tag_end(text, at);
  if (text[end - 2] == '/') return text.substr(at, end - at);
  return text.substr(at, xml_tag_end(text, xml_content_end(text, end)) - at);
}

}  // namespace roadbed::map::files
