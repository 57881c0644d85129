#pragma once

#include <map>
#include <string>
#include <string_view>

namespace roadbed::map::inline files {

/// The template with each part put where it says {{name}}. What is put in is not searched again,
/// so that no text of the input can name a part.
/// @throws std::out_of_range if the template names a part that is not there.
std::string filled_page(std::string_view page,
                        const std::map<std::string_view, std::string>& parts);

/// JSON that may stand in a <script> element: `<`, `>` and `&` are written as \u003c and so on,
/// which JSON allows inside its strings, the only place where it has them.
std::string json_for_script(std::string_view json);

}  // namespace roadbed::map::files
