#include "roadbed/map/formats/open_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/formats/open_drive_document.h"
#include "roadbed/map/formats/open_drive_lanes.h"
#include "roadbed/map/formats/open_drive_links.h"
#include "roadbed/map/input_error.h"

namespace roadbed::map::open_drive {
namespace {

[[noreturn]] void refuse_road(const XmlDocument& xml, const RoadRecord& road,
                              const std::string& found, const std::string& remedy) {
  throw InputError({.file = xml.name(),
                    .place = std::to_string(road.line),
                    .element = "road " + road.id,
                    .found = found,
                    .needed = {},
                    .remedy = remedy});
}

std::vector<geometry::PlanView> plan_views(const XmlDocument& xml, const Document& document) {
  std::vector<geometry::PlanView> views;
  for (const RoadRecord& road : document.roads) {
    try {
      views.emplace_back(road.plan_pieces);
    } catch (const std::invalid_argument& error) {
      refuse_road(xml, road, error.what(), "correct its plan view");
    }
  }
  return views;
}

std::vector<Junction> build_junctions(const Document& document,
                                      std::map<std::string, JunctionId>& ids) {
  std::vector<Junction> junctions;
  for (const JunctionRecord& record : document.junctions) {
    const JunctionId id{static_cast<std::uint32_t>(junctions.size())};
    if (!ids.emplace(record.id, id).second) continue;
    junctions.push_back({id, record.id, record.name, JunctionKind::common, {}});
  }
  return junctions;
}

// The reference line with a chord error of at most max_error_m, as its lanes are sampled.
void sample_reference(const RoadRecord& record, const geometry::PlanView& view, double max_error_m,
                      PointBudget& budget, Road& road) {
  std::vector<double> breaks{0.0, record.length_m};
  for (const auto& piece : view.pieces()) {
    if (piece.s_m > 1e-9 && piece.s_m < record.length_m - 1e-9) breaks.push_back(piece.s_m);
  }
  std::sort(breaks.begin(), breaks.end());
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double length_m = breaks[i + 1] - breaks[i];
    const double bound = view.bounds(breaks[i], breaks[i + 1]).second_derivative_per_m;
    const double steps = std::ceil(length_m * std::sqrt(bound / (8.0 * max_error_m)));
    const int count = static_cast<int>(std::clamp(steps, 1.0, 1e6));
    budget.spend(static_cast<std::size_t>(count), road.id.index);
    for (int k = i == 0 ? 0 : 1; k <= count; ++k) {
      const double s_m = breaks[i] + length_m * k / count;
      points.push_back(view.at(s_m, 0.5 * (breaks[i] + breaks[i + 1])).pose.position());
      road.reference_road_s_m.push_back(s_m);
    }
  }
  road.reference_in_map = geometry::Polyline(std::move(points));
}

std::vector<Road> build_roads(const Document& document,
                              const std::vector<geometry::PlanView>& views,
                              const std::map<std::string, JunctionId>& junction_ids,
                              double max_error_m, PointBudget& budget) {
  std::vector<Road> roads;
  for (std::size_t i = 0; i < document.roads.size(); ++i) {
    const RoadRecord& record = document.roads[i];
    Road road;
    road.id = RoadId{static_cast<std::uint32_t>(i)};
    road.source_id = record.id;
    road.name = record.name;
    road.length_m = record.length_m;
    if (const auto found = junction_ids.find(record.junction_id); found != junction_ids.end()) {
      road.junction = found->second;
    }
    sample_reference(record, views[i], max_error_m, budget, road);
    roads.push_back(std::move(road));
  }
  return roads;
}

// Lanes of the road at s that a signal speaks to.
std::vector<LaneId> signal_lanes(const SignalRecord& signal, const Road& road,
                                 const BuiltLanes& built) {
  std::vector<LaneId> lanes;
  for (const LaneId id : road.lanes) {
    const Lane& lane = built.lanes[id.index];
    const auto [from, to] = std::minmax(lane.origin.road_from_s_m, lane.origin.road_to_s_m);
    const bool forward = built.forward[id.index];
    const bool facing = signal.orientation == "+"   ? forward
                        : signal.orientation == "-" ? !forward
                                                    : true;
    const int lane_id = std::stoi(lane.origin.source_id);
    const bool named =
        signal.lane_ranges.empty() ||
        std::any_of(signal.lane_ranges.begin(), signal.lane_ranges.end(), [&](const auto& range) {
          return lane_id >= std::min(range.first, range.second) &&
                 lane_id <= std::max(range.first, range.second);
        });
    if (facing && named && is_drivable(lane.type) && signal.s_m >= from && signal.s_m <= to) {
      lanes.push_back(id);
    }
  }
  return lanes;
}

std::vector<Signal> build_signals(const Document& document,
                                  const std::vector<geometry::PlanView>& views,
                                  const std::vector<Road>& roads, const BuiltLanes& built) {
  std::map<std::string, std::size_t> index;
  for (std::size_t i = 0; i < roads.size(); ++i) index[roads[i].source_id] = i;
  std::vector<Signal> signals;
  for (const SignalRecord& record : document.signals) {
    const auto found = index.find(record.road_id);
    if (found == index.end()) continue;
    const Road& road = roads[found->second];
    const geometry::Pose2 pose = views[found->second].at(record.s_m).pose;
    Signal signal;
    signal.source_id = record.id;
    signal.name = record.name;
    signal.road = road.id;
    signal.road_s_m = record.s_m;
    signal.road_t_m = record.t_m;
    signal.in_map = pose * Eigen::Vector2d(0.0, record.t_m);
    signal.country = record.country;
    signal.type = record.type;
    signal.subtype = record.subtype;
    signal.value = record.value;
    signal.unit = record.unit;
    signal.dynamic = record.dynamic;
    signal.lanes = signal_lanes(record, road, built);
    signals.push_back(std::move(signal));
  }
  return signals;
}

}  // namespace

RoadMapParts read(const XmlDocument& xml, const LoadOptions& options) {
  Document document = read_document(xml);
  const std::vector<geometry::PlanView> views = plan_views(xml, document);
  RoadMapParts parts;
  parts.format = "OpenDRIVE " + document.version;
  parts.crs = document.crs;
  parts.origin_in_source = document.origin_in_source;
  parts.remarks = std::move(document.remarks);

  std::map<std::string, JunctionId> junction_ids;
  parts.junctions = build_junctions(document, junction_ids);
  BuiltLanes built;
  PointBudget budget(xml.size_bytes());
  try {
    built = build_lanes(document, views, junction_ids, options.max_error_m, budget, parts.remarks);
    parts.roads = build_roads(document, views, junction_ids, options.max_error_m, budget);
  } catch (const RoadFault& fault) {
    refuse_road(xml, document.roads[fault.road_index], fault.what(), fault.what_to_do);
  }
  parts.links = link_lanes(document, built, parts.remarks);
  for (const Lane& lane : built.lanes) parts.roads[lane.road->index].lanes.push_back(lane.id);
  for (const Road& road : parts.roads) {
    if (road.junction) parts.junctions[road.junction->index].connecting_roads.push_back(road.id);
  }
  parts.signals = build_signals(document, views, parts.roads, built);
  parts.lanes = std::move(built.lanes);
  return parts;
}

}  // namespace roadbed::map::open_drive
