#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/edit/clipping/clip.h"
#include "roadbed/map/edit/clipping/inside_stretches.h"
#include "roadbed/map/edit/new_ids.h"
#include "roadbed/map/edit/restored_references.h"
#include "roadbed/map/edit/road_cut.h"
#include "roadbed/map/edit/road_references.h"
#include "roadbed/map/edit/xml_edit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/opendrive/read.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

/// A road and its element, which may be removed or cut.
struct RoadElement {
  const opendrive::RoadRecord* record;
  pugi::xml_node node;
};

class RoadClipper {
 public:
  /// @param fresh  ids that no road of the map has.
  RoadClipper(pugi::xml_node root, const Eigen::Vector2d& origin_in_source, const FreshIds& fresh,
              const Region& region, const ClipOptions& options)
      : root_(root),
        origin_in_source_(origin_in_source),
        region_(region),
        options_(options),
        fresh_(fresh) {}

  /// Whether anything is left.
  /// @param far  how many roads more there are, outside.
  bool run(const std::vector<RoadElement>& roads, std::size_t far, Edited& result) {
    outside_ = far;
    for (const auto road : root_.children("road")) last_ = road;
    for (const RoadElement& road : roads) clip_road(*road.record, road.node);
    for (const auto road : children(root_, "road")) {
      if (!judged_.contains(road)) root_.remove_child(road), ++unusable_;
    }
    if (whole_ + cut_ == 0) return false;
    restore_references(root_);
    const SettledReferences settled = settle_references(root_);
    result.count("roads kept whole", whole_);
    result.count("roads cut", cut_);
    result.count("parts of roads with an id of their own", parts_);
    result.count("roads outside, left out", outside_);
    result.count("roads without a usable reference line, left out", unusable_);
    result.count("roads that cannot be cut, kept whole", uncut_.size());
    if (!uncut_.empty()) {
      result.notes.push_back(
          fmt::format("not cut, for a lane section of one side (singleSide): road {}",
                      fmt::join(uncut_, ", ")));
    }
    result.count("objects across the border, put by for map merge", across_);
    result.count("road links taken off", settled.links);
    result.count("connections of junctions taken off", settled.connections);
    result.count("junctions without a connection, left out", settled.junctions);
    result.count("signals taken off controllers", settled.controls);
    result.count("references to signals and objects outside taken off", settled.references);
    return true;
  }

 private:
  void clip_road(const opendrive::RoadRecord& road, pugi::xml_node node) {
    judged_.insert(node);
    const std::vector<StationSpan> spans = stretches_inside(road, origin_in_source_, region_);
    if (spans.empty()) {
      if (node == last_) last_ = last_.previous_sibling();
      root_.remove_child(node);
      ++outside_;
      return;
    }
    const bool inside = spans.front().from_m <= 0.0 && spans.front().to_m >= road.length_m;
    if (inside || options_.whole || !can_be_cut(node)) {
      ++whole_;
      if (!inside && !options_.whole) uncut_.push_back(text(node, "id"));
      return;
    }
    ++cut_;
    for (std::size_t i = 1; i < spans.size(); ++i) {
      last_ = root_.insert_copy_after(node, last_);
      judged_.insert(last_);
      cut(last_, spans[i]);
      set_text(last_, "id", fresh_.fresh());  // its clip memory knows whose part it is
      ++parts_;
    }
    cut(node, spans.front());
  }

  void cut(pugi::xml_node road, const StationSpan& span) {
    cut_road(road, span.from_m, span.to_m);
    across_ += children(find_clip_memory(road).child("objects"), "object").size();
  }

  pugi::xml_node root_;
  const Eigen::Vector2d origin_in_source_;
  const Region& region_;
  const ClipOptions& options_;
  FreshIds fresh_;
  pugi::xml_node last_;  // behind which new roads stand
  std::set<pugi::xml_node> judged_;
  std::size_t whole_ = 0, cut_ = 0, across_ = 0, parts_ = 0, outside_ = 0, unusable_ = 0;
  std::vector<std::string> uncut_;  // their ids
};

struct OpenDriveMap {
  OpenDriveMap(std::string bytes, const std::string& name)
      : indent(indent_of(bytes)),
        xml(std::move(bytes), name),
        document(opendrive::read_document(xml)) {
    opendrive::mend(document);
    for (const auto road : xml.root().children("road")) fresh.take(text(road, "id"));
  }

  std::string indent;
  XmlDocument xml;
  opendrive::Document document;
  FreshIds fresh;  // ids that no road has
};

/// @param part   the map, or a copy of it.
/// @param roads  those of its roads that are in it.
Edited clip_part(const OpenDriveMap& map, pugi::xml_node part,
                 const std::vector<RoadElement>& roads, const Region& region,
                 const ClipOptions& options) {
  Edited result;
  RoadClipper clipper(part, map.document.origin_in_source, map.fresh, region, options);
  if (clipper.run(roads, map.document.roads.size() - roads.size(), result)) {
    result.bytes = text_of(part, map.indent, map.xml.size_bytes());
  } else {
    result.reason = "no road of the map reaches into the region";
  }
  return result;
}

std::size_t elements_of(pugi::xml_node node) {
  std::size_t count = 1;
  for (const pugi::xml_node child : node.children()) count += elements_of(child);
  return count;
}

/// Gives each region a copy of the map without the roads that are far away.
class PartCopier {
 public:
  explicit PartCopier(const OpenDriveMap& map) : map_(map) {
    std::vector<geometry::Box> boxes;
    for (const opendrive::RoadRecord& road : map.document.roads) {
      boxes.push_back(box_around(road, map.document.origin_in_source));
      roads_.emplace(road.node, elements_of(road.node));
      elements_ += roads_.at(road.node);
    }
    if (!boxes.empty()) tree_ = geometry::BoxTree(boxes);
    for (const auto road : map.xml.root().children("road")) last_ = road;
  }

  /// Elements of all roads, and of the copy of one of them.
  std::size_t elements() const { return elements_; }
  std::size_t elements_of_copy(const RoadElement& road) const {
    return roads_.at(road.record->node);
  }

  std::vector<RoadElement> copy(const Region& region, pugi::xml_document& part) const {
    std::set<pugi::xml_node> near{last_};  // behind the last road new ones stand
    if (tree_.size() > 0) {
      tree_.visit(region.bounds(),
                  [&](std::size_t i) { near.insert(map_.document.roads[i].node); });
    }
    std::map<pugi::xml_node, pugi::xml_node> copies;
    const pugi::xml_node root = map_.xml.root();
    for (const pugi::xml_node node : root.parent().children()) {
      if (node != root) {
        part.append_copy(node);
        continue;
      }
      pugi::xml_node copy = part.append_child(root.name());
      for (const auto attribute : root.attributes()) copy.append_copy(attribute);
      for (const pugi::xml_node child : root.children()) {
        const bool is_far = roads_.contains(child) && !near.contains(child);
        if (!is_far) copies[child] = copy.append_copy(child);
      }
    }
    std::vector<RoadElement> kept;
    for (const opendrive::RoadRecord& road : map_.document.roads) {
      const auto found = copies.find(road.node);
      if (found != copies.end()) kept.push_back({&road, found->second});
    }
    return kept;
  }

 private:
  const OpenDriveMap& map_;
  std::map<pugi::xml_node, std::size_t> roads_;  // and how many elements each has
  std::size_t elements_ = 0;
  pugi::xml_node last_;
  geometry::BoxTree tree_;  // of the document's roads
};

// A road of many lane sections that lies in many regions is looked through for each.
void refuse_endless_cuts(std::size_t cut, std::size_t of_roads, const std::string& name) {
  constexpr std::size_t enough = 10'000'000, for_each = 50;
  if (cut <= enough + for_each * of_roads) return;
  throw InputError(
      {.file = name,
       .found = fmt::format("roads of {} elements, {} of them in the parts so far", of_roads, cut),
       .needed = fmt::format("at most {}, and {} for each", enough, for_each),
       .remedy = "cut into fewer parts, or long roads into shorter ones"});
}

}  // namespace

Edited clip_open_drive(std::string bytes, const std::string& name, const Region& region,
                       const ClipOptions& options) {
  const OpenDriveMap map(std::move(bytes), name);
  std::vector<RoadElement> roads;
  for (const opendrive::RoadRecord& road : map.document.roads) roads.push_back({&road, road.node});
  return clip_part(map, map.xml.root(), roads, region, options);
}

Clipper open_drive_clipper(std::string bytes, const std::string& name, const ClipOptions& options) {
  const auto map = std::make_shared<const OpenDriveMap>(std::move(bytes), name);
  const auto copier = std::make_shared<const PartCopier>(*map);
  std::size_t cut = 0;
  return [map, copier, options, name, cut](const Region& region) mutable {
    pugi::xml_document part;
    const std::vector<RoadElement> roads = copier->copy(region, part);
    for (const RoadElement& road : roads) cut += copier->elements_of_copy(road);
    refuse_endless_cuts(cut, copier->elements(), name);
    return clip_part(*map, part.document_element(), roads, region, options);
  };
}

}  // namespace roadbed::map::edit::clipping
