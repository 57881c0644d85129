#include "roadbed/map/edit/merging/lane_corners.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>

#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/edit/xml_edit.h"
#include "roadbed/map/opendrive/lane_borders.h"
#include "roadbed/map/opendrive/read.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

using opendrive::CrossSection;
using opendrive::LaneHeight;
using opendrive::RoadRecord;
using opendrive::SectionSide;

// Of the road before its end: the records that hold there hold at the end.
constexpr double kLastStretchM = 1e-6;

// Only what gives a road its shape, each end's road by its number.
std::string file_of(const std::vector<RoadEndPlace>& ends) {
  pugi::xml_document file;
  pugi::xml_node root = file.append_child("OpenDRIVE");
  pugi::xml_node header = root.append_child("header");
  header.append_attribute("revMajor").set_value("1");
  for (std::size_t i = 0; i < ends.size(); ++i) {
    pugi::xml_node road = root.append_copy(ends[i].road);
    for (const char* unused : {"link", "objects", "signals", "userData"}) {
      while (road.remove_child(unused)) {
      }
    }
    set_text(road, "id", std::to_string(i));
  }
  std::ostringstream text;
  file.save(text, "", pugi::format_raw);
  return std::move(text).str();
}

void add_side(const RoadRecord& road, const geometry::PlanView& plan_view, bool at_start, int sign,
              RoadEndShape& shape) {
  const std::size_t section = at_start ? 0 : road.sections.size() - 1;
  const SectionSide side = opendrive::section_side(road, section, sign);
  if (side.lanes.empty()) return;
  const double end_m = at_start ? side.from_s_m : side.to_s_m;
  const double inside_m = at_start ? std::min(end_m + kLastStretchM, side.to_s_m)
                                   : std::max(end_m - kLastStretchM, side.from_s_m);
  opendrive::SideBorders borders(road, plan_view, side);
  borders.enter(std::min(end_m, inside_m), std::max(end_m, inside_m));
  CrossSection row;
  borders.evaluate(end_m, row);
  for (std::size_t i = 0; i < side.lanes.size(); ++i) {
    const LaneHeight raised = borders.raised().empty() ? LaneHeight{} : borders.raised()[i];
    const auto corner = [&](std::size_t border, double above_m) {
      const Eigen::Vector2d& at = row.border_in_map[border];
      return Eigen::Vector3d(at.x(), at.y(), row.z_m[border] + above_m);
    };
    const opendrive::LaneRecord& lane = *side.lanes[i];
    shape.lanes[lane.id] = {lane.type, corner(i, raised.inner_m), corner(i + 1, raised.outer_m)};
  }
}

RoadEndShape shape_of(const RoadRecord& road, bool at_start) {
  RoadEndShape shape;
  const double end_m = at_start ? 0.0 : road.length_m;
  const double inside_m = at_start ? kLastStretchM : end_m - kLastStretchM;
  shape.height_m = road.elevation.cubic.at(end_m, inside_m).value;
  if (road.sections.empty() || road.plan_pieces.empty()) return shape;
  const geometry::PlanView plan_view(road.plan_pieces);
  for (const int sign : {1, -1}) add_side(road, plan_view, at_start, sign, shape);
  return shape;
}

}  // namespace

double distance_m(const LaneCorners& a, const LaneCorners& b) {
  return std::max((a.inner - b.inner).norm(), (a.outer - b.outer).norm());
}

std::vector<RoadEndShape> shapes_of(const std::vector<RoadEndPlace>& ends) {
  std::vector<RoadEndShape> shapes(ends.size());
  if (ends.empty()) return shapes;
  const XmlDocument xml(file_of(ends), "ends of roads");
  opendrive::Document document = opendrive::read_document(xml);
  if (document.refusal) return shapes;
  opendrive::mend(document);
  for (const RoadRecord& road : document.roads) {
    const auto i = static_cast<std::size_t>(std::strtoull(road.id.c_str(), nullptr, 10));
    if (i < ends.size()) shapes[i] = shape_of(road, ends[i].at_start);
  }
  return shapes;
}

}  // namespace roadbed::map::edit::merging
