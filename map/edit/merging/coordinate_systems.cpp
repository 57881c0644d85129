#include "roadbed/map/edit/merging/coordinate_systems.h"

#include <fmt/format.h>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

std::string named(const CoordinateSystem& system) {
  std::string text = system.crs.empty() ? "an unknown system" : fmt::format("\"{}\"", system.crs);
  if (!system.offset.isZero()) {
    text += fmt::format(" with offset {}, {}", system.offset.x(), system.offset.y());
  }
  return text;
}

}  // namespace

void require_same_system(const CoordinateSystem& first, const std::string& first_name,
                         const CoordinateSystem& second, const std::string& second_name) {
  if (first.crs == second.crs && first.offset == second.offset) return;
  throw InputError({.file = second_name,
                    .found = fmt::format("coordinates in {}, those of {} are in {}", named(second),
                                         first_name, named(first)),
                    .needed = "maps in one coordinate system",
                    .remedy = "bring one into the other with: roadbed map transform --to; or say "
                              "--same-system where they are the same"});
}

}  // namespace roadbed::map::edit::merging
