#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/drawing/svg.h"
#include "roadbed/map/model/road_map.h"

// Private to write_svg.cpp and its parts.

namespace roadbed::map::inline drawing::svg {

constexpr const char* kPaper = "#f5f3ee";
constexpr const char* kAsphalt = "#4a515b";
constexpr const char* kJunction = "#5b6470";
constexpr const char* kKerb = "#2f353d";
constexpr const char* kWhite = "#ffffff";
constexpr const char* kYellow = "#f2c14e";
constexpr const char* kArrow = "#cfe3f1";
constexpr const char* kPath = "#86b9dc";
constexpr const char* kStop = "#e4572e";
constexpr const char* kInk = "#2b2f36";
constexpr const char* kFaint = "#8a8d91";

/// Sizes of a picture [m], all from the width of a pixel when it fills `longer_side_px`.
struct Sheet {
  Sheet(const RoadMap& road_map, double longer_side_px);

  /// At least so many metres, and at least so many pixels.
  double stroke_m(double least_m, double least_px) const;

  Eigen::Vector2d low_in_map{0, 0}, high_in_map{0, 0};  ///< what is drawn
  double longer_m = 0.0, px_m = 0.0;
  Eigen::Vector2d upper_left_in_map{0, 0}, size_m{0, 0};
  double caption_m = 0.0;  ///< height of the strip below the map
};

/// Kinds of things that a picture shows, for its legend.
struct Shown {
  std::vector<LaneType> ground;
  bool junctions = false, crosswalks = false, stop_lines = false, lights = false, signs = false;
};

/// The picture while it is drawn.
struct Drawing {
  const RoadMap& road_map;
  const Sheet sheet;
  SvgCanvas canvas;
  Shown shown;
};

/// What surrounds the carriageway, by lane type; empty: not drawn, or drawn as carriageway.
std::string_view ground_colour(LaneType type);

/// Attributes of a line without fill.
std::string stroke(std::string_view colour, double width_m, std::string_view more = {});

// Each draws one part; `lanes` are those of one level, in order of id.
void draw_grid(Drawing& drawing);
void draw_areas(Drawing& drawing);
void draw_surfaces(Drawing& drawing, const std::vector<LaneId>& lanes, bool is_bridge);
void draw_markings(Drawing& drawing, const std::vector<LaneId>& lanes);
void draw_directions(Drawing& drawing, const std::vector<LaneId>& lanes);
void draw_objects(Drawing& drawing);  // that stand on the ground: below all roads
void draw_painted_objects(Drawing& drawing);
void draw_stop_lines(Drawing& drawing);
void draw_signals(Drawing& drawing);
void draw_names(Drawing& drawing);
void draw_caption(Drawing& drawing);

}  // namespace roadbed::map::drawing::svg
