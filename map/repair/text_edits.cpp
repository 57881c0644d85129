#include "roadbed/map/repair/text_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace roadbed::map::inline repair {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Behind the ">" of the tag that begins here; values of attributes may hold one.
std::size_t end_of_tag(std::string_view text, std::size_t at) {
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
  throw std::invalid_argument("XmlElementText: a tag that does not end");
}

/// Behind a comment, a section of characters or an instruction that begins here; else `at`.
std::size_t behind_other(std::string_view text, std::size_t at) {
  const auto behind = [&](std::string_view begin, std::string_view end) {
    if (!text.substr(at).starts_with(begin)) return at;
    const std::size_t found = text.find(end, at + begin.size());
    return found == std::string_view::npos ? text.size() : found + end.size();
  };
  for (const auto& [begin, end] : {std::pair{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<?", "?>"}}) {
    if (const std::size_t next = behind(begin, end); next != at) return next;
  }
  return at;
}

/// Where a value stands in a tag, without its quotes.
struct Span {
  std::size_t at, size;
};

std::optional<Span> find_value(std::string_view tag, std::string_view name) {
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
    if (found == name) return Span{value, close - value};
    i = close + 1;
  }
  return {};
}

}  // namespace

bool overlap(const TextEdit& a, const TextEdit& b) {
  if (a.at == b.at) return a.size > 0 && b.size > 0;
  const TextEdit &first = a.at < b.at ? a : b, &second = a.at < b.at ? b : a;
  return first.at + first.size > second.at;
}

std::string edited(std::string_view text, std::vector<TextEdit> edits) {
  std::stable_sort(edits.begin(), edits.end(), [](const TextEdit& a, const TextEdit& b) {
    return a.at < b.at || (a.at == b.at && a.size < b.size);
  });
  std::string made;
  std::size_t at = 0;
  for (const TextEdit& edit : edits) {
    if (edit.at < at) throw std::invalid_argument("edited: edits overlap");
    made.append(text.substr(at, edit.at - at)).append(edit.text);
    at = edit.at + edit.size;
  }
  return made.append(text.substr(at));
}

XmlElementText::XmlElementText(std::string_view text, std::size_t inside) : text_(text) {
  const std::size_t begin = text.rfind('<', inside);
  if (begin == std::string_view::npos) {
    throw std::invalid_argument(fmt::format("XmlElementText: no tag at byte {}", inside));
  }
  begin_ = begin;
  tag_end_ = end_of_tag(text, begin_);
  is_empty_ = text[tag_end_ - 2] == '/';
}

TextEdit XmlElementText::with_attribute(std::string_view name, std::string_view value) const {
  const auto found = find_value(text_.substr(begin_, tag_end_ - begin_), name);
  if (found) return {begin_ + found->at, found->size, std::string(value)};
  const std::size_t end = tag_end_ - (is_empty_ ? 2 : 1);
  return {end, 0, fmt::format(" {}=\"{}\"", name, value)};
}

std::string_view XmlElementText::indent() const {
  std::size_t from = begin_;
  while (from > 0 && is_blank(text_[from - 1]) && text_[from - 1] != '\n') --from;
  if (from > 0 && text_[from - 1] == '\n') --from;
  if (from > 0 && text_[from] == '\n' && text_[from - 1] == '\r') --from;
  return text_.substr(from, begin_ - from);
}

TextEdit XmlElementText::with_last_child(std::string_view child) const {
  const std::string_view own = indent();
  // What the child stands behind ends with the line break and blanks before the end tag.
  if (is_empty_) {
    const std::string_view tag = text_.substr(begin_ + 1);
    const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/>"));
    return {tag_end_ - 2, 2,
            fmt::format(">{}{}{}{}</{}>", own, own.empty() ? "" : "    ", child, own, name)};
  }
  const std::size_t end = content_end();
  std::size_t from = end;
  while (from > tag_end_ && is_blank(text_[from - 1])) --from;
  const std::string line = own.empty() ? "" : std::string(own) + "    ";
  return {from, 0, line + std::string(child) + (from == end ? std::string(own) : "")};
}

TextEdit XmlElementText::with_sibling_before(std::string_view sibling) const {
  return {begin_, 0, std::string(sibling) + std::string(indent())};
}

TextEdit XmlElementText::with_sibling_behind(std::string_view sibling) const {
  return {end(), 0, std::string(indent()) + std::string(sibling)};
}

TextEdit XmlElementText::without() const {
  const std::size_t from = begin_ - indent().size();
  return {from, end() - from, ""};
}

std::string_view XmlElementText::whole() const { return text_.substr(begin_, end() - begin_); }

TextEdit XmlElementText::replaced_by(std::string_view other) const {
  return {begin_, end() - begin_, std::string(other)};
}

std::size_t XmlElementText::content_end() const {
  if (is_empty_) return tag_end_ - 2;
  int depth = 0;
  for (std::size_t at = text_.find('<', tag_end_); at != std::string_view::npos;
       at = text_.find('<', at)) {
    if (const std::size_t next = behind_other(text_, at); next != at) {
      at = next;
      continue;
    }
    const std::size_t tag_end = end_of_tag(text_, at);
    if (text_[at + 1] == '/') {
      if (depth-- == 0) return at;
    } else if (text_[tag_end - 2] != '/') {
      ++depth;
    }
    at = tag_end;
  }
  throw std::invalid_argument("XmlElementText: an element that does not end");
}

std::size_t XmlElementText::end() const {
  return is_empty_ ? tag_end_ : end_of_tag(text_, content_end());
}

}  // namespace roadbed::map::repair
