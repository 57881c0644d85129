#include "roadbed/map/edit/dispatch.h"

#include <fmt/format.h>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline edit {

void refuse_format(const Format& format, const std::string& name) {
  throw InputError({.file = name,
                    .found = fmt::format("a map of format {}", format.name),
                    .needed = "OpenDRIVE or Lanelet2 (clips: CommonRoad, too)",
                    .remedy = "give the file that it was made from"});
}

}  // namespace roadbed::map::edit
