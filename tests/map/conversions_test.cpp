// What survives when a map is converted: the table in map/README.md says it for each pair of
// formats, and this test makes that table of maps of data/.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/formats.h"
#include "roadbed/map/lane_table/read.h"
#include "roadbed/map/lanelet2/write/autoware/write.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/sumo/net.h"
#include "roadbed/map/sumo/write.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

/// A kind of thing that maps have, and how many of it one has.
struct Kind {
  const char* name;
  std::size_t (*count)(const RoadMap& road_map);
};

template <typename Fits>
std::size_t count_lanes(const RoadMap& road_map, const Fits& fits) {
  std::size_t count = 0;
  for (const Lane& lane : road_map.lanes()) {
    if (is_drivable(lane.type)) count += fits(lane);
  }
  return count;
}

std::size_t changes_from(const RoadMap& road_map, const Lane& lane) {
  const LaneLinks& links = road_map.graph().of(lane.id);
  std::size_t count = 0;
  for (const auto& neighbour : {links.left, links.right}) {
    count += neighbour && neighbour->same_direction && neighbour->change_allowed();
  }
  return count;
}

bool is_raised(const Lane& lane) {
  return std::ranges::any_of(lane.centre.z_m, [](double z_m) { return std::abs(z_m) > 0.01; });
}

bool is_marked(const Lane& lane) {
  return std::ranges::any_of(lane.left_marks,
                             [](const BorderMark& mark) { return mark.type != MarkType::none; });
}

std::size_t signals_of(const RoadMap& road_map, bool dynamic) {
  std::size_t count = 0;
  for (const Signal& signal : road_map.signals()) count += signal.dynamic == dynamic;
  return count;
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"driving lanes",
       [](const RoadMap& m) { return count_lanes(m, [](const Lane&) { return 1U; }); }},
      {"their links",
       [](const RoadMap& m) {
         return count_lanes(m, [&](const Lane& l) { return m.graph().of(l.id).successors.size(); });
       }},
      {"lane changes",
       [](const RoadMap& m) {
         return count_lanes(m, [&](const Lane& l) { return changes_from(m, l); });
       }},
      {"limits",
       [](const RoadMap& m) {
         return count_lanes(m, [](const Lane& l) { return !l.speed_limits.empty() ? 1U : 0U; });
       }},
      {"markings",
       [](const RoadMap& m) {
         return count_lanes(m, [](const Lane& l) { return is_marked(l) ? 1U : 0U; });
       }},
      {"heights",
       [](const RoadMap& m) {
         return count_lanes(m, [](const Lane& l) { return is_raised(l) ? 1U : 0U; });
       }},
      {"other lanes",
       [](const RoadMap& m) {
         return m.lanes().size() - count_lanes(m, [](const Lane&) { return 1U; });
       }},
      {"junctions", [](const RoadMap& m) { return m.junctions().size(); }},
      {"lights", [](const RoadMap& m) { return signals_of(m, true); }},
      {"signs", [](const RoadMap& m) { return signals_of(m, false); }},
      {"stop lines", [](const RoadMap& m) { return m.stop_lines().size(); }},
      {"areas", [](const RoadMap& m) { return m.areas().size(); }},
      {"objects", [](const RoadMap& m) { return m.objects().size(); }},
  };
  return all;
}

/// "all" where nothing is fewer, "·" where the source has none.
std::string survival(std::size_t before, std::size_t after) {
  if (before == 0) return "·";
  if (after >= before) return "all";
  return after == 0 ? "none" : fmt::format("{} of {}", after, before);
}

struct Source {
  const char* name;
  const char* file;
};
constexpr Source kSources[] = {{"OpenDRIVE", "town.xodr"},
                               {"Lanelet2", "crossing.osm"},
                               {"CommonRoad", "junction.xml"},
                               {"lanes by columns", "lanes.geojson"}};

RoadMap source_map(const Source& source) {
  const auto file = tests::data_folder() / source.file;
  if (std::string(source.file) != "lanes.geojson") return load_map(file);
  const auto columns = tests::data_folder() / "lanes_columns.json";
  const auto mapping = lane_table::read_mapping(read_file(columns), "lanes_columns.json");
  return RoadMap(lane_table::read(read_file(file), "lanes.geojson", mapping));
}

struct Target {
  const char* name;
  std::function<std::string(const RoadMap&)> write;
};

std::string written_by(const char* suffix, const RoadMap& road_map) {
  SaveOptions options;
  options.crs = road_map.crs().empty() ? "EPSG:32632" : road_map.crs();
  options.is_own_crs = !road_map.crs().empty();
  return format_to_write("map", suffix).write(road_map, options);
}

std::vector<Target> targets() {
  return {{"OpenDRIVE", [](const RoadMap& m) { return written_by(".xodr", m); }},
          {"Lanelet2", [](const RoadMap& m) { return written_by(".osm", m); }},
          {"Autoware",
           [](const RoadMap& m) {
             return lanelet2::write_autoware(m, {m.crs(), m.offset_in_crs(), {}}).vector_map;
           }},
          {"CommonRoad", [](const RoadMap& m) { return written_by(".xml", m); }}};
}

/// What a net for SUMO has of a map, which is not read back.
class InNet {
 public:
  explicit InNet(const RoadMap& road_map)
      : road_map_(road_map),
        net_(sumo::build_net(road_map, sumo::DirectedLanes(road_map), find_conflicts(road_map))) {
    for (const sumo::NetEdge& edge : net_.edges) {
      for (const sumo::DirectedLane& way : edge.lanes) lanes_.insert(way.lane);
      for (std::size_t i = 1; i < edge.lanes.size(); ++i) {
        beside_.insert({edge.lanes[i - 1].lane, edge.lanes[i].lane});
        beside_.insert({edge.lanes[i].lane, edge.lanes[i - 1].lane});
      }
    }
    for (const sumo::NetConnection& connection : net_.connections) {
      LaneId before = net_.from_lane(connection).lane;
      for (const sumo::DirectedLane& way : connection.across) {
        lanes_.insert(way.lane);
        links_.insert({std::exchange(before, way.lane), way.lane});
      }
      links_.insert({before, net_.to_lane(connection).lane});
    }
    for (const auto& [what, count] : sumo::write_sumo(road_map, {"map", "", {}}).lost) {
      if (what.starts_with("traffic lights")) lost_lights_ = count;
    }
  }

  std::size_t count(const std::string& kind) const {
    if (kind == "driving lanes") return lanes([](const Lane&) { return true; });
    if (kind == "their links") return links();
    if (kind == "lane changes") return changes();
    if (kind == "limits") return lanes([](const Lane& l) { return !l.speed_limits.empty(); });
    if (kind == "heights") return lanes(is_raised);
    if (kind == "other lanes") return lanes_.size() - count("driving lanes");
    if (kind == "junctions") return junctions();
    if (kind == "lights") return signals_of(road_map_, true) - lost_lights_;
    return 0;
  }

 private:
  template <typename Fits>
  std::size_t lanes(const Fits& fits) const {
    return count_lanes(road_map_,
                       [&](const Lane& l) { return lanes_.contains(l.id) && fits(l) ? 1U : 0U; });
  }

  std::size_t links() const {
    return count_lanes(road_map_, [&](const Lane& lane) {
      return std::ranges::count_if(road_map_.graph().of(lane.id).successors, [&](LaneId next) {
        return links_.contains({lane.id, next});
      });
    });
  }

  std::size_t changes() const {
    return count_lanes(road_map_, [&](const Lane& lane) {
      const LaneLinks& links = road_map_.graph().of(lane.id);
      std::size_t count = 0;
      for (const auto& neighbour : {links.left, links.right}) {
        count += neighbour && neighbour->same_direction && neighbour->change_allowed() &&
                 beside_.contains({lane.id, neighbour->lane});
      }
      return count;
    });
  }

  std::size_t junctions() const {
    std::size_t count = 0;
    for (const Junction& junction : road_map_.junctions()) {
      count += std::ranges::count(net_.nodes, junction.source_id, &sumo::NetNode::id);
    }
    return count;
  }

  const RoadMap& road_map_;
  sumo::Net net_;
  std::set<LaneId> lanes_;
  std::set<std::pair<LaneId, LaneId>> links_, beside_;
  std::size_t lost_lights_ = 0;
};

template <typename Count>
std::string row(const Source& source, const char* target, const RoadMap& before,
                const Count& count_after) {
  std::string text = fmt::format("| {} | {} |", source.name, target);
  for (const Kind& kind : kinds()) {
    text += fmt::format(" {} |", survival(kind.count(before), count_after(kind)));
  }
  return text + "\n";
}

std::string table() {
  std::string text = "| from | to |", rule = "|---|---|";
  for (const Kind& kind : kinds()) {
    text += fmt::format(" {} |", kind.name);
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const Source& source : kSources) {
    const RoadMap before = source_map(source);
    for (const Target& target : targets()) {
      if (std::string(source.name) == target.name) continue;
      const RoadMap after = parse_map(target.write(before), "written");
      text += row(source, target.name, before, [&](const Kind& kind) { return kind.count(after); });
    }
    const InNet net(before);
    text += row(source, "SUMO", before, [&](const Kind& kind) { return net.count(kind.name); });
  }
  return text;
}

TEST(Conversions, KeepWhatTheTableInTheReadmeSays) {
  const std::string readme = read_file(tests::data_folder().parent_path() / "map/README.md");
  const std::string made = table();
  EXPECT_NE(readme.find(made), std::string::npos) << "map/README.md should hold:\n\n" << made;
}

}  // namespace
}  // namespace roadbed::map
