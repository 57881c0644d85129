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

// Elements that a scanner comes to, up to the end of the first or of the stretch.
std::size_t count_elements(XmlScanner scanner, bool is_last) {
  std::size_t elements = 0;
  auto event = scanner.next();
  for (; event == XmlScanner::Event::start || scanner.depth() > 0; event = scanner.next()) {
    if (event == XmlScanner::Event::done) break;
    elements += event == XmlScanner::Event::start ? 1 : 0;
  }
  if ((scanner.depth() == 0) != is_last) throw InputError({.file = "fuzz", .found = "no stretch"});
  if (is_last) scanner.expect_end();
  return elements;
}

// Two stretches that are both whole hold the elements of the text, which is well-formed then.
void scan_in_stretches(std::string_view text) {
  const std::size_t cut = text.find('<', text.size() / 2);
  if (cut == text.npos || cut == 0) return;
  const std::string root(root_element(text));
  if (root.empty()) return;
  std::size_t elements = 0;
  elements += count_elements({text, "fuzz", XmlScanner::Stretch{0, cut, {}}}, false);
  elements += count_elements({text, "fuzz", XmlScanner::Stretch{cut, text.size(), root}}, true);
  try {
    if (count_elements({text, "fuzz"}, true) != elements) std::abort();
  } catch (const InputError&) {
    std::abort();
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
  tried([&] { scan_in_stretches(text); });
  tried([&] { ask_document(text); });
  html_text(text);
  return 0;
}
