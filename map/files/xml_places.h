#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace roadbed::map::inline files {

// Places in the text of elements of XML, for what is changed in the text itself. The text has been
// parsed before: its tags end.

/// Behind the `>` of the tag that begins at `at`; values of attributes may hold one.
std::size_t xml_tag_end(std::string_view text, std::size_t at);

/// The name in the start tag that begins there.
std::string_view xml_tag_name(std::string_view text, std::size_t at);

/// A part of a text.
struct TextSpan {
  std::size_t at = 0, size = 0;
};

/// Where the value of an attribute stands in a start tag, without its quotes.
std::optional<TextSpan> xml_value_in(std::string_view tag, std::string_view name);

/// Where the end tag begins that belongs to the start tag which ends at `tag_end`. Comments,
/// sections of characters and instructions in between may hold tags.
std::size_t xml_content_end(std::string_view text, std::size_t tag_end);

/// The whole element that begins there.
std::string_view xml_element_at(std::string_view text, std::size_t at);

}  // namespace roadbed::map::files
