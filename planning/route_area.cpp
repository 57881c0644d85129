#include "roadbed/planning/route_area.h"

#include <algorithm>

namespace roadbed::planning {
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

std::vector<geometry::Polygon> pieces_of(const map::Lane& lane, const LanePart& part) {
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
  const RouteLeg* before = nullptr;
  for (const RouteLeg& leg : route.legs) {
    LanePart part{leg.lane, leg.from_s_m, leg.to_s_m};
    if (before != nullptr && before->change_window) {
      const double share = before->change_window->from_s_m / road_map.lane(before->lane).length_m();
      part.from_s_m = std::min(part.from_s_m, share * road_map.lane(leg.lane).length_m());
    }
    if (leg.change_window) part.to_s_m = std::max(part.to_s_m, leg.change_window->to_s_m);
    parts.push_back(part);
    before = &leg;
  }
  return parts;
}

}  // namespace roadbed::planning
