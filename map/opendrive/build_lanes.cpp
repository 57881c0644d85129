#include "roadbed/map/opendrive/build_lanes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "roadbed/map/opendrive/sample_borders.h"

namespace roadbed::map::opendrive {
namespace {

// A lane's own borders where <height> records raise it above the road.
void raise(BorderLine& inner, BorderLine& outer, const SideLines& lines, std::size_t lane) {
  for (std::size_t i = 0; i < lines.raised.size(); ++i) {
    if (lines.raised[i].empty()) continue;
    inner.z_m[i] += lines.raised[i][lane].inner_m;
    outer.z_m[i] += lines.raised[i][lane].outer_m;
  }
}

BorderLine middle_of(const BorderLine& a, const BorderLine& b) {
  BorderLine middle = a;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    middle.points[i] = 0.5 * (a.points[i] + b.points[i]);
    middle.z_m[i] = 0.5 * (a.z_m[i] + b.z_m[i]);
  }
  return middle;
}

void reverse(BorderLine& line) {
  std::reverse(line.points.begin(), line.points.end());
  std::reverse(line.z_m.begin(), line.z_m.end());
}

LaneLine lane_line(BorderLine line, const std::vector<double>& station_m) {
  return {geometry::Polyline(std::move(line.points)), std::move(line.z_m), station_m};
}

bool drives_forward(const RoadRecord& road, const LaneRecord& lane) {
  const bool right = lane.id < 0;
  return (right != road.left_hand_traffic) != (lane.direction == "reversed");
}

class LaneBuilder {
 public:
  LaneBuilder(const Document& document, const std::map<std::string, JunctionId>& junctions,
              double max_error_m, PointBudget& budget, std::vector<ImportDiagnostic>& remarks)
      : document_(document),
        junctions_(junctions),
        max_error_m_(max_error_m),
        budget_(budget),
        remarks_(remarks) {}

  void add_section(std::size_t road_index, std::size_t section_index,
                   const geometry::PlanView& plan_view) {
    for (const int sign : {1, -1}) {
      const RoadRecord& road = document_.roads[road_index];
      const SectionSide side = section_side(road, section_index, sign);
      const SideLines lines = sample_side(road, road_index, plan_view, side, max_error_m_, budget_);
      if (lines.s_m.size() >= 2) built_.side_stations_m.push_back(lines.s_m);
      for (std::size_t i = 0; i < side.lanes.size(); ++i) {
        if (lines.s_m.size() < 2) {
          remark_empty(road, *side.lanes[i]);
        } else {
          add_lane(road_index, section_index, side, lines, i);
        }
      }
    }
  }

  BuiltLanes take() { return std::move(built_); }

 private:
  void remark_empty(const RoadRecord& road, const LaneRecord& lane) {
    remarks_.push_back({"import.empty-section", true,
                        fmt::format("road {}, lane {}", road.id, lane.id), lane.line,
                        "its lane section has no length and the lane is left out"});
  }

  void add_lane(std::size_t road_index, std::size_t section_index, const SectionSide& side,
                const SideLines& lines, std::size_t index) {
    const RoadRecord& road = document_.roads[road_index];
    const LaneRecord& record = *side.lanes[index];
    const bool forward = drives_forward(road, record);
    budget_.spend(PointBudget::kPerThing, road_index);
    Lane lane;
    lane.id = LaneId{static_cast<std::uint32_t>(built_.lanes.size())};
    lane.road = RoadId{static_cast<std::uint32_t>(road_index)};
    if (const auto found = junctions_.find(road.junction_id); found != junctions_.end()) {
      lane.junction = found->second;
    }
    lane.origin = {static_cast<int>(section_index), std::to_string(record.id),
                   forward ? side.from_s_m : side.to_s_m, forward ? side.to_s_m : side.from_s_m};
    lane.name = fmt::format("{}/{}/{}", road.id, section_index, record.id);
    lane.type = record.type;
    lane.one_way = record.direction != "both" && record.type != LaneType::bidirectional;
    lane.participants = participants_along(record);
    lane.attributes = record.attributes;
    if (!record.accesses.empty()) lane.attributes.emplace_back("access", access_in_words(record));
    set_lines(side, lines, index, forward, lane);
    built_.ids[{road_index, section_index, record.id}] = lane.id;
    built_.forward.push_back(forward);
    built_.side_of_lane.push_back(static_cast<std::uint32_t>(built_.side_stations_m.size() - 1));
    built_.lanes.push_back(std::move(lane));
    set_rules(road, document_.roads[road_index].sections[section_index], side, index);
  }

  static void set_lines(const SectionSide& side, const SideLines& lines, std::size_t index,
                        bool forward, Lane& lane) {
    BorderLine inner = lines.borders[index], outer = lines.borders[index + 1];
    raise(inner, outer, lines, index);
    BorderLine centre = middle_of(inner, outer);
    // Inner and outer by increasing s become left and right by driving direction.
    BorderLine& left = (side.sign > 0) == forward ? outer : inner;
    BorderLine& right = &left == &outer ? inner : outer;
    if (!forward) {
      reverse(left);
      reverse(right);
      reverse(centre);
    }
    geometry::Polyline centre_in_map(std::move(centre.points));
    const std::vector<double> station_m = centre_in_map.stations_m();
    lane.centre = {std::move(centre_in_map), std::move(centre.z_m), station_m};
    lane.left = lane_line(std::move(left), station_m);
    lane.right = lane_line(std::move(right), station_m);
    lane.polygon = lane_ring(lane.left.in_map, lane.right.in_map);
  }

  // What holds along the lane that was added last: speed limits, and the markings of its borders.
  void set_rules(const RoadRecord& road, const LaneSection& section, const SectionSide& side,
                 std::size_t index) {
    Lane& lane = built_.lanes.back();
    const LaneRecord& record = *side.lanes[index];
    const auto speeds = speed_stretches(road, record, side.from_s_m, side.to_s_m);
    if (speeds.size() > 1 || speeds.front().value) {
      for (const auto& stretch : in_driving_order(built_, lane.id, speeds)) {
        lane.speed_limits.push_back({stretch.from_s_m, stretch.value});
      }
    }
    const auto inner = section.lanes.find(record.id - side.sign);
    const bool outer_is_left = (side.sign > 0) == built_.forward.back();
    set_marks(record, side, outer_is_left ? lane.left_marks : lane.right_marks);
    if (inner != section.lanes.end()) {
      set_marks(inner->second, side, outer_is_left ? lane.right_marks : lane.left_marks);
    }
  }

  void set_marks(const LaneRecord& owner, const SectionSide& side, std::vector<BorderMark>& marks) {
    const Lane& lane = built_.lanes.back();
    const bool forward = built_.forward.back();
    for (auto& stretch :
         in_driving_order(built_, lane.id, border_marks(owner, side.from_s_m, side.to_s_m))) {
      BorderMark& mark = marks.emplace_back(std::move(stretch.value));
      mark.from_s_m = stretch.from_s_m;
      if (!forward) mark.type = mirrored(mark.type);
    }
  }

  const Document& document_;
  const std::map<std::string, JunctionId>& junctions_;
  double max_error_m_;
  PointBudget& budget_;
  std::vector<ImportDiagnostic>& remarks_;
  BuiltLanes built_;
};

}  // namespace

double BuiltLanes::station_m(LaneId lane, double road_s_m) const {
  const std::vector<double>& rows = side_stations_m[side_of_lane[lane.index]];
  const std::vector<double>& stations = lanes[lane.index].centre.station_m;
  const auto at = [&](std::size_t row) {
    return stations[forward[lane.index] ? row : rows.size() - 1 - row];
  };
  const auto after = std::upper_bound(rows.begin(), rows.end(), road_s_m);
  if (after == rows.begin()) return at(0);
  if (after == rows.end()) return at(rows.size() - 1);
  const auto i = static_cast<std::size_t>(after - rows.begin());
  const double fraction = (road_s_m - rows[i - 1]) / (rows[i] - rows[i - 1]);
  return at(i - 1) + fraction * (at(i) - at(i - 1));
}

BuiltLanes build_lanes(const Document& document, const std::vector<geometry::PlanView>& plan_views,
                       const std::map<std::string, JunctionId>& junctions, double max_error_m,
                       PointBudget& budget, std::vector<ImportDiagnostic>& remarks) {
  LaneBuilder builder(document, junctions, max_error_m, budget, remarks);
  for (std::size_t road = 0; road < document.roads.size(); ++road) {
    for (std::size_t section = 0; section < document.roads[road].sections.size(); ++section) {
      builder.add_section(road, section, plan_views[road]);
    }
  }
  return builder.take();
}

}  // namespace roadbed::map::opendrive
