#pragma once

#include <string_view>

namespace roadbed::map::inline elements {

/// Attributes of a lane from a file that is a part of a larger map: the ids of lanes that follow
/// it, or lead to it, and are not in the file.
inline constexpr std::string_view kSuccessorsOutside = "successors_outside";
inline constexpr std::string_view kPredecessorsOutside = "predecessors_outside";

}  // namespace roadbed::map::elements
