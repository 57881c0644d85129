#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/edit/clipping/clip.h"
#include "roadbed/map/edit/elevation/elevate.h"
#include "roadbed/map/edit/merging/merge.h"
#include "roadbed/map/edit/transforming/transform.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"

// What can be read can be cut in two, put together, put on a ground and moved, and read again.
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
    const auto ground = [](std::span<const Eigen::Vector2d> at) {
      std::vector<std::optional<double>> heights_m(at.size());
      for (std::size_t i = 0; i < at.size(); ++i) {
        if (at[i].x() > 0.0) heights_m[i] = 0.1 * at[i].y();
      }
      return heights_m;
    };
    parse_map(elevate(bytes, "fuzz", ground).bytes, "higher");
    const RigidMotion motion{1.0, {10.0, 20.0, 1.0}};
    parse_map(transform(bytes, "fuzz", {.motion = motion, .to = {}, .crs = {}}).bytes, "moved");
  } catch (const InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
