#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/map/query/lane_strips.h"

namespace roadbed::map::inline query {

/// What a lane says in a field: nothing, a number, or texts, of which there are several in a list.
using FieldValue = std::variant<std::monostate, double, std::vector<std::string>>;

/// A lane of a map, for what its fields say; measured when first asked.
class AskedLane {
 public:
  AskedLane(const RoadMap& road_map, const Lane& lane) : map_(&road_map), lane_(&lane) {}

  const RoadMap& map() const { return *map_; }
  const Lane& lane() const { return *lane_; }
  const LaneLinks& links() const { return map_->graph().of(lane_->id); }
  const LaneMeasures& measures() const;

 private:
  const RoadMap* map_;
  const Lane* lane_;
  mutable std::optional<LaneMeasures> measures_;
};

/// Something that can be asked of every lane, by its name.
struct LaneField {
  std::string_view name;  ///< "speed"
  bool is_number = false;
  std::string_view what;  ///< for a help: "speed limit, of several the least [km/h]"
  FieldValue (*value)(const AskedLane& lane) = nullptr;
  /// The only words that it says; null of one that may say any.
  std::vector<std::string_view> (*words)() = nullptr;
};

/// All fields but `tag.KEY`, which is what the source says under a key.
std::span<const LaneField> lane_fields();

}  // namespace roadbed::map::query
