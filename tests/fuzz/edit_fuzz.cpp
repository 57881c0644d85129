#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/edit/clip.h"
#include "roadbed/map/edit/merge.h"
#include "roadbed/map/edit/transform.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"

// What can be read can be cut in two, put together and moved, and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed::map;
  using roadbed::geometry::box_ring;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    parse_map(merge({{bytes, "one"}, {bytes, "two"}}).bytes, "twice");
    std::vector<MergeInput> halves;
    for (const double x : {-1e9, 20.0}) {
      const Region half({box_ring({x, -1e9}, {x < 0.0 ? 20.0 : 1e9, 1e9})});
      Edited part = clip(bytes, "fuzz", half);
      if (!part.bytes.empty()) halves.push_back({std::move(part.bytes), "half"});
    }
    if (!halves.empty()) parse_map(merge(std::move(halves)).bytes, "together");
    const RigidMotion motion{1.0, {10.0, 20.0, 1.0}};
    parse_map(transform(bytes, "fuzz", {.motion = motion, .to = {}, .crs = {}}).bytes, "moved");
  } catch (const InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
