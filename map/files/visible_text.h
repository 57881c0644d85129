#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace roadbed::map::inline files {

/// A character of UTF-8 (Unicode, table 3-7).
struct Utf8Character {
  char32_t code;     ///< the byte itself where it begins no character
  std::size_t size;  ///< bytes that it takes; 0 where the byte begins no character
};

/// The character that begins at a byte of the text.
Utf8Character character_at(std::string_view text, std::size_t at);

/// How much of the text is left when a last character that is cut off is taken away.
std::size_t size_of_whole_characters(std::string_view text);

/// Whether a character does something in place of being seen: the controls C0, DEL and C1, but for
/// tabs and line feeds; the separators U+2028 and U+2029; the marks that turn the direction of text
/// (U+061C, U+200E, U+200F, U+202A to U+202E, U+2066 to U+2069).
bool is_hidden(char32_t code);

/// Text for terminals, logs and JSON: what is hidden is written as JSON does, `\u001b`, and a byte
/// that is no UTF-8 as `\x9b`. What is written so already stays: JSON means the same before and
/// after, as nothing of this stands outside its strings.
std::string visible_text(std::string_view text);

/// The same, into the end of what is there.
void append_visible(std::string_view text, std::string& made);

/// Makes a name, or a message that holds names, one line: line breaks and tabs become spaces, other
/// controls of ASCII are written as `\u001b`. So no name ends a line of what it is printed in.
void make_one_line(std::string& text);

/// The same of a copy.
std::string one_line(std::string text);

}  // namespace roadbed::map::files
