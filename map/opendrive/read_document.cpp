#include "roadbed/map/opendrive/read.h"

#include <cmath>

#include "roadbed/map/opendrive/element_readers.h"

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

Document read_document(const XmlDocument& xml, int threads) {
  Document document;
  AttributeReader in(xml);
  read_header(in, document);
  read_roads(in, document, threads);
  read_junctions(in, document);
  read_controllers(xml, document);
  document.unused = count_unused(xml);
  document.refusal = in.fault();
  return document;
}

void mend(Document& document) {
  if (document.refusal) throw *document.refusal;
  std::erase_if(document.roads, [](const RoadRecord& road) { return !is_usable(road); });
  for (RoadRecord& road : document.roads) {
    mend_road(road);
    const auto broken = [](const auto& record) { return record.is_broken; };
    std::erase_if(road.signals, broken);
    std::erase_if(road.signal_references, broken);
    std::erase_if(road.objects, broken);
  }
  for (JunctionRecord& junction : document.junctions) {
    std::erase_if(junction.connections,
                  [](const JunctionConnection& connection) { return connection.is_broken; });
  }
  split_at_virtual_links(document);
  move_to_local_origin(document);
}

}  // namespace roadbed::map::opendrive
