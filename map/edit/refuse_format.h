#pragma once

#include <string>
#include <string_view>

#include "roadbed/map/formats.h"

namespace roadbed::map::inline edit {

/// That maps of a format cannot be edited so.
/// @param needed  the formats of which they can.
/// @throws InputError always.
[[noreturn]] void refuse_format(const Format& format, const std::string& name,
                                std::string_view needed);

}  // namespace roadbed::map::edit
