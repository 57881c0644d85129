#pragma once

#include <string>
#include <string_view>

namespace roadbed::map::inline files {

/// What the value of an attribute says: references to characters (`&lt;`, `&#228;`) replaced, those
/// to anything else left as they are, and every break, "\r\n" being one, or tab a space.
std::string decode_xml(std::string_view raw);

/// Text for XML, in elements and in double quotes: & < > " are written as entities, control
/// characters as blanks, bytes that are no UTF-8 as U+FFFD.
std::string xml_text(std::string_view text);

/// Text for HTML and for SVG inside it: the same, but ' is an entity, too, tabs and line breaks
/// stay, and other control characters become U+FFFD.
std::string html_text(std::string_view text);

/// Whether bytes begin as XML does, blanks and a byte order mark left out.
bool looks_like_xml(const std::string& bytes);

/// Whether XML says, by its first bytes or its declaration, that it is not UTF-8.
bool is_other_encoding(std::string_view bytes);

/// XML in UTF-8, its elements on the same lines; as it stands if it is not well-formed.
std::string in_utf8(std::string bytes);

}  // namespace roadbed::map::files
