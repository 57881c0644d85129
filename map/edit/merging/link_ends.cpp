#include "roadbed/map/edit/merging/link_ends.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/map/edit/plan_cut.h"
#include "roadbed/map/edit/road_cut.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

constexpr double kSameDirectionRad = 0.1;

struct RoadEnd {
  pugi::xml_node road;
  bool at_start;
  std::size_t source;
  geometry::Pose2 outwards;  ///< heading away from the road

  std::string id() const { return road.attribute("id").value(); }
  const char* contact() const { return at_start ? "start" : "end"; }
  const char* link() const { return at_start ? "predecessor" : "successor"; }
  std::string called() const { return fmt::format("{} of road {}", contact(), id()); }
};

bool leads_somewhere(pugi::xml_node road, const char* link) {
  return road.child("link").child(link) || find_clip_memory(road).child("link").child(link);
}

std::vector<RoadEnd> free_ends(pugi::xml_node root,
                               const std::map<std::string, std::size_t>& sources) {
  std::vector<RoadEnd> ends;
  for (const auto road : root.children("road")) {
    const std::string_view junction = road.attribute("junction").value();
    const auto source = sources.find(road.attribute("id").value());
    if ((!junction.empty() && junction != "-1") || source == sources.end()) continue;
    for (const bool at_start : {true, false}) {
      if (leads_somewhere(road, at_start ? "predecessor" : "successor")) continue;
      geometry::Pose2 pose = reference_pose(road, at_start ? 0.0 : number(road, "length"));
      if (at_start) pose.heading_rad += std::numbers::pi;
      ends.push_back({road, at_start, source->second, pose});
    }
  }
  return ends;
}

pugi::xml_node end_section(const RoadEnd& end) {
  const auto sections = children(end.road.child("lanes"), "laneSection");
  if (sections.empty()) return {};
  return end.at_start ? sections.front() : sections.back();
}

// Lanes of a section by their ids, the middle one left out.
std::map<int, pugi::xml_node> lanes_of(pugi::xml_node section) {
  std::map<int, pugi::xml_node> lanes;
  for (const char* side : {"left", "right"}) {
    for (const auto lane : section.child(side).children("lane")) {
      lanes[lane.attribute("id").as_int()] = lane;
    }
  }
  return lanes;
}

void link_lane(pugi::xml_node lane, const char* link, int to) {
  pugi::xml_node links = ordered_child(lane, "link", kLaneOrder);
  if (links.child(link)) return;
  pugi::xml_node made = std::string_view(link) == "predecessor" ? links.prepend_child(link)
                                                                : links.append_child(link);
  made.append_attribute("id").set_value(to);
}

void link_road(const RoadEnd& end, const RoadEnd& to) {
  pugi::xml_node links = ordered_child(end.road, "link", kRoadOrder);
  pugi::xml_node made =
      end.at_start ? links.prepend_child(end.link()) : links.append_child(end.link());
  set_text(made, "elementType", "road");
  set_text(made, "elementId", to.id());
  set_text(made, "contactPoint", to.contact());
}

// Lanes face each other by their ids, mirrored where both roads begin or end there.
std::string link(const RoadEnd& a, const RoadEnd& b) {
  const int sign = a.at_start == b.at_start ? -1 : 1;
  const auto lanes = lanes_of(end_section(a)), others = lanes_of(end_section(b));
  bool any = false;
  for (const auto& [id, lane] : lanes) {
    const auto other = others.find(sign * id);
    if (other == others.end()) continue;
    any = true;
    link_lane(lane, a.link(), other->first);
    link_lane(other->second, b.link(), id);
  }
  if (!any) return "no lanes that face each other";
  link_road(a, b);
  link_road(b, a);
  return "linked";
}

bool face(const RoadEnd& a, const RoadEnd& b) {
  const double turn = a.outwards.heading_rad - b.outwards.heading_rad + std::numbers::pi;
  return std::abs(std::remainder(turn, 2.0 * std::numbers::pi)) <= kSameDirectionRad;
}

}  // namespace

void link_coinciding_ends(pugi::xml_node root, const std::map<std::string, std::size_t>& sources,
                          double tolerance_m, std::vector<Seam>& seams) {
  const std::vector<RoadEnd> ends = free_ends(root, sources);
  std::vector<geometry::Box> boxes;
  for (const RoadEnd& end : ends) boxes.emplace_back(end.outwards.position());
  const geometry::BoxTree tree(boxes);
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(tolerance_m);
  const auto meeting = [&](const RoadEnd& end) {
    std::vector<std::size_t> found;
    const Eigen::Vector2d at = end.outwards.position();
    tree.visit(geometry::Box(at - reach, at + reach), [&](std::size_t i) {
      const bool near = (ends[i].outwards.position() - at).norm() <= tolerance_m;
      if (near && ends[i].source != end.source) found.push_back(i);
    });
    std::sort(found.begin(), found.end());
    return found;
  };
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (const std::size_t other : meeting(ends[i])) {
      if (other < i) continue;
      const RoadEnd &a = ends[i], &b = ends[other];
      const bool alone = meeting(a).size() == 1 && meeting(b).size() == 1;
      std::string what = "more than two ends meet";
      if (alone) what = face(a, b) ? link(a, b) : "not in one direction";
      seams.push_back({a.called(), b.called(),
                       (a.outwards.position() - b.outwards.position()).norm(), std::move(what),
                       a.outwards.x_m, a.outwards.y_m});
    }
  }
}

}  // namespace roadbed::map::edit::merging
