#include "roadbed/map/opendrive/document.h"

#include <cmath>

#include "roadbed/map/opendrive/budget.h"
#include "roadbed/map/opendrive/header.h"
#include "roadbed/map/opendrive/junctions.h"
#include "roadbed/map/opendrive/roads.h"
#include "roadbed/map/opendrive/unused.h"
#include "roadbed/map/opendrive/virtual.h"

namespace roadbed::map::opendrive {
namespace {

// Far from the file's origin coordinates are kept relative to a place near the map, so that
// products of them stay exact to far below a millimetre.
void move_to_local_origin(Document& document) {
  constexpr double far_m = 20'000.0, grid_m = 1'000.0;
  const geometry::Pose2 first = document.roads.front().plan_pieces.front().start;
  if (std::abs(first.x_m) < far_m && std::abs(first.y_m) < far_m) return;
  document.origin_in_source = {grid_m * std::round(first.x_m / grid_m),
                               grid_m * std::round(first.y_m / grid_m)};
  for (RoadRecord& road : document.roads) {
    for (geometry::PlanPiece& piece : road.plan_pieces) {
      piece.start.x_m -= document.origin_in_source.x();
      piece.start.y_m -= document.origin_in_source.y();
    }
  }
}

}  // namespace

bool is_open_drive(const std::string& root_element) { return root_element == "OpenDRIVE"; }

Document read_document(const XmlDocument& xml) {
  Document document;
  document.lanes_left = most_lanes(xml.size_bytes());
  read_header(xml, document);
  read_roads(xml, document);
  read_junctions(xml, document);
  read_controllers(xml, document);
  document.unused = count_unused(xml);
  split_at_virtual_links(document);
  move_to_local_origin(document);
  return document;
}

}  // namespace roadbed::map::opendrive
