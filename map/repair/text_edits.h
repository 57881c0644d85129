#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::map::inline repair {

/// A part of a text that another takes the place of; of size 0 it is put in between.
struct TextEdit {
  std::size_t at = 0, size = 0;
  std::string text;
};

/// Whether a part of one lies in the other; two that put something in at one place do not.
bool overlap(const TextEdit& a, const TextEdit& b);

/// The text with all edits made, those at one place in their order. They must not overlap.
std::string edited(std::string_view text, std::vector<TextEdit> edits);

/// An element of an XML text by where it stands: what is edited is the text itself, so that all
/// else stays byte for byte.
class XmlElementText {
 public:
  /// @param inside  of its start tag. @throws std::invalid_argument if no tag is around it.
  XmlElementText(std::string_view text, std::size_t inside);

  /// Gives an attribute a value, in place of the one that it has.
  TextEdit with_attribute(std::string_view name, std::string_view value) const;

  /// Puts an element behind all that stands in this one, on a line of its own.
  TextEdit with_last_child(std::string_view child) const;

  /// Puts an element before this one, on a line of its own.
  TextEdit with_sibling_before(std::string_view sibling) const;
  /// The same behind it.
  TextEdit with_sibling_behind(std::string_view sibling) const;

  /// Takes the element away, with the blanks before it.
  TextEdit without() const;

  std::string_view whole() const;  ///< from its start tag to the end of its end tag
  TextEdit replaced_by(std::string_view other) const;

  std::size_t begin() const { return begin_; }

 private:
  std::size_t content_end() const;  ///< where its end tag begins; of an empty-element tag its "/>"
  std::size_t end() const;
  std::string_view indent() const;  ///< the line break and blanks before it

  std::string_view text_;
  std::size_t begin_ = 0, tag_end_ = 0;
  bool is_empty_ = false;
};

}  // namespace roadbed::map::repair
