#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "roadbed/geometry/polygons/polygon.h"
#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/repair/element_text.h"
#include "roadbed/map/repair/near_ends.h"
#include "roadbed/map/repair/proposals.h"

namespace roadbed::map::inline repair {
namespace {

using commonroad::Document;
using Eigen::Vector2d;

/// Children of a lanelet in the order of the schema, up to those that are put in.
constexpr std::array<std::string_view, 6> kOrder = {"leftBound", "rightBound",   "predecessor",
                                                    "successor", "adjacentLeft", "adjacentRight"};

struct RoadLanelet {
  pugi::xml_node node;
  std::string id;
  std::vector<Vector2d> left, right;

  bool is_whole() const { return left.size() >= 2 && right.size() >= 2; }
};

std::vector<Vector2d> in_plan(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Vector2d> plan;
  for (const Eigen::Vector3d& point : points) plan.emplace_back(point.head<2>());
  return plan;
}

double area_between_m2(const std::vector<Vector2d>& left, const std::vector<Vector2d>& right) {
  geometry::Ring ring = right;
  ring.insert(ring.end(), left.rbegin(), left.rend());
  return geometry::signed_area_m2(ring);
}

bool runs_against(const RoadLanelet& lanelet) {
  const auto &l = lanelet.left, &r = lanelet.right;
  return (l.front() - r.front()).norm() + (l.back() - r.back()).norm() >
         (l.front() - r.back()).norm() + (l.back() - r.front()).norm();
}

/// Angle between the directions in which one lanelet ends and another begins [rad].
double turn_rad(const RoadLanelet& from, const RoadLanelet& to) {
  const std::size_t n = from.left.size();
  const Vector2d last = from.left[n - 1] - from.left[n - 2], first = to.left[1] - to.left[0];
  return std::abs(std::atan2(last.x() * first.y() - last.y() * first.x(), last.dot(first)));
}

std::string renamed(std::string text, std::string_view from, std::string_view to) {
  const std::size_t close = text.rfind(from);
  if (close > 1) text.replace(close, from.size(), to);
  return text.replace(1, from.size(), to);
}

class CommonRoadProposer {
 public:
  CommonRoadProposer(const std::string& bytes, const std::string& name,
                     const RepairOptions& options)
      : bytes_(bytes), options_(options), document_(bytes, name) {
    const Vector2d origin = commonroad::find_origin(document_.xml);
    for (const pugi::xml_node node : document_.lanelets()) {
      const auto points = [&](const char* bound) {
        return in_plan(commonroad::read_points(document_.xml, node.child(bound), origin));
      };
      lanelets_.push_back(
          {node, node.attribute("id").value(), points("leftBound"), points("rightBound")});
      index_.emplace(lanelets_.back().id, lanelets_.size() - 1);
    }
  }

  std::vector<Repair> propose() {
    for (const RoadLanelet& lanelet : lanelets_) {
      if (lanelet.is_whole()) turn_bounds(lanelet);
    }
    for (const char* link : {"successor", "predecessor", "adjacentRight", "adjacentLeft"}) {
      for (const RoadLanelet& lanelet : lanelets_) return_links(lanelet, link);
    }
    link_ends();
    for (const RoadLanelet& lanelet : lanelets_) close_gap(lanelet);
    return std::move(repairs_);
  }

 private:
  const RoadLanelet* find(const std::string& id) const {
    const auto found = index_.find(id);
    return found == index_.end() ? nullptr : &lanelets_[found->second];
  }

  void add(std::string rule, const RoadLanelet& lanelet, std::string what,
           std::vector<TextEdit> edits, double moved_m = 0.0) {
    repairs_.push_back({std::move(rule), "lane " + lanelet.id, document_.xml.line_of(lanelet.node),
                        std::move(what), moved_m, std::move(edits)});
  }

  /// Behind what the schema has before it.
  TextEdit with_child(const RoadLanelet& lanelet, std::string_view name,
                      const std::string& child) const {
    pugi::xml_node before;
    for (const pugi::xml_node node : lanelet.node.children()) {
      const auto* at = std::ranges::find(kOrder, std::string_view(node.name()));
      if (at <= std::ranges::find(kOrder, name) && at != kOrder.end()) before = node;
    }
    return before ? text_of(bytes_, before).with_sibling_behind(child)
                  : text_of(bytes_, lanelet.node).with_last_child(child);
  }

  TextEdit with_link(const RoadLanelet& lanelet, const char* name, const std::string& id) const {
    return with_child(lanelet, name, fmt::format(R"(<{} ref="{}"/>)", name, id));
  }

  double gap_m(const RoadLanelet& from, const RoadLanelet& to) const {
    return std::max((from.left.back() - to.left.front()).norm(),
                    (from.right.back() - to.right.front()).norm());
  }

  bool is_beside(const RoadLanelet& lanelet, bool on_left, const RoadLanelet& other,
                 bool same) const {
    const auto& mine = on_left ? lanelet.left : lanelet.right;
    const auto& facing = on_left == same ? other.right : other.left;
    const Vector2d &first = same ? facing.front() : facing.back(),
                   &last = same ? facing.back() : facing.front();
    return (mine.front() - first).norm() <= options_.tolerance_m &&
           (mine.back() - last).norm() <= options_.tolerance_m;
  }

  void return_links(const RoadLanelet& lanelet, const std::string& link_name) {
    const bool is_adjacent = link_name.starts_with("adjacent");
    for (const pugi::xml_node link : lanelet.node.children(link_name.c_str())) {
      const RoadLanelet* other = find(link.attribute("ref").value());
      if (other == nullptr || other == &lanelet || !lanelet.is_whole() || !other->is_whole() ||
          commonroad::is_answered(lanelet.node, link, other->node)) {
        continue;
      }
      const char* back = commonroad::counterpart(link);
      const bool same = commonroad::is_same_direction(link);
      const bool fits =
          is_adjacent ? !other->node.child(back) &&
                            is_beside(lanelet, link_name == "adjacentLeft", *other, same)
                      : (link_name == "successor" ? gap_m(lanelet, *other)
                                                  : gap_m(*other, lanelet)) <= options_.tolerance_m;
      if (!fits) continue;
      const std::string way =
          is_adjacent ? fmt::format(R"( drivingDir="{}")", same ? "same" : "opposite") : "";
      add(is_adjacent ? "common-road.adjacency-one-sided" : "common-road.successor-one-sided",
          *other,
          fmt::format("now names lanelet {} as its {}, which names it so", lanelet.id, back),
          {with_child(*other, back, fmt::format(R"(<{} ref="{}"{}/>)", back, lanelet.id, way))});
    }
  }

  void link_ends() {
    NearPoints starts(options_.tolerance_m);
    for (std::size_t i = 0; i < lanelets_.size(); ++i) {
      const RoadLanelet& lanelet = lanelets_[i];
      if (lanelet.is_whole() && !lanelet.node.child("predecessor")) {
        starts.add(lanelet.left.front(), i);
      }
    }
    constexpr double straight_on_rad = 0.5;
    for (const RoadLanelet& from : lanelets_) {
      if (!from.is_whole() || from.node.child("successor")) continue;
      starts.visit(from.left.back(), [&](std::size_t i) {
        const RoadLanelet& to = lanelets_[i];
        if (&to == &from || gap_m(from, to) > options_.tolerance_m ||
            turn_rad(from, to) > straight_on_rad) {
          return;
        }
        const double apart_m = gap_m(from, to);
        std::vector<TextEdit> edits{with_link(from, "successor", to.id),
                                    with_link(to, "predecessor", from.id)};
        if (apart_m > options_.validate.max_gap_m) put_onto(from, to, edits);
        add("link.dead-end", from,
            fmt::format("is now linked to lanelet {}, which begins where it ends", to.id),
            std::move(edits), apart_m);
      });
    }
  }

  /// Lets a lanelet begin with the points that the one before ends with.
  void put_onto(const RoadLanelet& before, const RoadLanelet& lanelet,
                std::vector<TextEdit>& edits) const {
    for (const char* bound : {"leftBound", "rightBound"}) {
      const pugi::xml_node last = last_point(before.node.child(bound));
      const auto first = text_of(bytes_, lanelet.node.child(bound).child("point"));
      edits.push_back(first.replaced_by(text_of(bytes_, last).whole()));
    }
  }

  /// The start is put onto the end of the only lanelet before it.
  void close_gap(const RoadLanelet& lanelet) {
    const pugi::xml_node link = lanelet.node.child("predecessor");
    if (!link || link.next_sibling("predecessor") || !lanelet.is_whole()) return;
    const RoadLanelet* before = find(link.attribute("ref").value());
    if (before == nullptr || before == &lanelet || !before->is_whole()) return;
    const double apart_m = gap_m(*before, lanelet);
    if (apart_m <= options_.validate.max_gap_m || apart_m > options_.tolerance_m) return;
    std::vector<TextEdit> edits;
    put_onto(*before, lanelet, edits);
    add("geometry.gap", lanelet,
        fmt::format("now begins where lanelet {} ends, {:.3f} m from where it did", before->id,
                    apart_m),
        std::move(edits), apart_m);
  }

  static pugi::xml_node last_point(pugi::xml_node bound) {
    pugi::xml_node last;
    for (const pugi::xml_node point : bound.children("point")) last = point;
    return last;
  }

  void turn_bounds(const RoadLanelet& lanelet) {
    const auto turned = [](std::vector<Vector2d> line) {
      std::reverse(line.begin(), line.end());
      return line;
    };
    if (runs_against(lanelet)) {
      const bool turn_left = area_between_m2(turned(lanelet.left), lanelet.right) > 0.0;
      const bool turn_right = area_between_m2(lanelet.left, turned(lanelet.right)) > 0.0;
      if (turn_left == turn_right) return;
      turn_bound(lanelet, turn_left ? "leftBound" : "rightBound");
    } else if (area_between_m2(lanelet.left, lanelet.right) < 0.0) {
      swap_bounds(lanelet);
    }
  }

  void turn_bound(const RoadLanelet& lanelet, const char* bound) {
    std::vector<XmlElementText> points;
    for (const pugi::xml_node point : lanelet.node.child(bound).children("point")) {
      points.push_back(text_of(bytes_, point));
    }
    std::vector<TextEdit> edits;
    for (std::size_t i = 0; i < points.size(); ++i) {
      edits.push_back(points[i].replaced_by(points[points.size() - 1 - i].whole()));
    }
    add("geometry.self-intersection", lanelet,
        fmt::format("the points of its {}, which ran against its other bound, are now the other "
                    "way round",
                    bound),
        std::move(edits));
  }

  void swap_bounds(const RoadLanelet& lanelet) {
    const auto left = text_of(bytes_, lanelet.node.child("leftBound"));
    const auto right = text_of(bytes_, lanelet.node.child("rightBound"));
    add("import.swapped-borders", lanelet,
        "its left bound, which lay to the right of its right one, is now its right one, and the "
        "other its left one",
        {left.replaced_by(renamed(std::string(right.whole()), "rightBound", "leftBound")),
         right.replaced_by(renamed(std::string(left.whole()), "leftBound", "rightBound"))});
  }

  const std::string& bytes_;
  const RepairOptions& options_;
  Document document_;
  std::vector<RoadLanelet> lanelets_;
  std::map<std::string, std::size_t> index_;
  std::vector<Repair> repairs_;
};

}  // namespace

std::vector<Repair> propose_common_road(const std::string& bytes, const std::string& name,
                                        const RepairOptions& options) {
  return CommonRoadProposer(bytes, name, options).propose();
}

}  // namespace roadbed::map::repair
