#pragma once

#include <cstdint>

#include "roadbed/map/elements/lane.h"

namespace roadbed::map::inline elements {

/// A set of lane types, as those that a question is about.
class LaneTypes {
 public:
  static LaneTypes all() {
    return those([](LaneType) { return true; });
  }
  static LaneTypes drivable() { return those(is_drivable); }
  static LaneTypes surface() { return those(is_surface); }

  bool has(LaneType type) const { return has(static_cast<std::uint32_t>(type)); }
  bool has(std::uint32_t type) const { return type < 32 && (bits_ >> type & 1U) != 0; }

 private:
  template <typename Wants>
  static LaneTypes those(const Wants& wants) {
    LaneTypes made;
    for (std::uint32_t type = 0; type <= static_cast<std::uint32_t>(LaneType::other); ++type) {
      if (wants(static_cast<LaneType>(type))) made.bits_ |= 1U << type;
    }
    return made;
  }

  std::uint32_t bits_ = 0;
};

}  // namespace roadbed::map::elements
