#include <set>
#include <string>
#include <vector>

#include "roadbed/map/edit/clipping/clip.h"
#include "roadbed/map/edit/clipping/inside_stretches.h"
#include "roadbed/map/edit/new_ids.h"
#include "roadbed/map/edit/road_cut.h"
#include "roadbed/map/edit/road_references.h"
#include "roadbed/map/edit/xml_edit.h"
#include "roadbed/map/opendrive/read.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

class Clipper {
 public:
  Clipper(pugi::xml_node root, const opendrive::Document& document, const Region& region,
          const ClipOptions& options)
      : root_(root), document_(document), region_(region), options_(options) {
    for (const auto road : root.children("road")) fresh_.take(text(road, "id"));
  }

  // Whether anything is left.
  bool run(Edited& result) {
    for (const auto road : root_.children("road")) last_ = road;
    for (const opendrive::RoadRecord& road : document_.roads) clip_road(road);
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
    result.count("roads that cannot be cut, kept whole", uncut_);
    result.count("road links taken off", settled.links);
    result.count("connections of junctions taken off", settled.connections);
    result.count("junctions without a connection, left out", settled.junctions);
    result.count("signals taken off controllers", settled.controls);
    result.count("references to signals and objects outside taken off", settled.references);
    return true;
  }

 private:
  void clip_road(const opendrive::RoadRecord& road) {
    judged_.insert(road.node);
    const std::vector<StationSpan> spans =
        stretches_inside(road, document_.origin_in_source, region_);
    if (spans.empty()) {
      if (road.node == last_) last_ = last_.previous_sibling();
      root_.remove_child(road.node);
      ++outside_;
      return;
    }
    const bool inside = spans.front().from_m <= 0.0 && spans.front().to_m >= road.length_m;
    if (inside || options_.whole || !can_be_cut(road.node)) {
      ++whole_;
      uncut_ += inside || options_.whole ? 0 : 1;
      return;
    }
    ++cut_;
    for (std::size_t i = 1; i < spans.size(); ++i) {
      last_ = root_.insert_copy_after(road.node, last_);
      judged_.insert(last_);
      cut_road(last_, spans[i].from_m, spans[i].to_m);
      set_text(last_, "id", fresh_.fresh());  // its clip memory knows whose part it is
      ++parts_;
    }
    cut_road(road.node, spans.front().from_m, spans.front().to_m);
  }

  pugi::xml_node root_;
  const opendrive::Document& document_;
  const Region& region_;
  const ClipOptions& options_;
  FreshIds fresh_;
  pugi::xml_node last_;  // behind which new roads stand
  std::set<pugi::xml_node> judged_;
  std::size_t whole_ = 0, cut_ = 0, parts_ = 0, outside_ = 0, unusable_ = 0, uncut_ = 0;
};

}  // namespace

Edited clip_open_drive(std::string bytes, const std::string& name, const Region& region,
                       const ClipOptions& options) {
  const std::string indent = indent_of(bytes);
  const XmlDocument xml(std::move(bytes), name);
  opendrive::Document document = opendrive::read_document(xml);
  opendrive::mend(document);
  Edited result;
  if (Clipper(xml.root(), document, region, options).run(result)) {
    result.bytes = text_of(xml, indent);
  } else {
    result.reason = "no road of the map reaches into the region";
  }
  return result;
}

}  // namespace roadbed::map::edit::clipping
