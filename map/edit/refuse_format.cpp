#include "roadbed/map/edit/refuse_format.h"

#include <fmt/format.h>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map::inline edit {

void refuse_format(const Format& format, const std::string& name, std::string_view needed) {
  const bool is_compiled = format.name == "compiled map";
  throw InputError({.file = name,
                    .found = fmt::format("its format is {}", format.name),
                    .needed = std::string(needed),
                    .remedy = is_compiled ? "give the file that it was made from"
                                          : "convert it, see: roadbed convert --help"});
}

}  // namespace roadbed::map::edit
