#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/map/page/column.h"
#include "roadbed/map/validation/rule.h"

// Private to map_page.cpp and its parts; the other side of it is scripts/decode.js.

namespace roadbed::map::inline page {

using Json = nlohmann::ordered_json;

struct PageOverlay;  // map_page.h
struct PageRemark;

/// The unit of coordinates in columns.
constexpr double kUnitsPerMetre = 1e4;

/// Lines one after the other: how many points each has, and the points as steps from the one
/// before, across lines too.
class LineColumns {
 public:
  void add(std::span<const Eigen::Vector2d> points_in_map);
  void add_point(const Eigen::Vector2d& in_map);  ///< a line of one point
  Json json() const;

 private:
  void step_to(const Eigen::Vector2d& in_map);

  Column counts_, steps_;
  std::int64_t x_ = 0, y_ = 0;
};

/// Lanes as columns, in order of id.
Json lanes_json(const RoadMap& road_map, const validation::ElementLines& lines);

/// What else a map holds: roads, junctions, signals, objects, stop lines, regulations, areas.
Json things_json(const RoadMap& road_map);

Json remarks_json(const std::vector<PageRemark>& remarks);
Json overlays_json(const std::vector<PageOverlay>& overlays);

/// Attributes as one text, "key=value" a line.
std::string attribute_lines(const Attributes& attributes);

/// The parts of the page, put into the program when it is built.
extern const std::string_view kMapTemplate;  ///< with {{name}} where text goes
extern const std::string_view kMapCss;
extern const std::string_view kMapJs;

}  // namespace roadbed::map::page
