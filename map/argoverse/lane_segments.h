#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "roadbed/map/argoverse/frame.h"
#include "roadbed/map/argoverse/values.h"
#include "roadbed/map/elements/map_content.h"

namespace roadbed::map::argoverse {

/// What a lane segment says of others, by their ids.
struct NamedLinks {
  std::vector<std::int64_t> successors, predecessors;
  std::optional<std::int64_t> left, right;
};

/// Lanes of the file's lane segments, in its order, and what they say of each other.
class LaneSegments {
 public:
  /// Adds a lane. One that encloses no strip, or whose id another one has, is remarked and left
  /// out.
  /// @throws InputError if a value is unusable.
  void add(const Entry& entry, Frame& frame, std::vector<ImportDiagnostic>& remarks);

  /// Links as the file names them; lanes outside the file are counted, and kept with the lane that
  /// names them. Lanes may be changed where
  /// the marking can be crossed and the borders run within 1 m of each other.
  std::vector<LaneLinks> links(std::vector<ImportDiagnostic>& remarks);

  /// One junction for each group of lanes inside an intersection: those that lead to or from the
  /// same lane, lie side by side, or whose centrelines come within 2 m of each other. Named by the
  /// least id of its lanes. Sets `Lane::junction`.
  std::vector<Junction> group_intersections();

  std::vector<Lane> take_lanes() { return std::move(lanes_); }
  bool empty() const { return lanes_.empty(); }

 private:
  std::optional<LaneId> find(std::int64_t id) const;

  std::vector<Lane> lanes_;
  std::vector<std::int64_t> ids_;
  std::vector<bool> is_intersection_;
  std::vector<NamedLinks> named_;
  std::unordered_map<std::int64_t, LaneId> lane_of_id_;
};

}  // namespace roadbed::map::argoverse
