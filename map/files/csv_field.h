#pragma once

#include <string>
#include <string_view>

namespace roadbed::map::inline files {

/// A text as a field of CSV (RFC 4180), on one line: in quotes where it holds commas or quotes,
/// with what is hidden written as `\u001b`. A text that begins as a spreadsheet's formula does (= +
/// - @) gets a ' before it, as OWASP advises, unless it is a number, or numbers with commas between
/// them.
std::string csv_field(std::string_view text);

}  // namespace roadbed::map::files
