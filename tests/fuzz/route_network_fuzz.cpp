#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "roadbed/planning/route/route_graph.h"
#include "roadbed/planning/route/route_network.h"

// What a sound network is used for must not read beyond it. The last byte says how many lanes the
// map has.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed::planning;
  if (size == 0) return 0;
  try {
    const auto network =
        read_route_network({reinterpret_cast<const char*>(data), size - 1}, data[size - 1]);
    if (!network) return 0;
    const RouteOptions options;
    const RoutingCostModel rules(*network, options);
    weigh_all(make_route_graph(*network), rules);
  } catch (const std::invalid_argument&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
