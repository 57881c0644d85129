#include "roadbed/map/query/lane_question.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::inline query {

/// "or" and "and" of their parts, "not" of one, or a comparison with one value or several.
struct LaneQuestion::Part {
  enum class Kind { any, all, none, comparison };

  Kind kind = Kind::comparison;
  std::vector<Part> parts = {};
  const LaneField* field = nullptr;  // null: a tag
  std::string key = {};              // of the tag
  std::string relation = {};
  std::vector<std::string> values = {};
};

namespace {

using Part = LaneQuestion::Part;
using Kind = Part::Kind;

constexpr int kMostNested = 200;

std::optional<double> number_of(std::string_view text) {
  double number = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault != std::errc() || end != text.data() + text.size() || std::isnan(number)) return {};
  return number;
}

struct Token {
  std::string text;
  std::size_t at = 0;
  bool is_quoted = false;
};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// A sign of the grammar that is no part of a word, as long as it gets; empty if there is none.
std::string_view sign_at(std::string_view text) {
  static constexpr std::array<std::string_view, 10> signs = {"!=", "<=", ">=", "=", "<",
                                                             ">",  "~",  "(",  ")", ","};
  const auto* found =
      std::ranges::find_if(signs, [&](std::string_view sign) { return text.starts_with(sign); });
  return found == signs.end() ? std::string_view() : *found;
}

[[noreturn]] void refuse(std::size_t at, const std::string& what) {
  throw QuestionFault(fmt::format("at character {}: {}", at + 1, what));
}

std::vector<Token> tokens_of(std::string_view question) {
  std::vector<Token> tokens;
  for (std::size_t i = 0; i < question.size();) {
    const char c = question[i];
    if (is_blank(c)) {
      ++i;
    } else if (c == '\'' || c == '"') {
      const std::size_t end = question.find(c, i + 1);
      if (end == std::string_view::npos) refuse(i, "a quote that is not closed");
      tokens.push_back({std::string(question.substr(i + 1, end - i - 1)), i, true});
      i = end + 1;
    } else if (const std::string_view sign = sign_at(question.substr(i)); !sign.empty()) {
      tokens.push_back({std::string(sign), i, false});
      i += sign.size();
    } else {
      const std::size_t from = i;
      while (i < question.size() && !is_blank(question[i]) && question[i] != '\'' &&
             question[i] != '"' && sign_at(question.substr(i)).empty()) {
        ++i;
      }
      tokens.push_back({std::string(question.substr(from, i - from)), from, false});
    }
  }
  return tokens;
}

std::string known_fields() {
  std::string names;
  for (const LaneField& field : lane_fields()) names += fmt::format("{}, ", field.name);
  return names + "tag.KEY";
}

class Parser {
 public:
  explicit Parser(std::string_view question)
      : tokens_(tokens_of(question)), end_(question.size()) {}

  Part parse() {
    Part part = any();
    if (next_ < tokens_.size()) refuse(here(), fmt::format("\"{}\" is too much", shown()));
    return part;
  }

 private:
  std::size_t here() const { return next_ < tokens_.size() ? tokens_[next_].at : end_; }
  std::string shown() const {
    return next_ < tokens_.size() ? one_line(tokens_[next_].text) : "the end";
  }

  bool take(std::string_view word) {
    if (next_ >= tokens_.size() || tokens_[next_].is_quoted || tokens_[next_].text != word) {
      return false;
    }
    ++next_;
    return true;
  }

  void need(std::string_view sign) {
    if (!take(sign)) refuse(here(), fmt::format("needs \"{}\", found \"{}\"", sign, shown()));
  }

  Part joined(Kind kind, std::string_view word, Part (Parser::*inner)()) {
    Part first = (this->*inner)();
    Part list{.kind = kind};
    list.parts.push_back(std::move(first));
    while (take(word)) list.parts.push_back((this->*inner)());
    return list.parts.size() == 1 ? std::move(list.parts.front()) : std::move(list);
  }

  Part any() { return joined(Kind::any, "or", &Parser::all); }
  Part all() { return joined(Kind::all, "and", &Parser::part); }

  Part part() {
    if (++depth_ > kMostNested) refuse(here(), "parentheses nested too deeply");
    Part found;
    if (take("not")) {
      found.kind = Kind::none;
      found.parts.push_back(part());
    } else if (take("(")) {
      found = any();
      need(")");
    } else {
      found = comparison();
    }
    --depth_;
    return found;
  }

  Part comparison() {
    Part found;
    const std::size_t at = here();
    if (next_ == tokens_.size()) {
      refuse(at, fmt::format("needs a field, found \"the end\"; there are {}", known_fields()));
    }
    const std::string name = tokens_[next_++].text;
    if (name.starts_with("tag.")) {
      found.key = name.substr(4);
    } else {
      const auto fields = lane_fields();
      const auto field = std::ranges::find(fields, name, &LaneField::name);
      if (field == fields.end()) {
        refuse(at, fmt::format("\"{}\" is no field; there are {}", one_line(name), known_fields()));
      }
      found.field = &*field;
    }
    read_relation(found);
    return found;
  }

  void read_relation(Part& found) {
    if (take("in")) {
      found.relation = "=";
      need("(");
      do read_value(found);
      while (take(","));
      need(")");
      return;
    }
    for (const char* relation : {"=", "!=", "<=", ">=", "<", ">", "~"}) {
      if (!take(relation)) continue;
      found.relation = relation;
      return read_value(found);
    }
    refuse(here(), fmt::format("needs = != < <= > >= ~ or in, found \"{}\"", shown()));
  }

  void read_value(Part& found) {
    if (next_ >= tokens_.size() || (!tokens_[next_].is_quoted && !sign_at(shown()).empty())) {
      refuse(here(), fmt::format("needs a value, found \"{}\"", shown()));
    }
    const Token& token = tokens_[next_++];
    const bool is_order = found.relation[0] == '<' || found.relation[0] == '>';
    const bool is_number = number_of(token.text).has_value();
    const bool is_nothing = token.text == "none" && !is_order && found.relation != "~";
    const bool needs_number = found.field == nullptr ? is_order : found.field->is_number;
    if (needs_number && !is_number && !is_nothing) {
      refuse(token.at, fmt::format("\"{}\" is no number", one_line(token.text)));
    }
    if (found.field != nullptr && !found.field->is_number && is_order) {
      refuse(token.at, fmt::format("{} is a text, which is not less or more", found.field->name));
    }
    if (found.field != nullptr && found.field->is_number && found.relation == "~") {
      refuse(token.at, fmt::format("{} is a number, which has no parts", found.field->name));
    }
    if (!is_nothing && found.relation != "~") need_known_word(found, token);
    found.values.push_back(token.text);
  }

  static void need_known_word(const Part& part, const Token& token) {
    if (part.field == nullptr || part.field->words == nullptr) return;
    const std::vector<std::string_view> words = part.field->words();
    if (std::ranges::find(words, token.text) != words.end()) return;
    refuse(token.at, fmt::format("\"{}\" is nothing that {} says; that is one of {}",
                                 one_line(token.text), part.field->name, fmt::join(words, ", ")));
  }

  std::vector<Token> tokens_;
  std::size_t end_, next_ = 0;
  int depth_ = 0;
};

bool holds(double number, const std::string& relation, double value) {
  if (relation == "=") return number == value;
  if (relation == "!=") return number != value;
  if (relation == "<") return number < value;
  if (relation == "<=") return number <= value;
  if (relation == ">") return number > value;
  return number >= value;
}

bool holds(const std::string& text, const std::string& relation, const std::string& value) {
  if (relation == "=") return text == value;
  if (relation == "~") return text.find(value) != std::string::npos;
  const std::optional<double> number = number_of(text);
  return number && holds(*number, relation, *number_of(value));
}

FieldValue value_of(const Part& part, const AskedLane& lane) {
  if (part.field != nullptr) return part.field->value(lane);
  std::vector<std::string> found;
  for (const auto& [key, value] : lane.lane().attributes) {
    if (key == part.key) found.push_back(value);
  }
  if (found.empty()) return {};
  return found;
}

bool holds(const FieldValue& field, const std::string& relation, const std::string& value) {
  const bool is_said = !std::holds_alternative<std::monostate>(field);
  if (value == "none" && !is_said) return relation == "=";
  if (const double* number = std::get_if<double>(&field)) {
    if (value == "none") return relation == "!=";
    return holds(*number, relation, *number_of(value));
  }
  const auto* texts = std::get_if<std::vector<std::string>>(&field);
  if (texts == nullptr) return false;
  if (relation == "!=") return std::ranges::find(*texts, value) == texts->end();
  return std::ranges::any_of(*texts,
                             [&](const std::string& text) { return holds(text, relation, value); });
}

bool fits_part(const Part& part, const AskedLane& lane) {
  const auto fits = [&](const Part& inner) { return fits_part(inner, lane); };
  switch (part.kind) {
    case Kind::any:
      return std::ranges::any_of(part.parts, fits);
    case Kind::all:
      return std::ranges::all_of(part.parts, fits);
    case Kind::none:
      return !fits(part.parts.front());
    case Kind::comparison:
      break;
  }
  const FieldValue field = value_of(part, lane);
  return std::ranges::any_of(
      part.values, [&](const std::string& value) { return holds(field, part.relation, value); });
}

}  // namespace

LaneQuestion::LaneQuestion(std::string_view question)
    : part_(std::make_unique<const Part>(Parser(question).parse())) {}
LaneQuestion::~LaneQuestion() = default;
LaneQuestion::LaneQuestion(LaneQuestion&&) noexcept = default;
LaneQuestion& LaneQuestion::operator=(LaneQuestion&&) noexcept = default;

bool LaneQuestion::fits(const AskedLane& lane) const { return fits_part(*part_, lane); }

std::string question_fault(const std::string& question) {
  try {
    const LaneQuestion parsed(question);
    return {};
  } catch (const QuestionFault& fault) {
    return fault.what();
  }
}

std::vector<LaneId> lanes_that_fit(const RoadMap& road_map, const LaneQuestion& question) {
  std::vector<LaneId> found;
  for (const Lane& lane : road_map.lanes()) {
    if (question.fits({road_map, lane})) found.push_back(lane.id);
  }
  return found;
}

}  // namespace roadbed::map::query
