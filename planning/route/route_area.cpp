#include "roadbed/planning/route/route_area.h"

#include <algorithm>
#include <utility>

#include "roadbed/planning/route/route_changes.h"

namespace roadbed::planning::inline route {
namespace {

constexpr double kWeld_m = 1e-3;
constexpr double kWhole_m = 1e-6;

void add_border(const map::LaneLine& line, const LanePart& part, geometry::Ring& ring) {
  ring.push_back(map::Lane::point_at(line, part.from_s_m));
  for (std::size_t i = 0; i < line.station_m.size(); ++i) {
    if (line.station_m[i] > part.from_s_m && line.station_m[i] < part.to_s_m) {
      ring.push_back(line.in_map.points()[i]);
    }
  }
  ring.push_back(map::Lane::point_at(line, part.to_s_m));
}

std::vector<geometry::Polygon> pieces_of(const map::Lane& lane, LanePart part) {
  if (part.from_s_m > part.to_s_m) std::swap(part.from_s_m, part.to_s_m);
  const bool whole = part.from_s_m <= kWhole_m && part.to_s_m >= lane.length_m() - kWhole_m;
  if (whole && lane.polygon.size() >= 3) return {{lane.polygon, {}}};
  if (part.to_s_m - part.from_s_m <= kWhole_m) return {};
  geometry::Ring ring, left;
  add_border(lane.right, part, ring);
  add_border(lane.left, part, left);
  ring.insert(ring.end(), left.rbegin(), left.rend());
  return geometry::make_simple(ring);
}

}  // namespace

std::vector<geometry::Polygon> area_of(const map::RoadMap& road_map,
                                       const std::vector<LanePart>& parts) {
  std::vector<geometry::Polygon> pieces;
  for (const LanePart& part : parts) {
    for (geometry::Polygon& piece : pieces_of(road_map.lane(part.lane), part)) {
      pieces.push_back(std::move(piece));
    }
  }
  return geometry::unite(pieces, kWeld_m);
}

std::vector<LanePart> corridor_of(const map::RoadMap& road_map, const Route& route) {
  std::vector<LanePart> parts;
  for (const RouteLeg& leg : route.legs) parts.push_back({leg.lane, leg.from_s_m, leg.to_s_m});
  for (std::size_t i = 0; i < route.legs.size(); ++i) {
    for (const ChangePart& change : parts_of_change(road_map, route, i)) {
      const map::StationRange window = driven_window(road_map, route.legs[i]);
      const double length_m = std::max(1e-3, road_map.lane(change.from.lane).length_m());
      const auto fraction_at = [&](double s_m) {
        return std::clamp((s_m - change.offset_m) / length_m, 0.0, 1.0);
      };
      const double from = fraction_at(window.from_s_m);
      const double to = fraction_at(window.to_s_m);
      for (const DrivenLane& lane : {change.from, change.to}) {
        const double lane_m = road_map.lane(lane.lane).length_m();
        parts.push_back({lane.lane, mirrored_m(road_map, lane, from * lane_m),
                         mirrored_m(road_map, lane, to * lane_m)});
      }
    }
  }
  return parts;
}

}  // namespace roadbed::planning::route
