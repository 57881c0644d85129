#include "roadbed/map/opendrive/rules/schema_grammar.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace roadbed::map::opendrive::rules {
namespace {

constexpr int kFirstBounded = 5;  // the schema of 1.4 has neither bounds nor required attributes

/// "5", "-5", "5-7" or "7-" of the last digit of revisions.
struct Revisions {
  int first = 0, last = 99;

  bool have(int minor) const { return first <= minor && minor <= last; }
};

int number_of(std::string_view digits, int otherwise) {
  int value = otherwise;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

Revisions revisions_of(std::string_view text) {
  const std::size_t dash = text.find('-');
  if (dash == text.npos) return {number_of(text, 0), number_of(text, 99)};
  return {number_of(text.substr(0, dash), 0), number_of(text.substr(dash + 1), 99)};
}

/// Takes what is before a separator, or all, off the front of a text.
std::string_view take(std::string_view& text, char separator) {
  const std::string_view taken = text.substr(0, text.find(separator));
  text.remove_prefix(std::min(taken.size() + 1, text.size()));
  return taken;
}

/// A word of the table in its parts.
struct Word {
  std::string_view name, type;
  Range range = Range::any;
  bool is_read = false, is_vital = false, is_required = false;
  Revisions revisions;
};

Word parse(std::string_view text, int minor) {
  Word word;
  if (const std::size_t at = text.find('@'); at != text.npos) {
    word.revisions = revisions_of(text.substr(at + 1));
    text = text.substr(0, at);
  }
  if (const std::size_t mark = text.find('!'); mark != text.npos) {
    const std::string_view when = text.substr(mark + 1);
    word.is_vital = when == "!";
    const Revisions required = when.empty() ? Revisions{kFirstBounded} : revisions_of(when);
    word.is_required = word.is_vital || required.have(minor);
    text = text.substr(0, mark);
  }
  if (text.ends_with('*')) {
    word.is_read = true;
    text.remove_suffix(1);
  }
  if (const std::size_t bound = text.find('>'); bound != text.npos) {
    word.range = text.substr(bound) == ">0" ? Range::positive : Range::not_negative;
    text = text.substr(0, bound);
  }
  word.name = take(text, ':');
  word.type = text;
  return word;
}

bool fits_shape(std::string_view shape, std::string_view value) {
  return std::equal(shape.begin(), shape.end(), value.begin(), value.end(),
                    [](char wanted, char found) {
                      if (wanted == '^') return found >= 'A' && found <= 'Z';
                      if (wanted == '#') return found >= '0' && found <= '9';
                      return wanted == found;
                    });
}

bool is_shape(std::string_view value) { return value.find_first_of("^#") != value.npos; }

}  // namespace

bool is_in(Range range, double value) {
  switch (range) {
    case Range::any:
      return true;
    case Range::not_negative:
      return value >= 0.0;
    case Range::positive:
      return value > 0.0;
    case Range::negative:
      return value < 0.0;
    case Range::zero:
      return value == 0.0;
    case Range::share:
      return value >= 0.0 && value <= 1.0;
  }
  return true;
}

bool Choice::has(std::string_view value) const {
  return std::find(values.begin(), values.end(), value) != values.end() ||
         std::any_of(shapes.begin(), shapes.end(),
                     [&](std::string_view shape) { return fits_shape(shape, value); });
}

const ElementRule* ElementRule::child(std::string_view name, std::size_t& hint) const {
  for (std::size_t i = 0; i < children.size(); ++i) {
    const std::size_t at = (hint + i) % children.size();
    if (children[at].name != name) continue;
    hint = at;
    return children[at].element;
  }
  return nullptr;
}

Grammar::Grammar(int minor) : minor_(minor >= 4 && minor <= 8 ? minor : 0) {
  for (const ChoiceText& text : choice_texts()) read_choice(text);
  for (const ElementText& text : element_texts()) {
    elements_.emplace(text.type, std::make_unique<ElementRule>(ElementRule{text.type, {}, {}}));
  }
  for (const ElementText& text : element_texts()) read_element(text);
  root_ = elements_.at(element_texts().front().type).get();
}

void Grammar::read_choice(const ChoiceText& text) {
  Choice& choice = choices_[text.type];
  for (std::string_view rest = text.values; !rest.empty();) {
    std::string_view revisions = take(rest, '|');
    const std::string_view value = take(revisions, '@');
    const bool is_now = revisions_of(revisions).have(minor_);
    if (value.starts_with('(')) {
      if (is_now) choice.range = value == "(>0)" ? Range::positive : Range::not_negative;
    } else if (is_shape(value)) {
      if (is_now) choice.shapes.push_back(value);
    } else {
      (is_now || !is_known() ? choice.values : choice.others).push_back(value);
    }
  }
}

ValueType Grammar::type_of(std::string_view name) const {
  using Kind = ValueType::Kind;
  static const std::unordered_map<std::string_view, ValueType> plain = {
      {"", {Kind::number}},
      {"number", {Kind::number}},
      {"share", {Kind::number, Range::share}},
      {"text", {Kind::text}},
      {"filled", {Kind::filled}},
      {"whole", {Kind::whole}},
      {"natural", {Kind::whole, Range::not_negative}},
      {"positive", {Kind::whole, Range::positive}},
      {"negative", {Kind::whole, Range::negative}},
      {"zero", {Kind::whole, Range::zero}},
  };
  if (const auto found = plain.find(name); found != plain.end()) return found->second;
  const auto found = choices_.find(name);
  if (found == choices_.end()) {
    throw std::invalid_argument(fmt::format("Grammar: no type of values is called {}", name));
  }
  return {Kind::choice, Range::any, &found->second};
}

void Grammar::read_element(const ElementText& text) {
  ElementRule& element = *elements_.at(text.type);
  for (std::string_view rest = text.attributes; !rest.empty();) {
    const Word word = parse(take(rest, ' '), minor_);
    if (!word.revisions.have(minor_)) continue;
    if (!is_known() && !word.is_vital && !word.is_read) continue;
    AttributeRule attribute{{std::string(word.name), word.is_required, word.is_vital},
                            type_of(word.type)};
    if (word.range != Range::any) attribute.type.range = word.range;
    if (minor_ < kFirstBounded) attribute.type.range = Range::any;
    if (!is_known() && !word.is_read && attribute.type.choice) {
      attribute.type = {ValueType::Kind::text};
    }
    element.attributes.push_back(std::move(attribute));
  }
  for (std::string_view rest = text.children; !rest.empty();) {
    const Word word = parse(take(rest, ' '), minor_);
    if (!word.revisions.have(minor_)) continue;
    const auto found = elements_.find(word.type.empty() ? word.name : word.type);
    if (found == elements_.end()) {
      throw std::invalid_argument(
          fmt::format("Grammar: no type of elements is called {}", word.name));
    }
    element.children.push_back(
        {{std::string(word.name), word.is_required, word.is_vital}, found->second.get()});
  }
}

}  // namespace roadbed::map::opendrive::rules
