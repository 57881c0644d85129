#include "roadbed/map/formats/open_drive_lanes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "roadbed/map/formats/open_drive_cross_section.h"
#include "roadbed/map/formats/open_drive_values.h"

namespace roadbed::map::open_drive {
namespace {

// What a cross-section says of one of its borders.
struct BorderLine {
  std::vector<Eigen::Vector2d> points;
  std::vector<double> z_m;
};

BorderLine border_line(const std::vector<CrossSection>& rows, std::size_t border) {
  BorderLine line;
  for (const CrossSection& row : rows) {
    line.points.push_back(row.border_in_map[border]);
    line.z_m.push_back(row.z_m[border]);
  }
  return line;
}

LaneHeight height_at(const std::vector<LaneHeight>& heights, double offset_m) {
  LaneHeight found;
  for (const LaneHeight& height : heights) {
    if (height.s_offset_m <= offset_m) found = height;
  }
  return found;
}

void raise(BorderLine& inner, BorderLine& outer, const std::vector<CrossSection>& rows,
           const LaneRecord& lane, double section_s_m) {
  if (lane.heights.empty()) return;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const LaneHeight height = height_at(lane.heights, rows[i].s_m - section_s_m);
    inner.z_m[i] += height.inner_m;
    outer.z_m[i] += height.outer_m;
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

// A lane's own limit if it has one in the middle of the stretch, else that of the road.
std::optional<double> speed_limit(const RoadRecord& road, const LaneRecord& lane,
                                  const SectionSide& side) {
  const double middle_s_m = 0.5 * (side.from_s_m + side.to_s_m);
  std::optional<double> limit_mps;
  for (const RoadSpeed& speed : road.speeds) {
    if (speed.s_m <= middle_s_m) limit_mps = speed.limit_mps;
  }
  for (const LaneSpeed& speed : lane.speeds) {
    if (side.from_s_m + speed.s_offset_m <= middle_s_m) limit_mps = speed.limit_mps;
  }
  return limit_mps;
}

// The borders as one ring, counter-clockwise; of a ring that folds over itself the largest part.
geometry::Ring lane_ring(const LaneLine& left, const LaneLine& right) {
  geometry::Ring ring = right.in_map.points();
  ring.insert(ring.end(), left.in_map.points().rbegin(), left.in_map.points().rend());
  ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
  while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
  if (ring.size() < 3) return {};
  if (geometry::signed_area_m2(ring) > 0.0 && geometry::is_simple(ring)) return ring;
  geometry::Ring largest;
  for (geometry::Polygon& part : geometry::make_simple(ring)) {
    if (largest.empty() ||
        geometry::signed_area_m2(part.outer) > geometry::signed_area_m2(largest)) {
      largest = std::move(part.outer);
    }
  }
  return largest;
}

class LaneBuilder {
 public:
  LaneBuilder(const Document& document, const std::map<std::string, JunctionId>& junctions,
              double max_error_m, PointBudget& budget, std::vector<ImportRemark>& remarks)
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
      const auto rows = sample_side(road, road_index, plan_view, side, max_error_m_, budget_);
      for (std::size_t i = 0; i < side.lanes.size(); ++i) {
        if (rows.size() < 2) {
          remark_empty(road, *side.lanes[i]);
        } else {
          add_lane(road_index, section_index, side, rows, i);
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
                const std::vector<CrossSection>& rows, std::size_t index) {
    const RoadRecord& road = document_.roads[road_index];
    const LaneRecord& record = *side.lanes[index];
    const bool forward = drives_forward(road, record);
    BorderLine inner = border_line(rows, index), outer = border_line(rows, index + 1);
    raise(inner, outer, rows, record, side.from_s_m);
    BorderLine centre = middle_of(inner, outer);
    // Inner and outer by increasing s become left and right by driving direction.
    BorderLine& left = (side.sign > 0) == forward ? outer : inner;
    BorderLine& right = &left == &outer ? inner : outer;
    if (!forward) {
      reverse(left);
      reverse(right);
      reverse(centre);
    }
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
    lane.participants = participants_of(record.type);
    lane.speed_limits = {{0.0, speed_limit(road, record, side)}};
    const std::vector<double> station_m = geometry::Polyline(centre.points).stations_m();
    lane.centre = lane_line(std::move(centre), station_m);
    lane.left = lane_line(std::move(left), station_m);
    lane.right = lane_line(std::move(right), station_m);
    lane.polygon = lane_ring(lane.left, lane.right);
    built_.ids[{road_index, section_index, record.id}] = lane.id;
    built_.forward.push_back(forward);
    built_.lanes.push_back(std::move(lane));
  }

  const Document& document_;
  const std::map<std::string, JunctionId>& junctions_;
  double max_error_m_;
  PointBudget& budget_;
  std::vector<ImportRemark>& remarks_;
  BuiltLanes built_;
};

// What one marking allows: crossing it away from the road's middle, and back.
struct MarkRule {
  bool outwards = true, inwards = true;
};

MarkRule rule_of(const RoadMark& mark, int lane_id) {
  const bool left_side = lane_id > 0;
  if (!mark.lane_change.empty()) {
    const bool increase = mark.lane_change == "both" || mark.lane_change == "increase";
    const bool decrease = mark.lane_change == "both" || mark.lane_change == "decrease";
    return left_side ? MarkRule{increase, decrease} : MarkRule{decrease, increase};
  }
  // Without the attribute the line's type decides: the line nearer to the driver must be broken.
  if (mark.type == "solid broken") return {false, true};
  if (mark.type == "broken solid") return {true, false};
  const bool may = mark.type.empty() || mark.type == "none" || mark.type == "broken" ||
                   mark.type == "broken broken" || mark.type == "botts dots";
  return {may, may};
}

}  // namespace

Crossing crossing(const std::vector<RoadMark>& marks, int lane_id, double section_length_m) {
  // The rule that holds along the greater part of the section.
  double outwards_m = 0.0, inwards_m = 0.0;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double to_m = i + 1 < marks.size() ? marks[i + 1].s_offset_m : section_length_m;
    const MarkRule rule = rule_of(marks[i], lane_id);
    const double length_m = std::max(0.0, to_m - marks[i].s_offset_m);
    if (rule.outwards) outwards_m += length_m;
    if (rule.inwards) inwards_m += length_m;
  }
  const double half_m = 0.5 * section_length_m;
  const bool outwards = marks.empty() || outwards_m >= half_m;
  const bool inwards = marks.empty() || inwards_m >= half_m;
  return lane_id > 0 ? Crossing{outwards, inwards} : Crossing{inwards, outwards};
}

BuiltLanes build_lanes(const Document& document, const std::vector<geometry::PlanView>& plan_views,
                       const std::map<std::string, JunctionId>& junctions, double max_error_m,
                       PointBudget& budget, std::vector<ImportRemark>& remarks) {
  LaneBuilder builder(document, junctions, max_error_m, budget, remarks);
  for (std::size_t road = 0; road < document.roads.size(); ++road) {
    for (std::size_t section = 0; section < document.roads[road].sections.size(); ++section) {
      builder.add_section(road, section, plan_views[road]);
    }
  }
  return builder.take();
}

}  // namespace roadbed::map::open_drive
