#include "roadbed/map/repair/element_text.h"

#include <string_view>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline repair {

XmlElementText text_of(const std::string& bytes, pugi::xml_node node) {
  const std::string_view name = node.name();
  const auto at = static_cast<std::size_t>(node.offset_debug());
  if (node.offset_debug() < 0 || std::string_view(bytes).substr(at, name.size()) != name) {
    throw InputError({.found = "text that is not in UTF-8, or has control characters in it",
                      .needed = "a file in UTF-8 without them, also as &#10;",
                      .remedy = "convert it, as with iconv, or write each name on one line"});
  }
  return {bytes, at};
}

}  // namespace roadbed::map::repair
