#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "roadbed/planning/route/route_graph.h"
#include "roadbed/planning/route/route_network.h"

// What a sound network is used for must not read beyond it. Bytes of the present version, whatever
// that is; the last one says how many lanes the map has.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed::planning;
  if (size == 0) return 0;
  static const std::string version = write_route_network({}).substr(0, sizeof(std::uint32_t));
  try {
    const std::string bytes = version + std::string(reinterpret_cast<const char*>(data), size - 1);
    const auto network = read_route_network(bytes, data[size - 1]);
    if (!network) return 0;
    const RouteOptions options;
    const RoutingCostModel rules(*network, options);
    weigh_all(make_route_graph(*network), rules);
  } catch (const std::invalid_argument&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
