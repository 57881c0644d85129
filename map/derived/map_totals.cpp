#include "roadbed/map/derived/map_totals.h"

#include <algorithm>
#include <cmath>

#include "roadbed/map/derived/covered_area.h"
#include "roadbed/map/elements/byte_io.h"
#include "roadbed/map/elements/map_fields.h"
#include "roadbed/map/index/road_map_index.h"

namespace roadbed::map::inline derived {
namespace {

constexpr std::size_t kLaneTypes = static_cast<std::size_t>(LaneType::other) + 1;

/// An import of fewer lanes would take half as long again with their areas, and the exact union is
/// soon made when somebody asks for it.
constexpr std::size_t kLanesForAreas = 10'000;

constexpr auto length_field = [](auto& io, auto& value) {
  io(value);
  io.check(std::isfinite(value) && value >= 0.0);
};

constexpr auto areas_fields = [](auto& io, auto& areas) {
  length_field(io, areas.drivable_m2);
  length_field(io, areas.junctions_m2);
};

constexpr auto bounds_fields = [](auto& io, auto& bounds) {
  io.point(bounds.low_in_map);
  io.point(bounds.high_in_map);
};

constexpr auto totals_fields = [](auto& io, auto& totals) {
  io.list(totals.lanes_of_type, fields::field);
  io.check(totals.lanes_of_type.size() == kLaneTypes);
  length_field(io, totals.roads_m);
  length_field(io, totals.drivable_lanes_m);
  io.optional(totals.areas, areas_fields);
  io.optional(totals.bounds, bounds_fields);
  io.list(totals.component_lanes, fields::field);
  io.list(totals.remarks, fields::attribute);
  io(totals.has_road_areas);
};

MapTotals stored_totals(const RoadMapIndex& index) {
  MapTotals totals;
  try {
    ByteReader reader(index.totals.bytes(), {});
    totals_fields(reader, totals);
    reader.check(reader.at_end());
  } catch (const ByteReader::Damaged&) {
    index.totals.refuse("its content is damaged");
  }
  return totals;
}

/// Of each lane the junction that it counts for.
std::vector<std::uint32_t> junction_of_lanes(const RoadMap& road_map) {
  std::vector<std::uint32_t> of_lane(road_map.lanes().size(), GroupedRing::kNoGroup);
  for (const Junction& junction : road_map.junctions()) {
    for (const RoadId road : junction.connecting_roads) {
      for (const LaneId id : road_map.road(road).lanes) {
        if (road_map.lane(id).junction == junction.id) of_lane[id.index] = junction.id.index;
      }
    }
  }
  return of_lane;
}

}  // namespace

TotalsCounter::TotalsCounter() { totals_.lanes_of_type.assign(kLaneTypes, 0); }

void TotalsCounter::add(const Lane& lane) {
  ++totals_.lanes_of_type.at(static_cast<std::size_t>(lane.type));
  is_drivable_.push_back(is_drivable(lane.type));
  if (is_drivable_.back()) totals_.drivable_lanes_m += lane.length_m();
  extend(lane.left.in_map.points());
  extend(lane.right.in_map.points());
}

void TotalsCounter::add(const LaneLinks& links) {
  if (!groups_) groups_.emplace(is_drivable_.size());
  const LaneId lane{links_++};
  if (is_drivable_.at(lane.index)) {
    groups_->join(lane, links, [&](LaneId other) { return is_drivable_.at(other.index); });
  }
}

void TotalsCounter::add(const Area& area) {
  totals_.has_road_areas = totals_.has_road_areas || area.is_road;
  for (const geometry::Polygon& polygon : area.in_map) extend(polygon.outer);
}

void TotalsCounter::add(const ImportDiagnostic& remark) {
  const auto at = std::ranges::lower_bound(totals_.remarks, remark.rule, {},
                                           &std::pair<std::string, std::uint64_t>::first);
  if (at == totals_.remarks.end() || at->first != remark.rule) {
    totals_.remarks.insert(at, {remark.rule, 1});
  } else {
    ++at->second;
  }
}

void TotalsCounter::extend(const std::vector<Eigen::Vector2d>& points_in_map) {
  for (const Eigen::Vector2d& point : points_in_map) {
    if (!totals_.bounds) totals_.bounds = MapTotals::Bounds{point, point};
    totals_.bounds->low_in_map = totals_.bounds->low_in_map.cwiseMin(point);
    totals_.bounds->high_in_map = totals_.bounds->high_in_map.cwiseMax(point);
  }
}

MapTotals TotalsCounter::totals() && {
  if (groups_) totals_.component_lanes = groups_->sizes(is_drivable_);
  return std::move(totals_);
}

std::optional<MapAreas> covered_areas(const RoadMap& road_map, int threads) {
  const std::vector<std::uint32_t> junctions = junction_of_lanes(road_map);
  std::vector<GroupedRing> rings;
  for (const Lane& lane : road_map.lanes()) {
    if (is_drivable(lane.type)) rings.push_back({&lane.polygon, junctions[lane.id.index]});
  }
  const std::optional<CoveredArea> covered = covered_area(rings, threads);
  if (!covered) return std::nullopt;
  return MapAreas{covered->all_m2, covered->groups_m2};
}

MapTotals totals_of(const RoadMap& road_map, int threads) {
  if (road_map.index().totals.size() > 0) return stored_totals(road_map.index());
  TotalsCounter counter;
  const auto count = [&](const char*, const auto&, const auto& list) {
    for (const auto& thing : list) counter.add(thing);
  };
  fields::lists(count, road_map.content());
  MapTotals totals = std::move(counter).totals();
  if (road_map.lanes().size() >= kLanesForAreas) totals.areas = covered_areas(road_map, threads);
  return totals;
}

std::string write_totals(const MapTotals& totals) {
  std::string bytes;
  ByteWriter writer(bytes);
  totals_fields(writer, totals);
  return bytes;
}

bool are_stored_as(const RoadMap& road_map, MapTotals counted) {
  if (road_map.index().totals.size() == 0) return true;
  counted.areas = stored_totals(road_map.index()).areas;
  return write_totals(counted) == road_map.index().totals.bytes();
}

}  // namespace roadbed::map::derived
