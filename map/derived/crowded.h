#pragma once

#include <string>

namespace roadbed::map::inline derived {

/// Refuses a map whose lanes lie so thick that what is asked of them would take endless work.
/// @param element  what cannot be told of it.
/// @throws InputError always.
[[noreturn]] void refuse_crowded(const std::string& element, const std::string& found);

}  // namespace roadbed::map::derived
