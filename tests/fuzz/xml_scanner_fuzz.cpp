#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/xml_scanner.h"

// Every start has its end, and names lie in the text.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed::map;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    XmlScanner scanner(text, "fuzz");
    std::size_t open = 0;
    for (auto event = scanner.next(); event != XmlScanner::Event::done; event = scanner.next()) {
      open += event == XmlScanner::Event::start ? 1 : static_cast<std::size_t>(-1);
      const char* const name = scanner.name().data();
      const bool inside = name >= text.data() && name < text.data() + text.size();
      if (!inside || scanner.offset() >= size || scanner.depth() != open) std::abort();
      // A control character becomes visible: `\u0000`.
      if (scanner.value("k").size() > 6 * size) std::abort();
    }
    scanner.expect_end();
  } catch (const InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
