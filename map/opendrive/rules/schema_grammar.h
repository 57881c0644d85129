#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "roadbed/map/opendrive/rules/schema_table.h"

namespace roadbed::map::opendrive::rules {

/// The bounds of a number.
enum class Range { any, not_negative, positive, negative, zero, share };

bool is_in(Range range, double value);

/// Values of which an attribute has to have one.
struct Choice {
  std::vector<std::string_view> values;  ///< of the file's revision
  std::vector<std::string_view> others;  ///< of other revisions
  std::vector<std::string_view> shapes;  ///< with ^ for a capital letter and # for a digit
  std::optional<Range> range;            ///< of numbers, where any in it is a value, too

  bool has(std::string_view value) const;
};

struct ValueType {
  enum class Kind { text, filled, number, whole, choice } kind = Kind::number;
  Range range = Range::any;
  const Choice* choice = nullptr;  ///< if it is one
};

/// What the standard says of an attribute, or how often it wants a child element.
struct Need {
  std::string name;
  bool is_required = false;
  bool is_vital = false;  ///< in files of every revision: the program needs it
};

struct AttributeRule : Need {
  ValueType type;
};

struct ElementRule;

struct ChildRule : Need {
  const ElementRule* element = nullptr;
};

struct ElementRule {
  std::string_view type;
  std::vector<AttributeRule> attributes;
  std::vector<ChildRule> children;

  /// The rule of a child; of those of one name, looked for from `hint` on, which then is that.
  const ElementRule* child(std::string_view name, std::size_t& hint) const;
};

/// The table as it is for one revision of the standard. O(size of the table) to make.
class Grammar {
 public:
  /// @param minor  of revision 1.`minor`, 4 to 8; another one: only what holds for every file.
  /// @throws std::invalid_argument if the table names a type that it does not have.
  explicit Grammar(int minor);

  const ElementRule& root() const { return *root_; }

  /// Whether the file's revision is one whose schema the table knows.
  bool is_known() const { return minor_ != 0; }
  int minor() const { return minor_; }

 private:
  void read_choice(const ChoiceText& text);
  void read_element(const ElementText& text);
  ValueType type_of(std::string_view name) const;

  int minor_;
  std::unordered_map<std::string_view, Choice> choices_;
  std::unordered_map<std::string_view, std::unique_ptr<ElementRule>> elements_;
  const ElementRule* root_;
};

}  // namespace roadbed::map::opendrive::rules
