#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/edit/clipping/clip.h"
#include "roadbed/map/edit/clipping/ladders.h"
#include "roadbed/map/edit/lanelet_parts.h"
#include "roadbed/map/edit/new_ids.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

/// A file, and what of it no region changes.
struct ScenarioMap {
  ScenarioMap(std::string bytes, const std::string& name)
      : indent(indent_of(bytes)), document(std::move(bytes), name), lanelets(document) {
    const pugi::xml_node root = document.xml.root();
    for (const auto one : root.children()) fresh.take(text(one, "id"));
    recall_links(root);
  }

  std::string indent;
  commonroad::Document document;
  LadderMap lanelets;
  FreshIds fresh;
};

/// What is left of a file: a copy, without the lanelets that are outside.
class CommonRoadClipper {
 public:
  CommonRoadClipper(const ScenarioMap& map, const Region& region, const ClipOptions& options)
      : map_(map),
        region_(region),
        spans_(map.lanelets.spans_inside(region, options.whole)),
        fresh_(map.fresh) {}

  bool run(Edited& result) {
    copy_what_is_near();
    if (kept_.empty()) return false;
    const LostLinks lost = parts_.settle_links(root_, true);
    settle_signs("trafficSign", "trafficSignRef");
    settle_signs("trafficLight", "trafficLightRef");
    settle_scenario();
    result.count("lanelets kept whole", kept_.size() - cut_);
    result.count("lanelets cut", cut_);
    result.count("parts of lanelets with an id of their own", named_);
    result.count("lanelets outside, left out", outside_);
    result.count("links taken off", lost.links);
    result.count("traffic signs and lights left out", signs_);
    result.count("incomings of intersections left out", lost.incomings);
    result.count("obstacles outside, left out", obstacles_);
    result.count("planning problems that begin or end outside, left out", problems_);
    result.bytes = text_of(root_, map_.indent, map_.document.xml.size_bytes());
    return true;
  }

 private:
  void copy_what_is_near() {
    const pugi::xml_node root = map_.document.xml.root();
    for (const pugi::xml_node node : root.parent().children()) {
      if (node != root) part_.append_copy(node);
      if (node == root) root_ = part_.append_child(root.name());
    }
    for (const auto attribute : root.attributes()) root_.append_copy(attribute);
    const std::vector<Ladder>& ladders = map_.lanelets.ladders();
    auto next = ladders.begin();
    for (const pugi::xml_node node : root.children()) {
      if (std::string_view(node.name()) != "lanelet") {
        root_.append_copy(node);
      } else if (next == ladders.end() || next->node != node || spans_[next->group].empty()) {
        ++outside_;
      } else {
        clip_lanelet(*next, root_.append_copy(node));
      }
      if (next != ladders.end() && next->node == node) ++next;
    }
  }

  void clip_lanelet(const Ladder& ladder, pugi::xml_node node) {
    std::vector<Span> spans;
    for (const Span& span : spans_[ladder.group]) {
      const double a = ladder.own_row(span.from), b = ladder.own_row(span.to);
      spans.push_back({std::min(a, b), std::max(a, b)});
    }
    std::ranges::sort(spans, {}, &Span::from);
    const auto is_all = [&](const Span& span) {
      return span.from <= 0.0 && span.to >= ladder.last_row();
    };
    cut_ += is_all(spans.front()) ? 0 : 1;
    // Copied before it is cut.
    std::vector<pugi::xml_node> nodes{node};
    while (nodes.size() < spans.size()) {
      nodes.push_back(root_.append_copy(node));
      set_text(nodes.back(), "id", fresh_.fresh());
      ++named_;
    }
    const LaneletSpan before = remembered_span(node).value_or(all_rows(node));
    for (std::size_t k = 0; k < spans.size(); ++k) {
      LaneletSpan span = before;
      if (!is_all(spans[k])) {
        for (const char* bound : {"leftBound", "rightBound"}) {
          cut_bound(nodes[k].child(bound), spans[k].from, spans[k].to);
        }
        static_cast<RowSpan&>(span) = before.part(spans[k].from, spans[k].to);
        remember_span(nodes[k], span);
      }
      parts_.add({nodes[k], span});
      kept_.push_back(nodes[k]);
      there_.insert(ladder.id);
    }
  }

  static void cut_bound(pugi::xml_node bound, double from, double to) {
    const std::vector<pugi::xml_node> points = children(bound, "point");
    const pugi::xml_node first = between(bound, points, from), last = between(bound, points, to);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto row = static_cast<double>(i);
      if (row < from || row > to) bound.remove_child(points[i]);
    }
    if (first) bound.insert_move_before(first, bound.child("point"));
    if (last) {
      pugi::xml_node end;
      for (const auto point : bound.children("point")) {
        if (point != last) end = point;
      }
      bound.insert_move_after(last, end);
    }
  }

  // A new point between two; none where there is one.
  static pugi::xml_node between(pugi::xml_node bound, const std::vector<pugi::xml_node>& points,
                                double row) {
    const auto i = static_cast<std::size_t>(row);
    const double part = row - static_cast<double>(i);
    if (part == 0.0) return {};
    pugi::xml_node made = bound.insert_copy_before(points[i], points[i]);
    for (auto axis : made.children()) {
      const double a = points[i].child(axis.name()).text().as_double(),
                   b = points[i + 1].child(axis.name()).text().as_double();
      axis.text().set(fmt::format("{}", std::lerp(a, b, part)).c_str());
    }
    return made;
  }

  bool is_inside(pugi::xml_node position) const {
    const auto point = position.child("point");
    return region_.contains(
        {point.child("x").text().as_double(), point.child("y").text().as_double()});
  }

  // Signs and lights that a lanelet names, and those inside that none ever named.
  void settle_signs(const char* kind, const char* reference) {
    std::set<std::string> named;
    for (const pugi::xml_node node : kept_) {
      for (const auto one : node.children(reference)) named.insert(text(one, "ref"));
      for (const auto one : node.child("stopLine").children(reference)) {
        named.insert(text(one, "ref"));
      }
    }
    for (const auto sign : children(root_, kind)) {
      if (named.contains(text(sign, "id")) || is_inside(sign.child("position"))) continue;
      root_.remove_child(sign);
      ++signs_;
    }
  }

  // Obstacles and planning problems by where they begin.
  void settle_scenario() {
    for (const auto node : [&] {
           std::vector<pugi::xml_node> all;
           for (const auto one : root_.children()) all.push_back(one);
           return all;
         }()) {
      const std::string_view name = node.name();
      const auto position = node.child("initialState").child("position");
      if (name == "planningProblem") {
        if (is_inside(position) && !misses_goal(node)) continue;
        root_.remove_child(node);
        ++problems_;
      } else if (name.ends_with("bstacle") && position.child("point") && !is_inside(position)) {
        root_.remove_child(node);
        ++obstacles_;
      }
    }
  }

  bool misses_goal(pugi::xml_node problem) const {
    for (const auto goal : problem.children("goalState")) {
      for (const auto lanelet : goal.child("position").children("lanelet")) {
        if (!there_.contains(text(lanelet, "ref"))) return true;
      }
    }
    return false;
  }

  const ScenarioMap& map_;
  const Region& region_;
  const std::vector<std::vector<Span>> spans_;  // of each group of lanelets
  pugi::xml_document part_;
  pugi::xml_node root_;  // of the part
  FreshIds fresh_;
  LaneletParts parts_;
  std::vector<pugi::xml_node> kept_;
  std::set<std::string> there_;  // lanelets of which something is
  std::size_t cut_ = 0, named_ = 0, outside_ = 0, signs_ = 0, obstacles_ = 0, problems_ = 0;
};

}  // namespace

Clipper common_road_clipper(std::string bytes, const std::string& name,
                            const ClipOptions& options) {
  const auto map = std::make_shared<const ScenarioMap>(std::move(bytes), name);
  return [map, options](const Region& region) {
    Edited result;
    if (!CommonRoadClipper(*map, region, options).run(result)) {
      result.reason = "no lanelet of the map reaches into the region";
    }
    return result;
  };
}

}  // namespace roadbed::map::edit::clipping
