#include "roadbed/map/edit/lanelet_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/edit/new_ids.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit {
namespace {

constexpr const char* kSpan = "roadbed-clip";
constexpr const char* kLinks = "roadbed-clip-links";
constexpr double kSameRow = 1e-9;  // rows of lanelets beside each other that differ less are one

pugi::xml_node memory(pugi::xml_node element, const char* name) {
  return element.find_child([&](pugi::xml_node child) {
    return child.type() == pugi::node_pi && std::string_view(child.name()) == name;
  });
}

void remember(pugi::xml_node element, const char* name, const std::string& value) {
  pugi::xml_node node = memory(element, name);
  if (!node) node = element.prepend_child(pugi::node_pi);
  node.set_name(name);
  node.set_value(value.c_str());
}

bool is_link(pugi::xml_node node) {
  constexpr std::array<std::string_view, 7> kNames = {"predecessor",   "successor", "adjacentLeft",
                                                      "adjacentRight", "stopLine",  "incoming",
                                                      "crossing"};
  return std::ranges::find(kNames, node.name()) != kNames.end();
}

std::vector<pugi::xml_node> links_of(pugi::xml_node element) {
  std::vector<pugi::xml_node> links;
  std::ranges::copy_if(element.children(), std::back_inserter(links), is_link);
  return links;
}

class Text : public pugi::xml_writer {
 public:
  void write(const void* data, std::size_t size) override {
    text.append(static_cast<const char*>(data), size);
  }
  std::string text;
};

std::string text_of_links(pugi::xml_node element) {
  Text links;
  for (const pugi::xml_node link : links_of(element)) {
    link.print(links, "", pugi::format_raw, pugi::encoding_utf8);
  }
  return std::move(links.text);
}

void put_back_links(pugi::xml_node element) {
  const pugi::xml_node found = memory(element, kLinks);
  if (!found) return;
  pugi::xml_document links;
  constexpr unsigned as_files =  // as XmlDocument reads them
      pugi::parse_full | pugi::parse_embed_pcdata | pugi::parse_fragment;
  if (!links.load_string(found.value(), as_files)) return;
  for (const pugi::xml_node link : links_of(element)) element.remove_child(link);
  pugi::xml_node behind = element.child("rightBound");
  for (const pugi::xml_node link : links_of(links)) {
    behind = behind ? element.insert_copy_after(link, behind) : element.append_copy(link);
  }
}

bool names_lanelet(pugi::xml_node link) {
  const std::string_view name = link.name();
  return name == "incomingLanelet" || name == "crossingLanelet" || name.starts_with("successors");
}

void rename_reference(pugi::xml_node link, const NameChanges& names) {
  const auto found = names.find(text(link, "ref"));
  if (found != names.end()) set_text(link, "ref", found->second);
}

std::size_t points_of(pugi::xml_node lanelet, const char* bound) {
  const auto points = lanelet.child(bound).children("point");
  return static_cast<std::size_t>(std::distance(points.begin(), points.end()));
}

// What a reference becomes: another id, or, empty, nothing.
struct Change {
  pugi::xml_node link;
  std::string to;
};

class LinkSettler {
 public:
  LinkSettler(const LaneletParts& parts, pugi::xml_node root, bool all)
      : parts_(parts), root_(root), all_(all) {}

  // Looks at all before it changes any.
  LostLinks run(const std::map<std::string, std::vector<LaneletPart>>& parts) {
    std::vector<std::pair<pugi::xml_node, std::vector<Change>>> lanelets, intersections;
    for (const auto& [whole, same] : parts) {
      for (const LaneletPart& part : same) lanelets.emplace_back(part.node, changes_of(part));
    }
    for (const pugi::xml_node node : root_.children("intersection")) {
      intersections.emplace_back(node, changes_of_intersection(node));
    }
    for (const auto& [node, changes] : lanelets) lost_.links += make(node, changes);
    for (const auto& [node, changes] : intersections) {
      make(node, changes);
      tidy_intersection(node);
    }
    return lost_;
  }

 private:
  // The part that has an end of a lanelet; null if it is not there.
  const LaneletPart* with_end(const std::string& id, bool start) const {
    const std::vector<LaneletPart>* found = parts_.of(id);
    if (found == nullptr) return nullptr;
    const LaneletPart& part = start ? found->front() : found->back();
    return (start ? part.span.starts() : part.span.ends()) ? &part : nullptr;
  }

  const LaneletPart* first_part(const std::string& id) const {
    const std::vector<LaneletPart>* found = parts_.of(id);
    return found == nullptr ? nullptr : &found->front();
  }

  // The part of an adjacent lanelet that is as long as this one.
  const LaneletPart* beside(const std::string& id, const LaneletSpan& span,
                            bool same_direction) const {
    const std::vector<LaneletPart>* found = parts_.of(id);
    if (found == nullptr) return nullptr;
    const double from = same_direction ? span.from : span.last_row() - span.to;
    const double to = same_direction ? span.to : span.last_row() - span.from;
    const auto other =
        std::lower_bound(found->begin(), found->end(), from - kSameRow,
                         [](const LaneletPart& one, double row) { return one.span.from < row; });
    if (other == found->end()) return nullptr;
    const bool is_as_long = other->span.rows == span.rows &&
                            std::abs(other->span.from - from) < kSameRow &&
                            std::abs(other->span.to - to) < kSameRow;
    return is_as_long || (other->span.is_whole() && span.is_whole()) ? &*other : nullptr;
  }

  const LaneletPart* target(const LaneletPart& part, pugi::xml_node link) const {
    const std::string_view name = link.name();
    const std::string id = text(link, "ref");
    if (name == "predecessor") return part.span.starts() ? with_end(id, false) : nullptr;
    if (name == "successor") return part.span.ends() ? with_end(id, true) : nullptr;
    return beside(id, part.span, commonroad::is_same_direction(link));
  }

  // Whether another lanelet names the one that a part is of.
  static bool is_named_by(const LaneletPart& part, pugi::xml_node link, const LaneletPart& other) {
    const auto back = other.node.children(commonroad::counterpart(link));
    return std::any_of(back.begin(), back.end(),
                       [&](pugi::xml_node one) { return text(one, "ref") == part.span.whole; });
  }

  std::vector<Change> changes_of(const LaneletPart& part) const {
    std::vector<Change> changes;
    for (const pugi::xml_node link : links_of(part.node)) {
      if (std::string_view(link.name()) == "stopLine") {
        if (!part.span.ends()) changes.push_back({link, {}});
        continue;
      }
      const LaneletPart* to = target(part, link);
      if (to != nullptr && to->source != part.source && !is_named_by(part, link, *to)) to = nullptr;
      add_change(part.node, link, to, changes);
    }
    return changes;
  }

  std::vector<Change> changes_of_intersection(pugi::xml_node intersection) const {
    std::vector<Change> changes;
    for (const pugi::xml_node member : links_of(intersection)) {
      for (const pugi::xml_node link : member.children()) {
        const std::string_view name = link.name();
        if (name == "incomingLanelet") {
          add_change(intersection, link, with_end(text(link, "ref"), false), changes);
        } else if (name.starts_with("successors")) {
          add_change(intersection, link, with_end(text(link, "ref"), true), changes);
        } else if (name == "crossingLanelet") {
          add_change(intersection, link, first_part(text(link, "ref")), changes);
        }
      }
    }
    return changes;
  }

  void add_change(pugi::xml_node element, pugi::xml_node link, const LaneletPart* to,
                  std::vector<Change>& changes) const {
    if (to != nullptr && text(link, "ref") == text(to->node, "id")) return;
    if (to != nullptr) return changes.push_back({link, text(to->node, "id")});
    if (all_ || memory(element, kLinks)) changes.push_back({link, {}});
  }

  // Returns how many it takes off.
  static std::size_t make(pugi::xml_node element, const std::vector<Change>& changes) {
    if (changes.empty()) {
      element.remove_child(memory(element, kLinks));
      return 0;
    }
    remember(element, kLinks, text_of_links(element));
    std::size_t gone = 0;
    for (Change change : changes) {
      if (!change.to.empty()) {
        set_text(change.link, "ref", change.to);
        continue;
      }
      change.link.parent().remove_child(change.link);
      ++gone;
    }
    return gone;
  }

  // Takes off what has lost its lanelets.
  void tidy_intersection(pugi::xml_node node) {
    if (!memory(node, kLinks)) return;
    std::set<std::string> left;
    for (const pugi::xml_node incoming : children(node, "incoming")) {
      if (incoming.child("incomingLanelet")) {
        left.insert(text(incoming, "id"));
      } else {
        node.remove_child(incoming);
        ++lost_.incomings;
      }
    }
    for (pugi::xml_node incoming : children(node, "incoming")) {
      if (!left.contains(text(incoming.child("isLeftOf"), "ref")))
        incoming.remove_child("isLeftOf");
    }
    for (const pugi::xml_node crossing : children(node, "crossing")) {
      if (!crossing.child("crossingLanelet")) node.remove_child(crossing);
    }
    if (left.empty()) root_.remove_child(node);
  }

  const LaneletParts& parts_;
  pugi::xml_node root_;
  bool all_;
  LostLinks lost_;
};

}  // namespace

LaneletSpan all_rows(pugi::xml_node lanelet) {
  const std::size_t rows = points_of(lanelet, "leftBound");
  return {{0.0, static_cast<double>(rows) - 1.0, rows}, text(lanelet, "id")};
}

std::optional<LaneletSpan> remembered_span(pugi::xml_node lanelet) {
  const pugi::xml_node found = memory(lanelet, kSpan);
  if (!found) return {};
  pugi::xml_document cut;
  cut.load_string(fmt::format("<cut {}/>", found.value()).c_str());
  const pugi::xml_node said = cut.document_element();
  const LaneletSpan span{
      {number(said, "from"), number(said, "to"), said.attribute("rows").as_ullong()},
      text(said, "lanelet")};
  const bool fits = !span.whole.empty() && span.fits(points_of(lanelet, "leftBound")) &&
                    span.fits(points_of(lanelet, "rightBound"));
  return fits ? std::optional(span) : std::nullopt;
}

void remember_span(pugi::xml_node lanelet, const LaneletSpan& span) {
  if (span.is_whole()) {
    lanelet.remove_child(memory(lanelet, kSpan));
    return;
  }
  pugi::xml_document cut;
  pugi::xml_node said = cut.append_child("cut");
  set_text(said, "lanelet", span.whole);
  set_number(said, "from", span.from);
  set_number(said, "to", span.to);
  set_text(said, "rows", std::to_string(span.rows));
  Text text;
  said.print(text, "", pugi::format_raw, pugi::encoding_utf8);
  constexpr std::string_view kBegin = "<cut ", kEnd = "/>";
  remember(lanelet, kSpan,
           text.text.substr(kBegin.size(), text.text.size() - kBegin.size() - kEnd.size()));
}

void recall_links(pugi::xml_node root) {
  NameChanges wholes;  // of parts
  for (const pugi::xml_node lanelet : root.children("lanelet")) {
    if (const auto span = remembered_span(lanelet)) wholes[text(lanelet, "id")] = span->whole;
  }
  for (const pugi::xml_node lanelet : root.children("lanelet")) {
    put_back_links(lanelet);
    for (const pugi::xml_node link : links_of(lanelet)) rename_reference(link, wholes);
  }
  for (const pugi::xml_node intersection : root.children("intersection")) {
    put_back_links(intersection);
    for (const pugi::xml_node member : links_of(intersection)) {
      for (const pugi::xml_node link : member.children()) {
        if (names_lanelet(link)) rename_reference(link, wholes);
      }
    }
  }
}

void LaneletParts::add(LaneletPart part) {
  std::vector<LaneletPart>& same = parts_[part.span.whole];
  const auto before = [](const LaneletPart& a, const LaneletPart& b) {
    return a.span.from < b.span.from;
  };
  same.insert(std::upper_bound(same.begin(), same.end(), part, before), part);
}

const std::vector<LaneletPart>* LaneletParts::of(const std::string& whole) const {
  const auto found = parts_.find(whole);
  return found == parts_.end() ? nullptr : &found->second;
}

LostLinks LaneletParts::settle_links(pugi::xml_node root, bool all) const {
  return LinkSettler(*this, root, all).run(parts_);
}

}  // namespace roadbed::map::edit
