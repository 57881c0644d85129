#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/edit/clipping/clip.h"
#include "roadbed/map/edit/clipping/ladders.h"
#include "roadbed/map/edit/new_ids.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

class CommonRoadClipper {
 public:
  CommonRoadClipper(const commonroad::Document& document, const Region& region,
                    const ClipOptions& options)
      : root_(document.xml.root()),
        region_(region),
        found_(ladders_inside(document, region, options.whole)) {
    for (const auto one : root_.children()) fresh_.take(text(one, "id"));
  }

  bool run(Edited& result) {
    outside_ = found_.unusable.size();
    for (const auto lanelet : found_.unusable) root_.remove_child(lanelet);
    for (std::size_t i = 0; i < found_.ladders.size(); ++i) clip_lanelet(i);
    if (kept_.empty()) return false;
    for (const auto& [node, part] : kept_) settle_lanelet(node, part);
    settle_signs("trafficSign", "trafficSignRef");
    settle_signs("trafficLight", "trafficLightRef");
    settle_intersections();
    settle_scenario();
    result.count("lanelets kept whole", kept_.size() - cut_);
    result.count("lanelets cut", cut_);
    result.count("parts of lanelets with an id of their own", parts_);
    result.count("lanelets outside, left out", outside_);
    result.count("links taken off", links_);
    result.count("traffic signs and lights left out", signs_);
    result.count("incomings of intersections left out", incomings_);
    result.count("obstacles outside, left out", obstacles_);
    result.count("planning problems that begin or end outside, left out", problems_);
    return true;
  }

 private:
  /// A part of a lanelet that is there.
  struct Part {
    std::size_t ladder = 0, index = 0;  ///< index: of its group's spans
    double from = 0.0, to = 0.0;        ///< rows of the whole lanelet
    std::string id;
  };

  const Ladder& ladder_of(const Part& part) const { return found_.ladders[part.ladder]; }

  void clip_lanelet(std::size_t index) {
    const Ladder& ladder = found_.ladders[index];
    const std::vector<Span>& spans = found_.spans[ladder.group];
    if (spans.empty()) {
      ++outside_;
      root_.remove_child(ladder.node);
      return;
    }
    const double last = ladder.last_row();
    std::vector<Part> parts;
    for (std::size_t k = 0; k < spans.size(); ++k) {
      const double a = ladder.own_row(spans[k].from), b = ladder.own_row(spans[k].to);
      parts.push_back({index, k, std::min(a, b), std::max(a, b), ladder.id});
    }
    std::sort(parts.begin(), parts.end(),
              [](const Part& a, const Part& b) { return a.from < b.from; });
    cut_ += parts.size() > 1 || parts[0].from > 0.0 || parts[0].to < last ? 1 : 0;
    pugi::xml_node node = ladder.node;
    for (std::size_t k = 0; k < parts.size(); ++k) {
      const pugi::xml_node next =
          k + 1 < parts.size() ? root_.insert_copy_after(node, node) : pugi::xml_node();
      if (k > 0) {
        parts[k].id = fresh_.fresh();
        set_text(node, "id", parts[k].id);
        ++parts_;
      }
      if (parts[k].from > 0.0 || parts[k].to < last) cut(node, ladder, parts[k]);
      kept_.emplace_back(node, parts[k]);
      node = next;
    }
    parts_of_[ladder.id] = std::move(parts);
  }

  static void cut(pugi::xml_node node, const Ladder& ladder, const Part& part) {
    for (const char* bound : {"leftBound", "rightBound"}) {
      cut_bound(node.child(bound), part.from, part.to);
    }
    pugi::xml_node memory = node.prepend_child(pugi::node_pi);
    memory.set_name("roadbed-clip");
    memory.set_value(fmt::format("lanelet=\"{}\" from=\"{}\" to=\"{}\" rows=\"{}\"", ladder.id,
                                 part.from, part.to, ladder.left.size())
                         .c_str());
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

  // The part that has an end of a lanelet; null if it is not there.
  const Part* with_end(const std::string& id, bool start) const {
    const auto found = parts_of_.find(id);
    if (found == parts_of_.end()) return nullptr;
    const Part& part = start ? found->second.front() : found->second.back();
    const double last = ladder_of(part).last_row();
    return (start ? part.from <= 0.0 : part.to >= last) ? &part : nullptr;
  }

  const Part* beside(const std::string& id, const Part& part) const {
    const auto found = parts_of_.find(id);
    if (found == parts_of_.end()) return nullptr;
    const bool together = ladder_of(found->second[0]).group == ladder_of(part).group;
    if (!together)
      return is_whole(part) && is_whole(found->second[0]) ? &found->second[0] : nullptr;
    const auto other = std::find_if(found->second.begin(), found->second.end(),
                                    [&](const Part& one) { return one.index == part.index; });
    return other == found->second.end() ? nullptr : &*other;
  }

  bool is_whole(const Part& part) const {
    return part.from <= 0.0 && part.to >= ladder_of(part).last_row();
  }

  template <typename Find>
  void settle_links(pugi::xml_node node, const char* name, const Find& find) {
    for (auto link : children(node, name)) {
      const Part* other = find(text(link, "ref"));
      if (other == nullptr) {
        node.remove_child(link);
        ++links_;
      } else {
        set_text(link, "ref", other->id);
      }
    }
  }

  void settle_lanelet(pugi::xml_node node, const Part& part) {
    const double last = ladder_of(part).last_row();
    const bool starts = part.from <= 0.0, ends = part.to >= last;
    settle_links(node, "predecessor",
                 [&](const std::string& id) { return starts ? with_end(id, false) : nullptr; });
    settle_links(node, "successor",
                 [&](const std::string& id) { return ends ? with_end(id, true) : nullptr; });
    for (const char* side : {"adjacentLeft", "adjacentRight"}) {
      settle_links(node, side, [&](const std::string& id) { return beside(id, part); });
    }
    if (!ends) node.remove_child("stopLine");
  }

  bool is_inside(pugi::xml_node position) const {
    const auto point = position.child("point");
    return region_.contains(
        {point.child("x").text().as_double(), point.child("y").text().as_double()});
  }

  // Signs and lights that a lanelet names, and those inside that none ever named.
  void settle_signs(const char* kind, const char* reference) {
    std::set<std::string> named;
    for (const auto& [node, part] : kept_) {
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

  void settle_intersections() {
    const auto first_part = [&](const std::string& id) -> const Part* {
      const auto found = parts_of_.find(id);
      return found == parts_of_.end() ? nullptr : &found->second.front();
    };
    const std::size_t links = links_;
    for (const auto intersection : children(root_, "intersection")) {
      pugi::xml_node node = intersection;
      std::set<std::string> left;
      for (auto incoming : children(node, "incoming")) {
        settle_links(incoming, "incomingLanelet",
                     [&](const std::string& id) { return with_end(id, false); });
        for (const char* way : {"successorsRight", "successorsStraight", "successorsLeft"}) {
          settle_links(incoming, way, [&](const std::string& id) { return with_end(id, true); });
        }
        if (incoming.child("incomingLanelet")) {
          left.insert(text(incoming, "id"));
        } else {
          node.remove_child(incoming);
          ++incomings_;
        }
      }
      for (auto incoming : children(node, "incoming")) {
        if (!left.contains(text(incoming.child("isLeftOf"), "ref")))
          incoming.remove_child("isLeftOf");
      }
      for (auto crossing : children(node, "crossing")) {
        settle_links(crossing, "crossingLanelet", first_part);
        if (!crossing.child("crossingLanelet")) node.remove_child(crossing);
      }
      if (left.empty()) root_.remove_child(node);
    }
    links_ = links;
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
        if (!parts_of_.contains(text(lanelet, "ref"))) return true;
      }
    }
    return false;
  }

  pugi::xml_node root_;
  const Region& region_;
  const LadderSpans found_;
  FreshIds fresh_;
  std::vector<std::pair<pugi::xml_node, Part>> kept_;
  std::map<std::string, std::vector<Part>> parts_of_;  // of each lanelet, from its start on
  std::size_t cut_ = 0, parts_ = 0, outside_ = 0, links_ = 0, signs_ = 0, incomings_ = 0,
              obstacles_ = 0, problems_ = 0;
};

}  // namespace

Clipper common_road_clipper(std::string bytes, const std::string& name,
                            const ClipOptions& options) {
  return [bytes = std::move(bytes), name, options](const Region& region) {
    const commonroad::Document document(bytes, name);
    Edited result;
    if (CommonRoadClipper(document, region, options).run(result)) {
      result.bytes = text_of(document.xml, indent_of(bytes));
    } else {
      result.reason = "no lanelet of the map reaches into the region";
    }
    return result;
  };
}

}  // namespace roadbed::map::edit::clipping
