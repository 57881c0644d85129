#include <array>
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

// What can be read can be put together, cut in two, put on a ground or moved, and read again; which
// of them is done, its size says.
namespace {

using namespace roadbed::map;

void read_again(const std::string& bytes, const std::string& name) {
  parse_map(bytes, name, {.max_error_m = 100.0});  // points are not what is looked for
}

void put_together_twice(const std::string& bytes) {
  read_again(merge({{bytes, "one"}, {bytes, "two"}}).bytes, "twice");
}

void cut_and_put_together(const std::string& bytes) {
  using roadbed::geometry::box_ring;
  std::vector<MergeInput> halves;
  for (const double x : {-1e9, 20.0}) {
    const Region half({box_ring({x, -1e9}, {x < 0.0 ? 20.0 : 1e9, 1e9})});
    Edited part = clip(bytes, "fuzz", half);
    if (!part.bytes.empty()) halves.push_back({std::move(part.bytes), "half"});
  }
  if (!halves.empty()) read_again(merge(std::move(halves)).bytes, "together");
}

void put_on_ground(const std::string& bytes) {
  const auto ground = [](std::span<const Eigen::Vector2d> at) {
    std::vector<std::optional<double>> heights_m(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (at[i].x() > 0.0) heights_m[i] = 0.1 * at[i].y();
    }
    return heights_m;
  };
  read_again(elevate(bytes, "fuzz", ground).bytes, "higher");
}

void move(const std::string& bytes) {
  const RigidMotion motion{1.0, {10.0, 20.0, 1.0}};
  read_again(transform(bytes, "fuzz", {.motion = motion, .to = {}, .crs = {}}).bytes, "moved");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  constexpr std::array edits{put_together_twice, cut_and_put_together, put_on_ground, move};
  try {
    edits[size % edits.size()](bytes);
  } catch (const InputError&) {
    return 0;  // refused, as it should be
  }
  return 0;
}
