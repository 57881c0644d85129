#pragma once

#include <string>
#include <string_view>

namespace roadbed::tools::inline report {

/// Text for HTML and SVG, in elements and in quoted attributes: & < > " ' are written as entities,
/// control characters other than tab and newline and bytes that are no UTF-8 as U+FFFD.
std::string escape_markup(std::string_view text);

/// JSON that may stand in a <script> element: `<`, `>` and `&` are written as \u003c and so on,
/// which JSON allows inside its strings, the only place where it has them.
std::string escape_json_for_script(std::string_view json);

}  // namespace roadbed::tools
