#pragma once

#include <memory>

#include "roadbed/map/index/lane_index_data.h"

namespace roadbed::map::inline index::lane_index {

/// Compares arrays with those that build() makes of lanes, which come one by one, in order of id:
/// neither the lanes nor the arrays have to be in memory. Keeps a box per cell.
class Check {
 public:
  Check() = default;
  virtual ~Check() = default;
  Check(const Check&) = delete;
  Check& operator=(const Check&) = delete;

  virtual void add(const Lane& lane) = 0;

  /// Whether the arrays are those of the lanes added, which were all.
  virtual bool holds() = 0;
};

/// @param data  outlives the check.
std::unique_ptr<Check> make_check(const Data& data);

}  // namespace roadbed::map::index::lane_index
