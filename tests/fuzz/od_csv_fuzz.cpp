#include <cstddef>
#include <cstdint>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/cli/place.h"
#include "roadbed/tools/files/points_csv.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed;
  try {
    for (const tools::OdRow& row :
         tools::parse_od_csv({reinterpret_cast<const char*>(data), size}, "fuzz.csv")) {
      tools::place_syntax_fault(row.from);
      tools::place_syntax_fault(row.to);
    }
  } catch (const map::InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
