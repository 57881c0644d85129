#include "roadbed/map/files/xml_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/xml_characters.h"

namespace roadbed::map::inline files {
namespace {

constexpr std::size_t kDeepest = 1'000, kMostAttributes = 10'000;

enum Kind : std::uint8_t { in_name = 1, space = 2, decodes = 4 };

constexpr std::array<std::uint8_t, 256> kinds() {
  std::array<std::uint8_t, 256> table{};
  for (std::size_t c = 0; c < 256; ++c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c >= 128;
    const bool sign = c == '_' || c == ':' || c == '-' || c == '.';
    if (letter || sign || (c >= '0' && c <= '9')) table[c] |= in_name;
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n') table[c] |= space;
    if (c == '&' || c < 0x20 || c == 0x7F) table[c] |= decodes;
  }
  return table;
}

constexpr std::array<std::uint8_t, 256> kKinds = kinds();

bool is(char c, Kind kind) { return (kKinds[static_cast<unsigned char>(c)] & kind) != 0; }

// The first byte from `at` that is not of the kind.
std::size_t end_of(Kind kind, std::string_view text, std::size_t at) {
  while (at < text.size() && is(text[at], kind)) ++at;
  return at;
}

// Names are a few letters, which a call to compare memory takes longer for than a loop.
bool is_same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != b[i]) return false;
  }
  return true;
}

}  // namespace

XmlScanner::XmlScanner(std::string_view text, std::string file, std::size_t from)
    : text_(text), file_(std::move(file)), at_(from), offset_(from) {}

XmlScanner::XmlScanner(std::string_view text, std::string file, const Stretch& stretch)
    : text_(text.substr(0, stretch.to)),
      file_(std::move(file)),
      at_(stretch.from),
      offset_(stretch.from),
      is_stretch_(stretch.to < text.size()) {
  if (!stretch.inside.empty()) open_.push_back(stretch.inside);
}

void XmlScanner::refuse(const std::string& reason) const {
  const std::size_t end = std::min(at_, text_.size());
  const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<long>(end), '\n');
  throw InputError({.file = file_,
                    .place = std::to_string(line),
                    .found = fmt::format("not well-formed XML ({})", reason),
                    .needed = "a whole XML document",
                    .remedy = "check whether the file was cut off or is of another kind"});
}

bool XmlScanner::skip_space() {
  const std::size_t before = std::exchange(at_, end_of(space, text_, at_));
  return at_ != before;
}

void XmlScanner::skip_past(std::string_view end, const char* what) {
  const std::size_t found = text_.find(end, at_);
  if (found == text_.npos) refuse(fmt::format("a {} does not end", what));
  at_ = found + end.size();
}

// Comments, CDATA, instructions and the document type, from behind their '<'.
void XmlScanner::skip_markup() {
  const std::string_view rest = text_.substr(at_);
  if (rest.starts_with('?')) {
    skip_past("?>", "processing instruction");
  } else if (rest.starts_with("!--")) {
    at_ += 3;
    skip_past("-->", "comment");
  } else if (rest.starts_with("![CDATA[")) {
    skip_past("]]>", "CDATA section");
  } else if (rest.starts_with("!DOCTYPE") && open_.empty()) {
    skip_document_type();
  } else {
    refuse("a tag begins with <!");
  }
}

// To its '>', past brackets, quotes and comments.
void XmlScanner::skip_document_type() {
  int brackets = 0;
  for (; !at_end(); ++at_) {
    const char c = text_[at_];
    if (c == '"' || c == '\'') {
      ++at_;
      skip_past(std::string_view(&c, 1), "text of the document type");
      --at_;
    } else if (text_.substr(at_, 4) == "<!--") {
      skip_past("-->", "comment");
      --at_;
    } else if (c == '[') {
      ++brackets;
    } else if (c == ']') {
      --brackets;
    } else if (c == '>' && brackets <= 0) {
      ++at_;
      return;
    }
  }
  refuse("the document type does not end");
}

std::string_view XmlScanner::take_name() {
  const std::size_t begin = at_;
  at_ = end_of(in_name, text_, at_);
  if (at_ == begin) refuse(at_end() ? "it ends inside a tag" : "a name is missing in a tag");
  return text_.substr(begin, at_ - begin);
}

std::string_view XmlScanner::take_value() {
  const char quote = here();
  if (quote != '"' && quote != '\'') refuse("the value of an attribute has no quotes");
  const std::size_t begin = at_ + 1;
  std::size_t end = begin;
  std::uint8_t seen = 0;
  for (; end < text_.size() && text_[end] != quote; ++end) {
    seen |= kKinds[static_cast<unsigned char>(text_[end])];
  }
  if (end == text_.size()) refuse("the value of an attribute does not end");
  at_ = end + 1;
  const std::string_view raw = text_.substr(begin, end - begin);
  return (seen & decodes) == 0 ? raw : decoded_.emplace_back(decode_xml(raw));
}

// An attribute as nearly all are written, ` name="value"` with nothing to decode, in one pass
// without a look at the members; false, and nothing is taken, if it is of another form.
bool XmlScanner::take_plain_attribute() {
  const char* const end = text_.data() + text_.size();
  const char* at = text_.data() + at_;
  if (end - at < 2 || *at != ' ') return false;
  const char* const name = ++at;
  while (at != end && is(*at, in_name)) ++at;
  const auto name_size = static_cast<std::size_t>(at - name);
  if (name_size == 0 || end - at < 3 || at[0] != '=' || (at[1] != '"' && at[1] != '\''))
    return false;
  const char quote = at[1];
  const char* const value = at + 2;
  std::uint8_t seen = 0;
  for (at = value; at != end && *at != quote; ++at) seen |= kKinds[static_cast<unsigned char>(*at)];
  if (at == end || (seen & decodes) != 0 || attributes_.size() == kMostAttributes) return false;
  attributes_.push_back({{name, name_size}, {value, static_cast<std::size_t>(at - value)}});
  at_ = static_cast<std::size_t>(at + 1 - text_.data());
  return true;
}

void XmlScanner::take_attribute() {
  const std::string_view name = take_name();
  skip_space();
  if (here() != '=') refuse(fmt::format("attribute {} has no value", name));
  ++at_;
  skip_space();
  if (attributes_.size() == kMostAttributes) refuse("an element has more than 10,000 attributes");
  attributes_.push_back({name, take_value()});
}

// Goes behind the '<' of the next tag; false if there is none.
bool XmlScanner::find_tag() {
  for (;;) {
    std::size_t begin = at_;
    while (begin < text_.size() && text_[begin] != '<') ++begin;
    at_ = begin;
    if (at_end()) return false;
    offset_ = begin;
    ++at_;
    if (here() != '!' && here() != '?') return true;
    skip_markup();
  }
}

XmlScanner::Event XmlScanner::enter() {
  if (open_.size() == kDeepest) refuse("elements are nested deeper than 1,000");
  open_.push_back(name_);
  return Event::start;
}

XmlScanner::Event XmlScanner::leave() {
  open_.pop_back();
  is_done_ = open_.empty();
  return Event::end;
}

XmlScanner::Event XmlScanner::read_start() {
  name_ = take_name();
  attributes_.clear();
  for (;;) {
    while (take_plain_attribute()) {
    }
    const bool spaced = skip_space();
    const char c = here();
    if (c == '>') {
      ++at_;
      return enter();
    }
    if (c == '/' && text_.substr(at_, 2) == "/>") {
      at_ += 2;
      is_empty_ = true;
      return enter();
    }
    if (!spaced) refuse(at_end() ? "it ends inside a tag" : "a tag has an unexpected character");
    take_attribute();
  }
}

XmlScanner::Event XmlScanner::read_end() {
  ++at_;
  name_ = take_name();
  skip_space();
  if (here() != '>') refuse("an end tag does not end");
  if (open_.empty() || !is_same(open_.back(), name_)) {
    refuse(fmt::format("</{}> closes what <{}> began", name_, open_.empty() ? "" : open_.back()));
  }
  ++at_;
  return leave();
}

XmlScanner::Event XmlScanner::next() {
  if (is_empty_) {
    is_empty_ = false;
    return leave();
  }
  if (is_done_) return Event::done;
  if (!find_tag()) {
    is_done_ = is_stretch_ && open_.size() == 1;
    if (is_done_) return Event::done;
    refuse(open_.empty() ? "no element" : fmt::format("it ends inside <{}>", open_.back()));
  }
  return here() == '/' ? read_end() : read_start();
}

void XmlScanner::skip() {
  const std::size_t outside = depth() - 1;
  while (depth() != outside) next();
}

void XmlScanner::expect_end() {
  if (find_tag()) refuse("another element follows the first");
}

std::string_view XmlScanner::value(std::string_view attribute) const {
  for (const Attribute& one : attributes_) {
    if (is_same(one.name, attribute)) return one.value;
  }
  return {};
}

std::string_view root_element(std::string_view text) {
  XmlScanner scanner(text, {});
  try {
    scanner.next();
  } catch (const InputError&) {
    return scanner.name();  // is known where only what follows it is broken
  }
  return scanner.name();
}

}  // namespace roadbed::map::files
