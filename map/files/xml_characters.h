#pragma once

#include <string>
#include <string_view>

namespace pugi {
class xml_node;
}

namespace roadbed::map::inline files {

/// What the value of an attribute says, on one line: references to characters (`&lt;`, `&#228;`)
/// replaced, those to anything else left as they are, and every break, "\r\n" being one, or tab a
/// space; other controls of ASCII become `\u001b`.
std::string decode_xml(std::string_view raw);

/// Text for XML, in elements and in double quotes: & < > " are written as entities, control
/// characters of ASCII as blanks, others and what turns the direction of text by number
/// (`&#x202e;`), which means the same; bytes that are no UTF-8, and U+FFFE and U+FFFF, which
/// XML 1.0 forbids, as U+FFFD.
std::string xml_text(std::string_view text);

/// Text for HTML and for SVG inside it: the same, but ' is an entity, too, tabs and line breaks
/// stay, other control characters of ASCII become U+FFFD, and what is hidden is shown as `\u202e`,
/// as a page would turn around what follows it.
std::string html_text(std::string_view text);

/// Whether bytes begin as XML does, blanks and a byte order mark left out.
bool looks_like_xml(const std::string& bytes);

/// Whether XML says, by its first bytes or its declaration, that it is not UTF-8.
bool is_other_encoding(std::string_view bytes);

/// XML whose names hold no control characters of ASCII, written as such or by number (`&#27;`):
/// breaks and tabs by number become blanks, others are written as `\u001b`. Elements keep their
/// lines, what is in UTF-16 becomes UTF-8.
std::string without_controls(std::string bytes);

/// Makes the declaration of a document that was read from another encoding say that it is in UTF-8;
/// one whose encoding pugixml does not know was read, and is written, as it stands.
void declare_utf8(pugi::xml_node declaration);

/// XML in UTF-8, as its declaration says then, its elements on the same lines; as it stands if it
/// is not well-formed.
std::string in_utf8(std::string bytes);

}  // namespace roadbed::map::files
