#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::tools::inline files {

/// JSON as it is written: keys in the order in which they were given.
using Json = nlohmann::ordered_json;

/// What a document of this kind says first, before its own members: `{"roadbed_route": 1, …}`. The
/// rule about versions is in tools/README.md.
Json versioned(std::string_view kind, const Json& document, int version = 1);

/// Bounds of a number, both allowed.
struct Range {
  double least, most;
};

/// A value of a JSON document that knows its place, so that a fault is reported where it is:
/// `town.json:/obstacles/2/length_m: is -4, needs 0.05 to 100; …`. The place is a JSON pointer
/// (RFC 6901). Every function throws InputError if the value is not what is asked for.
class JsonNode {
 public:
  JsonNode(const nlohmann::json& value, std::string file, std::string pointer = "");

  const nlohmann::json& value() const { return *value_; }
  const std::string& file() const { return file_; }
  const std::string& pointer() const { return pointer_; }

  /// Refuses a value that is no object, or has a key that is not one of these.
  void require_object(std::initializer_list<std::string_view> known_keys) const;

  /// Refuses a document that says, by its member `roadbed_KIND`, that it is of another version than
  /// this program knows; one that says nothing is of the first.
  void check_version(std::string_view kind, int newest = 1) const;

  /// Member that must be there.
  JsonNode at(std::string_view key) const;

  /// Member that may be missing.
  std::optional<JsonNode> find(std::string_view key) const;

  /// Elements of an array.
  std::vector<JsonNode> elements() const;

  /// Members of an object, in the order of their keys.
  std::vector<std::pair<std::string, JsonNode>> members() const;

  /// A finite number within the range.
  double number(Range range) const;

  /// Number of a member, or `otherwise` if it is missing.
  double number_or(std::string_view key, double otherwise, Range range) const;

  bool boolean() const;

  /// A string that is not empty.
  std::string text() const;

  /// The same, made one line (map/files/visible_text.h): of what is printed by this name.
  std::string name() const;

  /// The same, refused where it has control characters: of what is looked for by this name.
  std::string one_line() const;

  [[noreturn]] void refuse(const std::string& found, const std::string& needed,
                           const std::string& remedy) const;

 private:
  const nlohmann::json* value_;
  std::string file_, pointer_;
};

/// Parses a document; a key that stands twice in one object is refused, as one of the two values
/// would be lost.
/// @throws InputError with the byte at which the text stops to be JSON.
nlohmann::json parse_json_strictly(std::string_view bytes, const std::string& file);

}  // namespace roadbed::tools::files
