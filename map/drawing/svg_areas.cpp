#include <string>

#include "roadbed/map/derived/area_centreline.h"
#include "roadbed/map/drawing/svg_drawing.h"

namespace roadbed::map::inline drawing::svg {

// Road areas look like carriageway, with the line in their middle; others like pavement.
void draw_areas(Drawing& drawing) {
  std::string others;
  for (const Area& area : drawing.road_map.areas()) {
    if (!area.is_road) others += drawing.canvas.region(area.in_map);
  }
  drawing.canvas.add_path(others, R"(fill="#ded8cc" fill-rule="evenodd")");
  drawing.canvas.add_path(drawing.canvas.region(road_area_surface(drawing.road_map)),
                          std::string(R"(fill=")") + kAsphalt + R"(" fill-rule="evenodd")");
  std::string middle;
  for (const geometry::MedialBranch& branch : road_centrelines(drawing.road_map)) {
    middle += drawing.canvas.line(branch.line.points());
  }
  drawing.canvas.add_path(middle, stroke(kPath, drawing.sheet.stroke_m(0.1, 0.6)));
}

}  // namespace roadbed::map::drawing::svg
