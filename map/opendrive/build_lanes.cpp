#include "roadbed/map/opendrive/build_lanes.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>

#include "roadbed/map/files/in_threads.h"
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

// The lanes of a road, counted from 0, and what there is to say of them.
struct RoadLanes {
  BuiltLanes built;
  std::vector<std::size_t> folded;  // of them
  std::vector<ImportDiagnostic> remarks;
};

class LaneBuilder {
 public:
  LaneBuilder(const Document& document, std::size_t road_index, const geometry::PlanView& plan_view,
              std::optional<JunctionId> junction, double max_error_m,
              std::atomic<std::size_t>& budget)
      : road_(document.roads[road_index]),
        road_index_(road_index),
        plan_view_(plan_view),
        junction_(junction),
        max_error_m_(max_error_m),
        budget_(budget) {}

  RoadLanes build() {
    for (std::size_t section = 0; section < road_.sections.size(); ++section) {
      for (const int sign : {1, -1}) add_side(section, section_side(road_, section, sign));
    }
    return {std::move(built_), std::move(folded_), std::move(remarks_)};
  }

 private:
  void add_side(std::size_t section, const SectionSide& side) {
    const SideLines lines =
        sample_side(road_, road_index_, plan_view_, side, max_error_m_, budget_);
    if (lines.s_m.size() >= 2) built_.side_stations_m.push_back(lines.s_m);
    for (std::size_t i = 0; i < side.lanes.size(); ++i) {
      if (lines.s_m.size() < 2) {
        remark_empty(*side.lanes[i]);
      } else {
        add_lane(section, side, lines, i);
      }
    }
  }

  void remark_empty(const LaneRecord& lane) {
    remarks_.push_back({"import.empty-section", true,
                        fmt::format("road {}, lane {}", road_.id, lane.id), lane.line,
                        "its lane section has no length and the lane is left out"});
  }

  // Who may use a lane is one answer for all of it.
  void remark_partial_access(const LaneRecord& lane, const std::string& name) {
    remarks_.push_back({"import.partial-access", false, "lane " + name, lane.line,
                        fmt::format("its access changes at s = {} m; who is kept out of a part of "
                                    "the lane is kept out of all of it",
                                    lane.accesses.back().s_m)});
  }

  void add_lane(std::size_t section_index, const SectionSide& side, const SideLines& lines,
                std::size_t index) {
    const LaneRecord& record = *side.lanes[index];
    const bool forward = drives_forward(road_, record);
    budget_.spend(PointBudget::kPerThing, road_index_);
    Lane lane;
    lane.id = LaneId{static_cast<std::uint32_t>(built_.lanes.size())};
    lane.road = RoadId{static_cast<std::uint32_t>(road_index_)};
    lane.junction = junction_;
    lane.origin = {static_cast<int>(section_index), std::to_string(record.id),
                   forward ? side.from_s_m : side.to_s_m, forward ? side.to_s_m : side.from_s_m};
    lane.name = fmt::format("{}/{}/{}", road_.id, section_index, record.id);
    lane.type = record.type;
    lane.one_way = record.direction != "both" && record.type != LaneType::bidirectional;
    lane.participants = participants_along(record);
    lane.attributes = record.attributes;
    if (!record.accesses.empty()) {
      lane.attributes.emplace_back("access", access_in_words(record));
      if (record.accesses.back().s_m > side.from_s_m) remark_partial_access(record, lane.name);
    }
    set_lines(side, lines, index, forward, lane);
    if (lay_ring(lane)) folded_.push_back(built_.lanes.size());
    built_.ids[{road_index_, section_index, record.id}] = lane.id;
    built_.forward.push_back(forward);
    built_.side_of_lane.push_back(static_cast<std::uint32_t>(built_.side_stations_m.size() - 1));
    built_.lanes.push_back(std::move(lane));
    set_rules(road_.sections[section_index], side, index);
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
  }

  // What holds along the lane that was added last: speed limits, and the markings of its borders.
  void set_rules(const LaneSection& section, const SectionSide& side, std::size_t index) {
    Lane& lane = built_.lanes.back();
    const LaneRecord& record = *side.lanes[index];
    const auto speeds = speed_stretches(road_, record, side.from_s_m, side.to_s_m);
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

  const RoadRecord& road_;
  std::size_t road_index_;
  const geometry::PlanView& plan_view_;
  std::optional<JunctionId> junction_;
  double max_error_m_;
  PointBudget budget_;  // a part of what all roads share
  BuiltLanes built_;
  std::vector<std::size_t> folded_;
  std::vector<ImportDiagnostic> remarks_;
};

void append(BuiltLanes of_road, BuiltLanes& all) {
  const auto lanes = static_cast<std::uint32_t>(all.lanes.size());
  const auto sides = static_cast<std::uint32_t>(all.side_stations_m.size());
  for (Lane& lane : of_road.lanes) {
    lane.id.index += lanes;
    all.lanes.push_back(std::move(lane));
  }
  for (const auto& [key, id] : of_road.ids) {
    all.ids.emplace_hint(all.ids.end(), key, LaneId{id.index + lanes});
  }
  all.forward.insert(all.forward.end(), of_road.forward.begin(), of_road.forward.end());
  std::ranges::move(of_road.side_stations_m, std::back_inserter(all.side_stations_m));
  for (const std::uint32_t side : of_road.side_of_lane) all.side_of_lane.push_back(side + sides);
}

// Of each road.
std::vector<RoadLanes> lanes_of_roads(const Document& document,
                                      const std::vector<geometry::PlanView>& plan_views,
                                      const std::map<std::string, JunctionId>& junctions,
                                      double max_error_m, int threads, PointBudget& budget) {
  std::vector<RoadLanes> roads(document.roads.size());
  std::atomic<std::size_t> left = budget.left();
  in_threads(roads.size(), threads, [&](std::size_t i) {
    const auto found = junctions.find(document.roads[i].junction_id);
    const auto junction =
        found == junctions.end() ? std::nullopt : std::optional<JunctionId>(found->second);
    roads[i] = LaneBuilder(document, i, plan_views[i], junction, max_error_m, left).build();
  });
  budget.try_to_spend(budget.left() - left);
  return roads;
}

// One after the other, so that memory is taken for one lane at a time.
void unfold_lanes(std::vector<RoadLanes>& roads, std::size_t file_bytes) {
  geometry::WorkBudget budget(most_folding_steps(file_bytes));
  for (std::size_t i = 0; i < roads.size(); ++i) {
    for (const std::size_t folded : roads[i].folded) {
      Lane& lane = roads[i].built.lanes[folded];
      if (!budget.spend(kStepsPerFoldedPoint * lane.polygon.size())) {
        throw RoadFault(i,
                        "its lanes and those before it fold over themselves at more points than a "
                        "map of this size may",
                        "check its curvatures and widths, or sample it with a larger --max-error");
      }
      unfold_ring(lane);
    }
  }
}

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
                       const std::map<std::string, JunctionId>& junctions,
                       const LoadOptions& options, PointBudget& budget,
                       std::vector<ImportDiagnostic>& remarks) {
  const auto build = [&](int threads) {
    return lanes_of_roads(document, plan_views, junctions, options.max_error_m, threads, budget);
  };
  std::vector<RoadLanes> roads;
  try {
    roads = build(options.threads);
  } catch (const RoadFault&) {
    roads = build(1);  // which of the roads was one too many is told in their order
  }
  unfold_lanes(roads, budget.file_bytes());
  BuiltLanes built;
  for (RoadLanes& road : roads) {
    append(std::move(road.built), built);
    std::ranges::move(road.remarks, std::back_inserter(remarks));
  }
  return built;
}

}  // namespace roadbed::map::opendrive
