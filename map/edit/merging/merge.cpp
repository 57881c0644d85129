#include "roadbed/map/edit/merging/merge.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "roadbed/map/edit/refuse_format.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"

namespace roadbed::map::inline edit::inline merging {

Merged merge(std::vector<MergeInput> inputs, const MergeOptions& options) {
  if (inputs.empty()) throw std::invalid_argument("merge: no map");
  const Format* format = nullptr;
  for (MergeInput& input : inputs) {
    MapBytes map = map_bytes(std::move(input.bytes), input.name);
    if (format != nullptr && format != &map.format) {
      throw InputError(
          {.file = input.name,
           .found = fmt::format("{}, the first map is {}", map.format.name, format->name),
           .needed = "maps of one format",
           .remedy = "convert it first"});
    }
    format = &map.format;
    input.bytes = std::move(map.bytes);
  }
  if (format->name == "OpenDRIVE") return merge_open_drive(std::move(inputs), options);
  if (format->name == "Lanelet2") return merge_lanelet2(std::move(inputs), options);
  if (format->name == "CommonRoad") return merge_common_road(std::move(inputs), options);
  refuse_format(*format, inputs.front().name, "OpenDRIVE, Lanelet2 or CommonRoad");
}

}  // namespace roadbed::map::edit::merging
