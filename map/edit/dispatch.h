#pragma once

#include <string>

#include "roadbed/map/formats.h"

namespace roadbed::map::inline edit {

/// That a format cannot be edited: one that holds no document, as a compiled map.
/// @throws InputError always.
[[noreturn]] void refuse_format(const Format& format, const std::string& name);

}  // namespace roadbed::map::edit
