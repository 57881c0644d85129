#include "roadbed/map/repair/text_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "roadbed/map/files/xml_places.h"

namespace roadbed::map::inline repair {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

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
  tag_end_ = xml_tag_end(text, begin_);
  is_empty_ = text[tag_end_ - 2] == '/';
}

TextEdit XmlElementText::with_attribute(std::string_view name, std::string_view value) const {
  const auto found = xml_value_in(text_.substr(begin_, tag_end_ - begin_), name);
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
    const std::string_view name = xml_tag_name(text_, begin_);
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
  return is_empty_ ? tag_end_ - 2 : xml_content_end(text_, tag_end_);
}

std::size_t XmlElementText::end() const {
  return is_empty_ ? tag_end_ : xml_tag_end(text_, content_end());
}

}  // namespace roadbed::map::repair
