#include "roadbed/map/derived/crowded.h"

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline derived {

void refuse_crowded(const std::string& element, const std::string& found) {
  throw InputError({.file = "map",
                    .element = element,
                    .found = found,
                    .needed = "roads that lie beside each other but for their junctions",
                    .remedy = "cut the map with map clip, or remove what lies there twice"});
}

}  // namespace roadbed::map::derived
