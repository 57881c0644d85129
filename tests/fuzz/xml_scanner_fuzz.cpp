// XML, scanned and as a document, or InputError out.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/files/xml_scanner.h"

namespace {

using namespace roadbed::map;

// Every start has its end, and names lie in the text.
void scan(std::string_view text) {
  XmlScanner scanner(text, "fuzz");
  std::size_t open = 0;
  for (auto event = scanner.next(); event != XmlScanner::Event::done; event = scanner.next()) {
    open += event == XmlScanner::Event::start ? 1 : static_cast<std::size_t>(-1);
    const char* const name = scanner.name().data();
    const bool inside = name >= text.data() && name < text.data() + text.size();
    if (!inside || scanner.offset() >= text.size() || scanner.depth() != open) std::abort();
    // A control character becomes visible: `\u0000`.
    if (scanner.value("k").size() > 6 * text.size()) std::abort();
  }
  scanner.expect_end();
}

template <typename Ask>
void tried(const Ask& ask) {
  try {
    ask();
  } catch (const InputError&) {
    return;  // refused, as it should be
  }
}

// Each element is asked for a number, a text and a place.
void ask_document(const std::string& text) {
  const XmlDocument document(text, "fuzz");
  for (pugi::xml_node node = document.root(); node; node = node.first_child()) {
    if (document.line_of(node) < 1) std::abort();
    tried([&] { document.number(node, "k"); });
    tried([&] { document.number_or(node, "k", 1.0); });
    tried([&] { document.integer(node, "k"); });
    tried([&] { document.optional_integer(node, "k"); });
    tried([&] { document.text_number(node, node.first_child().name()); });
    tried([&] {
      pugi::xml_attribute next = node.first_attribute();
      document.number(node, "v", next);
      document.optional_number(node, "k", next);
      xml_text(document.text(node, "k"));
    });
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  tried([&] { scan(text); });
  tried([&] { ask_document(text); });
  html_text(text);
  return 0;
}
