#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/map/validation/rule.h"

namespace roadbed::map::inline page {

/// Part of a lane, by its stations.
struct PagePiece {
  LaneId lane;
  double from_s_m = 0.0, to_s_m = 0.0;
};

/// Something drawn over the map: a route, a drive, occupied cells.
struct PageOverlay {
  std::string kind;  ///< which of the page's looks it has: "route", "drive", "occupied", "reach", …
  std::string name;             ///< in the list of layers
  std::string text = {};        ///< what there is to say of it: "812 m, 61 s"
  bool is_alternative = false;  ///< dashed
  std::vector<PagePiece> pieces =
      {};  ///< drawn along their centrelines; the page knows their heights
  std::vector<std::vector<Eigen::Vector2d>> lines_in_map = {};
  std::vector<geometry::Ring> rings_in_map = {};
  std::vector<Eigen::AlignedBox2d> boxes_in_map = {};
};

/// An entry of the list that a page walks through: a finding, a change.
struct PageRemark {
  std::string rule, severity, element, message;
  long line = 0;  ///< in the source file, 0 if unknown
  std::optional<Eigen::Vector2d> in_map;
};

struct MapPageOptions {
  std::string title = {};          ///< on top of the page
  std::string file = {};           ///< the map in the commands that it shows; the title if empty
  std::string crs = {};            ///< of the coordinates below, empty if unknown
  bool is_own_crs = false;         ///< the map's: its offset counts
  std::string remarks_title = {};  ///< "Findings" if empty
  std::optional<std::vector<PageRemark>> remarks = {};  ///< none: what `validate` finds in the map
  validation::ElementLines lines = {};                  ///< in the source file; empty if unknown
  std::vector<PageOverlay> overlays = {};
  std::vector<std::string>* notes = nullptr;  ///< takes what the user should know, a line each
};

/// What the scripts of a page need to draw a map (scripts/map_data.js reads it), as JSON that may
/// stand in a script: for pages that show a map among other things.
std::string map_page_data(const RoadMap& road_map, const MapPageOptions& options);

/// A map as one HTML file that opens without a server or a network and answers who looks at it:
/// what is here, what does it lead to, where is it. Lines are kept to 0.1 mm, so that the page
/// names the lane that RoadMap::locate names. Geographic coordinates are a fit to the projection,
/// left out with a note where there is none. Same map, same bytes. O(points), beside validating.
std::string write_map_page(const RoadMap& road_map, const MapPageOptions& options = {});

/// Findings as a page's entries.
std::vector<PageRemark> remarks_of(const std::vector<validation::Finding>& findings);

}  // namespace roadbed::map::page
