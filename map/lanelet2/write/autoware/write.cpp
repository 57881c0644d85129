#include "roadbed/map/lanelet2/write/autoware/write.h"

#include <fmt/format.h>

#include <algorithm>

#include "roadbed/map/lanelet2/write/autoware/crosswalks.h"
#include "roadbed/map/lanelet2/write/autoware/frame.h"
#include "roadbed/map/lanelet2/write/autoware/intersections.h"
#include "roadbed/map/lanelet2/write/autoware/lane_tags.h"
#include "roadbed/map/lanelet2/write/autoware/rights_of_way.h"
#include "roadbed/map/lanelet2/write/autoware/stop_lines.h"
#include "roadbed/map/lanelet2/write/autoware/traffic_lights.h"
#include "roadbed/map/lanelet2/write/from_document.h"

namespace roadbed::map::lanelet2 {
namespace {

LaneletMap plain_map(const RoadMap& road_map, const std::optional<std::string>& source) {
  if (source) {
    Document document = read_document(*source, "Lanelet2");
    const BuiltLanes built = build_lanes(document);
    return lanelet_map_of(document, built);
  }
  const auto is_wanted = [&](const Lane& lane) { return has_place_in_autoware(road_map, lane); };
  return lanelet_map(road_map, {.is_wanted = is_wanted, .areas = false, .centrelines = false});
}

/// A map's local coordinates are those of a point cloud where they are no coordinates of a zone.
bool has_local_coordinates(const RoadMap& road_map) {
  return is_from_lanelet2(road_map) && !road_map.crs().starts_with("EPSG:32");
}

std::vector<std::pair<std::string, std::size_t>> lost_of(const RoadMap& road_map,
                                                         const LaneletMap& made) {
  std::size_t sidewalks = 0, shoulders = 0, rails = 0, unused = 0;
  for (const Lane& lane : road_map.lanes()) {
    if (made.lanelets[lane.id.index]) continue;
    const bool is_rail = lane.type == LaneType::tram || lane.type == LaneType::rail;
    ++(is_rail                           ? rails
       : !is_writable(lane)              ? unused
       : lane.type == LaneType::sidewalk ? sidewalks
                                         : shoulders);
  }
  std::vector<std::pair<std::string, std::size_t>> lost;
  const auto add = [&](const char* what, std::size_t count) {
    if (count > 0) lost.emplace_back(what, count);
  };
  add("sidewalks that lie beside no road", sidewalks);
  add("shoulders and parking lanes that lie beside no road", shoulders);
  add("tram and rail lanes", rails);
  add("lanes that nobody may use", unused);
  add(kFlattenedLimits, flattened_limits(road_map, made));
  if (!is_from_lanelet2(road_map)) add("areas", road_map.areas().size());
  return lost;
}

class AutowareWriter {
 public:
  AutowareWriter(const RoadMap& road_map, const AutowareOptions& options)
      : road_map_(road_map), options_(options), made_(plain_map(road_map, options.source)) {}

  AutowareFiles write() {
    add_lane_tags(road_map_, made_);
    add_crosswalk_lanelets(road_map_, made_);
    const WrittenMap plain = written();
    add_intersections(road_map_, plain, made_);
    add_crosswalk_regulations(plain, made_);
    const AssumedOfLights assumed = complete_traffic_lights(road_map_, plain, made_);
    add_road_markings(plain, made_);
    add_rights_of_way(written(), made_);
    AutowareFrame frame = this->frame();
    AutowareFiles files{osm_text(made_.osm, frame), std::move(frame.projector_info),
                        lost_of(road_map_, made_), std::move(frame.notes)};
    add_notes(assumed, files.notes);
    return files;
  }

 private:
  AutowareFrame frame() const {
    return autoware_frame(road_map_, made_.osm,
                          {options_.crs, options_.offset_in_crs, has_local_coordinates(road_map_)});
  }

  WrittenMap written() const { return {made_.osm, frame()}; }

  void add_notes(const AssumedOfLights& assumed, std::vector<std::string>& notes) {
    for (std::string& note : notes_of(made_)) notes.push_back(std::move(note));
    const auto note = [&](std::size_t count, const char* what) {
      if (count > 0) notes.push_back(fmt::format("{} {}", count, what));
    };
    note(assumed.heights, "traffic lights have no height: their bodies are taken as 1 m high");
    note(assumed.facings,
         "traffic lights face away from the lanes that they speak to: turned round");
    note(assumed.stop_lines,
         "stop lines are missing: they are put where the intersection's lanes begin, or "
         "beside the light where there is none");
  }

  const RoadMap& road_map_;
  const AutowareOptions& options_;
  LaneletMap made_;
};

}  // namespace

AutowareFiles write_autoware(const RoadMap& road_map, const AutowareOptions& options) {
  return AutowareWriter(road_map, options).write();
}

}  // namespace roadbed::map::lanelet2
