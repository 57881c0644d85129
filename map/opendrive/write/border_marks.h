#pragma once

#include <string>
#include <string_view>

#include "roadbed/map/opendrive/write/road_plan.h"
#include "roadbed/map/opendrive/write/road_shape.h"

namespace roadbed::map::opendrive {

/// What holds from a station of the road on.
template <typename Value>
struct FromStation {
  double s_m = 0.0;
  Value value{};
};

/// What holds along a lane from its stations on, by the road's s.
/// @param from_m  the lane's stations, growing, one per value.
template <typename Value>
std::vector<FromStation<Value>> along_road(const SectionShape& shape, std::size_t lane,
                                           bool forward, double length_m,
                                           const std::vector<double>& from_m,
                                           const std::vector<Value>& values) {
  std::vector<FromStation<Value>> made;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t place = forward ? i : values.size() - 1 - i;
    const double begin_m = forward                     ? from_m[place]
                           : place + 1 < values.size() ? from_m[place + 1]
                                                       : length_m;
    made.push_back({shape.road_s_m(lane, begin_m), values[place]});
  }
  return made;
}

/// The <roadMark> elements of border `place` of a section over [from, to] of the road: type, colour
/// and width as a lane beside it has them, laneChange by where the lanes may be left for each
/// other.
std::string marks_text(const RoadMap& road_map, const PlannedSection& section,
                       const SectionShape& shape, std::size_t place, double from_m, double to_m,
                       int minor);

}  // namespace roadbed::map::opendrive
