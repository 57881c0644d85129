#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/index/lane_index.h"
#include "roadbed/map/index/lane_index_data.h"
#include "roadbed/map/storage/flat_array.h"
#include "roadbed/map/storage/lazy_list.h"

namespace roadbed::map::inline index {

/// What answers "which lane is here" and "which lane is called so".
struct RoadMapIndex {
  LaneIndex lanes;
  FlatArray<std::uint32_t> by_name;  ///< lanes in order of name, of equal names the first id first
  /// What the map amounts to (map_totals.h), as bytes. Empty: has to be added up.
  FlatArray<char> totals = {};
  /// What a user of the map has made of it and wants to find again in its compiled form: bytes that
  /// the map does not look into. Empty: nothing.
  FlatArray<char> routing = {};

  /// @param threads  that may be used.
  static RoadMapIndex of(const LazyList<Lane>& lanes, int threads = 1);

  /// O(log lanes).
  std::optional<LaneId> find(const LazyList<Lane>& in, std::string_view name) const;
};

/// Compares an index with what of() makes of lanes, which come one by one, in order of id: neither
/// of them has to be in memory. Keeps a box per cell of the index and the names of the lanes.
class RoadMapIndexCheck {
 public:
  /// @param index  outlives it.
  explicit RoadMapIndexCheck(const RoadMapIndex& index)
      : index_(index), lanes_(lane_index::make_check(index.lanes.data())) {}

  void add(const Lane& lane);

  /// Whether the index is that of the lanes added, which were all.
  bool holds();

 private:
  bool are_names_in_order() const;
  std::string_view name(std::uint32_t lane) const;

  const RoadMapIndex& index_;
  std::unique_ptr<lane_index::Check> lanes_;
  std::string names_;                      // one after the other
  std::vector<std::uint64_t> name_at_{0};  // where each begins, and the end
};

}  // namespace roadbed::map::index
