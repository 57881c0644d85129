#include "roadbed/map/edit/merging/lanelet_ends.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <string>

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/edit/merging/near_ends.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

using Eigen::Vector2d;

/// Where a lanelet begins or ends.
struct BorderEnds {
  SourcedLanelet lanelet;
  Vector2d left, right;

  std::string id() const { return text(lanelet.node, "id"); }
};

std::vector<BorderEnds> ends_of(const XmlDocument& xml, const std::vector<SourcedLanelet>& lanelets,
                                bool at_start) {
  std::vector<BorderEnds> ends;
  for (const SourcedLanelet& lanelet : lanelets) {
    const auto point = [&](const char* bound) {
      const auto points = lanelet.node.child(bound).children("point");
      pugi::xml_node found;
      for (const auto one : points) {
        found = one;
        if (at_start) break;
      }
      return found;
    };
    const pugi::xml_node left = point("leftBound"), right = point("rightBound");
    if (!left || !right) continue;
    ends.push_back({lanelet, commonroad::read_point(xml, left, {0, 0}).head<2>(),
                    commonroad::read_point(xml, right, {0, 0}).head<2>()});
  }
  std::sort(ends.begin(), ends.end(),
            [](const BorderEnds& a, const BorderEnds& b) { return a.left.x() < b.left.x(); });
  return ends;
}

bool has_reference(pugi::xml_node lanelet, const char* link, const std::string& id) {
  return static_cast<bool>(lanelet.find_child([&](pugi::xml_node child) {
    return std::string_view(child.name()) == link && text(child, "ref") == id;
  }));
}

// Behind those of its kind and the borders.
void add_reference(pugi::xml_node lanelet, const char* link, const std::string& id) {
  if (has_reference(lanelet, link, id)) return;
  pugi::xml_node behind = lanelet.child("rightBound");
  for (const auto child : lanelet.children()) {
    const std::string_view name = child.name();
    if (name == "predecessor" || name == link) behind = child;
  }
  set_text(lanelet.insert_child_after(link, behind), "ref", id);
}

}  // namespace

void link_lanelet_ends(const XmlDocument& xml, const std::vector<SourcedLanelet>& lanelets,
                       double tolerance_m, std::vector<Seam>& seams) {
  std::vector<BorderEnds> starts = ends_of(xml, lanelets, true);
  std::erase_if(starts,
                [](const BorderEnds& one) { return one.lanelet.node.child("predecessor"); });
  std::vector<BorderEnds> ends = ends_of(xml, lanelets, false);
  std::erase_if(ends, [](const BorderEnds& one) { return one.lanelet.node.child("successor"); });
  std::vector<Vector2d> places;
  for (const BorderEnds& start : starts) places.push_back(start.left);
  NearEnds near(places, tolerance_m);
  for (const BorderEnds& end : ends) {
    for (const std::size_t i : near.around(end.left)) {
      const BorderEnds& start = starts[i];
      const double gap_m =
          std::max((start.left - end.left).norm(), (start.right - end.right).norm());
      if (gap_m > tolerance_m || start.lanelet.source == end.lanelet.source) continue;
      near.add_pair();
      add_reference(end.lanelet.node, "successor", start.id());
      add_reference(start.lanelet.node, "predecessor", end.id());
      const Vector2d at = 0.5 * (end.left + end.right);
      seams.push_back({"end of lanelet " + end.id(), "start of lanelet " + start.id(), gap_m,
                       "linked", at.x(), at.y()});
    }
  }
}

}  // namespace roadbed::map::edit::merging
