#include "roadbed/map/elements/side.h"

#include <algorithm>

#include "roadbed/geometry/primitives/segment.h"

namespace roadbed::map::inline elements {
namespace {

using Line = std::vector<Eigen::Vector2d>;

/// Distance of each point of a line to another line that runs beside it in the same direction; the
/// nearest place moves only forward, so that it costs O(points of both).
std::vector<double> distances_m(const Line& line, const Line& other) {
  std::vector<double> found;
  std::size_t at = 0;
  for (const Eigen::Vector2d& point : line) {
    double least = geometry::distance_to_segment_m(point, other[at], other[at + 1]);
    while (at + 2 < other.size()) {
      const double next = geometry::distance_to_segment_m(point, other[at + 1], other[at + 2]);
      if (next > least) break;
      least = next;
      ++at;
    }
    found.push_back(least);
  }
  return found;
}

}  // namespace

std::vector<StationRange> joined_ranges(const Lane& lane, Side side, const Lane& other,
                                        bool same_direction, double most_m) {
  const LaneLine& mine = border(lane, side);
  Line facing = border(other, same_direction ? opposite(side) : side).in_map.points();
  if (!same_direction) std::reverse(facing.begin(), facing.end());
  const std::vector<double> distance_m = distances_m(mine.in_map.points(), facing);
  std::vector<StationRange> ranges;
  for (std::size_t i = 0; i + 1 < distance_m.size(); ++i) {
    if (std::max(distance_m[i], distance_m[i + 1]) > most_m) continue;
    const double from_s_m = mine.station_m[i], to_s_m = mine.station_m[i + 1];
    if (!ranges.empty() && ranges.back().to_s_m == from_s_m) {
      ranges.back().to_s_m = to_s_m;
    } else if (to_s_m > from_s_m) {
      ranges.push_back({from_s_m, to_s_m});
    }
  }
  return ranges;
}

bool may_cross(MarkType type, bool from_right) {
  switch (type) {
    case MarkType::none:
    case MarkType::broken:
    case MarkType::broken_broken:
    case MarkType::botts_dots:
      return true;
    case MarkType::solid_broken:
      return from_right;
    case MarkType::broken_solid:
      return !from_right;
    default:
      return false;
  }
}

bool may_change(const Lane& lane, Side side, const Lane& other, bool same_direction) {
  const bool from_right = side == Side::left;
  if (const auto& own = marks(lane, side); !own.empty()) {
    return may_cross(own.front().type, from_right);
  }
  const auto& theirs = marks(other, same_direction ? opposite(side) : side);
  // Seen by an oncoming neighbour, the two lines of a double one are the other way round.
  if (!theirs.empty()) {
    return may_cross(theirs.front().type, same_direction ? from_right : !from_right);
  }
  return same_direction;
}

}  // namespace roadbed::map::elements
