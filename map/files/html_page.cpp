#include "roadbed/map/files/html_page.h"

namespace roadbed::map::inline files {

std::string filled_page(std::string_view page,
                        const std::map<std::string_view, std::string>& parts) {
  std::string result;
  for (;;) {
    const std::size_t open = page.find("{{"), close = page.find("}}", open);
    if (open == std::string_view::npos || close == std::string_view::npos) break;
    result += page.substr(0, open);
    result += parts.at(page.substr(open + 2, close - open - 2));
    page.remove_prefix(close + 2);
  }
  result += page;
  return result;
}

std::string json_for_script(std::string_view json) {
  std::string escaped;
  escaped.reserve(json.size());
  for (const char letter : json) {
    if (letter == '<') {
      escaped += "\\u003c";
    } else if (letter == '>') {
      escaped += "\\u003e";
    } else if (letter == '&') {
      escaped += "\\u0026";
    } else {
      escaped += letter;
    }
  }
  return escaped;
}

}  // namespace roadbed::map::files
