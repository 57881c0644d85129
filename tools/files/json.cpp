#include "roadbed/tools/files/json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/parse_json.h"
#include "roadbed/map/files/visible_text.h"

namespace roadbed::tools::inline files {
namespace {

std::string escaped(std::string_view key) {
  std::string token;
  for (const char c : key) {
    if (c == '~') {
      token += "~0";
    } else if (c == '/') {
      token += "~1";
    } else {
      token += c;
    }
  }
  return token;
}

[[noreturn]] void refuse_text(const std::string& file, std::size_t byte, const std::string& found) {
  throw map::InputError({.file = file,
                         .place = fmt::format("byte {}", byte),
                         .found = found,
                         .remedy = "mend the text"});
}

}  // namespace

Json versioned(std::string_view kind, const Json& document, int version) {
  Json whole = {{fmt::format("roadbed_{}", kind), version}};
  whole.update(document);
  return whole;
}

JsonNode::JsonNode(const nlohmann::json& value, std::string file, std::string pointer)
    : value_(&value), file_(std::move(file)), pointer_(std::move(pointer)) {}

void JsonNode::require_object(std::initializer_list<std::string_view> known_keys) const {
  for (const auto& [key, member] : members()) {
    if (std::find(known_keys.begin(), known_keys.end(), key) != known_keys.end()) continue;
    member.refuse("is not a known key", fmt::format("one of {}", fmt::join(known_keys, ", ")),
                  "mend its name or remove it");
  }
}

void JsonNode::check_version(std::string_view kind, int newest) const {
  const auto version = find(fmt::format("roadbed_{}", kind));
  if (!version) return;
  const nlohmann::json& number = version->value();
  for (int known = 1; known <= newest; ++known) {
    if (number == known) return;
  }
  version->refuse(fmt::format("is {}, a version that this program does not know", number.dump()),
                  newest == 1 ? std::string("1") : fmt::format("1 to {}", newest),
                  "use the roadbed that wrote it, or a newer one");
}

JsonNode JsonNode::at(std::string_view key) const {
  if (std::optional<JsonNode> member = find(key)) return *member;
  refuse(fmt::format("has no key \"{}\"", key), "it", "add it");
}

std::optional<JsonNode> JsonNode::find(std::string_view key) const {
  if (!value_->is_object()) {
    refuse(fmt::format("is {}", value_->type_name()), "an object", "write {\"key\": …}");
  }
  const auto member = value_->find(key);
  if (member == value_->end()) return std::nullopt;
  return JsonNode(*member, file_, pointer_ + "/" + escaped(key));
}

std::vector<JsonNode> JsonNode::elements() const {
  if (!value_->is_array()) {
    refuse(fmt::format("is {}", value_->type_name()), "an array", "write […]");
  }
  std::vector<JsonNode> nodes;
  for (std::size_t i = 0; i < value_->size(); ++i) {
    nodes.emplace_back((*value_)[i], file_, fmt::format("{}/{}", pointer_, i));
  }
  return nodes;
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
  if (!value_->is_object()) {
    refuse(fmt::format("is {}", value_->type_name()), "an object", "write {\"key\": …}");
  }
  std::vector<std::pair<std::string, JsonNode>> nodes;
  for (auto member = value_->begin(); member != value_->end(); ++member) {
    nodes.emplace_back(member.key(),
                       JsonNode(*member, file_, pointer_ + "/" + escaped(member.key())));
  }
  return nodes;
}

double JsonNode::number(Range range) const {
  if (!value_->is_number()) {
    refuse(fmt::format("is {}", value_->type_name()), "a number", "write one");
  }
  const double number = value_->get<double>();
  if (!(number >= range.least && number <= range.most)) {
    refuse(fmt::format("is {}", number), fmt::format("{} to {}", range.least, range.most),
           "change it");
  }
  return number;
}

double JsonNode::number_or(std::string_view key, double otherwise, Range range) const {
  const std::optional<JsonNode> member = find(key);
  return member ? member->number(range) : otherwise;
}

bool JsonNode::boolean() const {
  if (!value_->is_boolean()) {
    refuse(fmt::format("is {}", value_->type_name()), "true or false", "write one of them");
  }
  return value_->get<bool>();
}

std::string JsonNode::text() const {
  if (!value_->is_string()) {
    refuse(fmt::format("is {}", value_->type_name()), "a string", "write \"…\"");
  }
  std::string text = value_->get<std::string>();
  if (text.empty()) refuse("is empty", "a text", "fill it in");
  if (text.find('\0') != text.npos) {  // of a file's name the system would see what is before it
    refuse("holds a zero byte", "a text", "take it out");
  }
  return text;
}

std::string JsonNode::name() const { return map::one_line(text()); }

std::string JsonNode::one_line() const {
  std::string line = text();
  if (map::one_line(line) != line) {
    refuse("has a control character", "one line of text", "take it out");
  }
  return line;
}

void JsonNode::refuse(const std::string& found, const std::string& needed,
                      const std::string& remedy) const {
  throw map::InputError({.file = file_,
                         .place = pointer_.empty() ? "/" : pointer_,
                         .found = found,
                         .needed = needed,
                         .remedy = remedy});
}

nlohmann::json parse_json_strictly(std::string_view bytes, const std::string& file) {
  try {
    return map::parse_json(bytes, file);
  } catch (const nlohmann::json::parse_error& error) {
    refuse_text(file, error.byte, "is not JSON here");
  } catch (const nlohmann::json::out_of_range&) {
    throw map::InputError({.file = file,
                           .found = "a number is too large for double precision",
                           .remedy = "write a smaller one"});
  }
}

}  // namespace roadbed::tools::files
