#include "roadbed/map/opendrive/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/opendrive/build_lanes.h"
#include "roadbed/map/opendrive/furniture.h"

namespace roadbed::map::opendrive {
namespace {

[[noreturn]] void refuse_road(const XmlDocument& xml, const RoadRecord& road,
                              const std::string& found, const std::string& remedy) {
  throw InputError({.file = xml.name(),
                    .place = std::to_string(road.line),
                    .element = "road " + road.id,
                    .found = found,
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
    junctions.push_back({id, record.id, record.name, record.kind, {}});
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
    constexpr int most = 1'000'000;  // also of a bound that is no number
    const int count = steps < most ? std::max(1, static_cast<int>(steps)) : most;
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

// Controllers, each with the junctions that say they are theirs.
std::vector<Controller> build_controllers(Document& document) {
  std::multimap<std::string_view, std::pair<const JunctionRecord*, const JunctionController*>> uses;
  for (const JunctionRecord& junction : document.junctions) {
    for (const JunctionController& use : junction.controllers) {
      uses.emplace(use.controller_id, std::pair{&junction, &use});
    }
  }
  std::vector<Controller> controllers = std::move(document.controllers);
  for (Controller& controller : controllers) {
    const auto [from, to] = uses.equal_range(controller.source_id);
    for (auto use = from; use != to; ++use) {
      const auto& [junction, here] = use->second;
      controller.attributes.emplace_back(
          "junction", here->sequence.empty()
                          ? junction->id
                          : fmt::format("{}, sequence {}", junction->id, here->sequence));
    }
  }
  return controllers;
}

std::vector<LaneId> drivable_lanes(const RoadMapParts& parts, std::size_t road) {
  std::vector<LaneId> lanes;
  for (const LaneId id : parts.roads[road].lanes) {
    if (is_drivable(parts.lanes[id.index].type)) lanes.push_back(id);
  }
  return lanes;
}

// <priority> of a junction: the lanes of one road give way to those of another.
std::vector<Regulation> build_priorities(const Document& document, const RoadMapParts& parts,
                                         PointBudget& budget,
                                         std::vector<ImportDiagnostic>& remarks) {
  std::map<std::string_view, std::size_t> index;
  for (std::size_t i = 0; i < document.roads.size(); ++i) index.emplace(document.roads[i].id, i);
  std::vector<Regulation> regulations;
  for (const JunctionRecord& junction : document.junctions) {
    for (const JunctionPriority& priority : junction.priorities) {
      const auto high = index.find(priority.high_road), low = index.find(priority.low_road);
      if (high == index.end() || low == index.end()) {
        remarks.push_back({"import.junction", true, "junction " + junction.id, 0,
                           fmt::format("gives road {} priority over road {}, one of which is not "
                                       "there",
                                       priority.high_road, priority.low_road)});
        continue;
      }
      const std::size_t lanes =
          parts.roads[high->second].lanes.size() + parts.roads[low->second].lanes.size();
      if (!budget.try_to_spend(PointBudget::kPerThing + 2 * lanes)) {
        remarks.push_back({"import.junction", true, "junction " + junction.id, 0,
                           "gives priority between more lanes than a map of this size can hold; "
                           "its priorities and those after it are left out"});
        return regulations;
      }
      Regulation regulation;
      regulation.source_id = junction.id;
      regulation.type = "right_of_way";
      for (const auto& [role, road] :
           {std::pair{"right_of_way", high->second}, std::pair{"yield", low->second}}) {
        for (const LaneId lane : drivable_lanes(parts, road)) {
          regulation.members.push_back({role, parts.lanes[lane.index].name, lane, {}, {}});
        }
      }
      regulation.lanes = drivable_lanes(parts, low->second);
      regulations.push_back(std::move(regulation));
    }
  }
  return regulations;
}

}  // namespace

RoadMapParts read(XmlDocument xml, const LoadOptions& options) {
  Document document = read_document(xml, options.threads);
  return read(std::move(xml), std::move(document), options);
}

RoadMapParts read(XmlDocument xml, Document document, const LoadOptions& options) {
  xml.release();
  mend(document);
  const std::vector<geometry::PlanView> views = plan_views(xml, document);
  std::vector<RoadFrame> frames;
  for (std::size_t i = 0; i < views.size(); ++i) frames.emplace_back(document.roads[i], views[i]);
  RoadMapParts parts;
  parts.format = "OpenDRIVE " + document.version;
  parts.crs = document.crs;
  parts.offset_in_crs = document.offset_in_crs;
  parts.origin_in_source = document.origin_in_source;
  parts.remarks = std::move(document.remarks);
  parts.unused = std::move(document.unused);

  std::map<std::string, JunctionId> junction_ids;
  parts.junctions = build_junctions(document, junction_ids);
  BuiltLanes built;
  PointBudget budget(xml.size_bytes());
  try {
    built = build_lanes(document, views, junction_ids, options, budget, parts.remarks);
    parts.roads = build_roads(document, views, junction_ids, options.max_error_m, budget);
  } catch (const RoadFault& fault) {
    refuse_road(xml, document.roads[fault.road_index], fault.what(), fault.what_to_do);
  }
  parts.links = link_lanes(document, built, parts.remarks);
  for (const Lane& lane : built.lanes) parts.roads[lane.road->index].lanes.push_back(lane.id);
  for (const Road& road : parts.roads) {
    if (road.junction) parts.junctions[road.junction->index].connecting_roads.push_back(road.id);
  }
  parts.signals = place_signals(document, frames, built, budget, parts.remarks);
  parts.objects = place_objects(document, frames, budget, parts.remarks);
  parts.stop_lines = find_stop_lines(document, frames, built, parts.signals, budget, parts.remarks);
  parts.controllers = build_controllers(document);
  parts.lanes = std::move(built.lanes);
  parts.regulations = build_priorities(document, parts, budget, parts.remarks);
  return parts;
}

}  // namespace roadbed::map::opendrive
