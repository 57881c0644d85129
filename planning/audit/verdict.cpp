#include "roadbed/planning/audit/verdict.h"

#include <array>

namespace roadbed::planning::inline audit {

std::string_view to_string(Verdict verdict) {
  constexpr std::array<std::string_view, 4> names{"clear", "conflict", "unknown", "undecided"};
  return names[static_cast<std::size_t>(verdict)];
}

}  // namespace roadbed::planning::audit
