#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "roadbed/map/edit/elevation/elevate.h"
#include "roadbed/map/edit/elevation/point_heights.h"
#include "roadbed/map/edit/osm_edit.h"
#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::inline edit::inline elevation {
namespace {

using lanelet2::Document;
using lanelet2::Way;

double apart_m(const Document& document, std::uint32_t a, std::uint32_t b) {
  return (document.nodes[a].in_map - document.nodes[b].in_map).head<2>().norm();
}

void connect_ways(const Document& document, HeightNetwork& lines) {
  for (const Way& way : document.ways) {
    for (std::size_t i = 0; i + 1 < way.nodes.size(); ++i) {
      lines.connect(way.nodes[i], way.nodes[i + 1],
                    apart_m(document, way.nodes[i], way.nodes[i + 1]));
    }
  }
}

// Ends of a lanelet, from border to border.
void connect_lanelets(const Document& document, HeightNetwork& lines) {
  for (const lanelet2::Relation& relation : document.relations) {
    if (relation.type != "lanelet" || relation.members.size() < 2) continue;
    const Way* sides[2] = {nullptr, nullptr};
    for (const lanelet2::Member& member : relation.members) {
      const bool is_left = member.role == "left";
      if (member.kind != lanelet2::MemberKind::way || (!is_left && member.role != "right"))
        continue;
      const auto way = document.way_index.find(member.id);
      if (way && !document.ways[*way].nodes.empty()) sides[is_left ? 0 : 1] = &document.ways[*way];
    }
    if (sides[0] == nullptr || sides[1] == nullptr) continue;
    const auto left = sides[0]->nodes;
    auto first = sides[1]->nodes.front(), last = sides[1]->nodes.back();
    if (apart_m(document, left.front(), last) < apart_m(document, left.front(), first)) {
      std::swap(first, last);
    }
    lines.connect(left.front(), first, apart_m(document, left.front(), first));
    lines.connect(left.back(), last, apart_m(document, left.back(), last));
  }
}

// Nodes at one place, on one level, are as one.
void connect_places(const std::vector<Eigen::Vector3d>& points, HeightNetwork& lines) {
  constexpr double kOnePlaceM = 0.01, kOneLevelM = 0.5;
  std::vector<std::size_t> by_x(points.size());
  std::iota(by_x.begin(), by_x.end(), std::size_t{0});
  std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) {
    return points[a].x() != points[b].x() ? points[a].x() < points[b].x()
                                          : points[a].y() < points[b].y();
  });
  for (std::size_t i = 1; i < by_x.size(); ++i) {
    const Eigen::Vector3d apart = points[by_x[i]] - points[by_x[i - 1]];
    if (apart.head<2>().norm() > kOnePlaceM || std::abs(apart.z()) > kOneLevelM) continue;
    lines.connect(by_x[i], by_x[i - 1], 0.0);
  }
}

}  // namespace

Edited elevate_lanelet2(std::string bytes, const std::string& name, const GroundHeights& ground) {
  const Document document = lanelet2::read_document(std::move(bytes), name);
  HeightNetwork lines(document.nodes.size());
  connect_ways(document, lines);
  connect_lanelets(document, lines);
  std::vector<Eigen::Vector3d> points;
  points.reserve(document.nodes.size());
  const Eigen::Vector3d origin(document.origin_in_source.x(), document.origin_in_source.y(), 0.0);
  for (const lanelet2::Node& node : document.nodes) points.emplace_back(node.in_map + origin);
  connect_places(points, lines);
  Edited result;
  const auto heights_m = heights_on(points, lines, ground, "nodes", result);
  OsmEdit edit(document);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!heights_m[i] || !document.nodes[i].placed) continue;
    OsmElement element(edit.text_of(document.nodes[i].at));
    element.set_tag("ele", height_text(*heights_m[i]));
    edit.replace(document.nodes[i].at, element.text());
  }
  result.bytes = std::move(edit).file();
  return result;
}

}  // namespace roadbed::map::edit::elevation
