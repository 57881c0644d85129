#include "roadbed/map/opendrive/element_readers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace roadbed::map::opendrive {
namespace {

// Elements that are read, with those of their children that are. Names under different parents
// that have no children of their own share an empty entry.
struct Known {
  std::string_view name;
  std::array<std::string_view, 12> children;
};

constexpr std::array<Known, 38> kKnown = {{
    {"OpenDRIVE", {"road", "junction", "controller", "header"}},
    {"header", {"geoReference", "offset"}},
    {"road",
     {"link", "type", "planView", "elevationProfile", "lateralProfile", "lanes", "objects",
      "signals"}},
    {"link", {"predecessor", "successor"}},
    {"type", {"speed"}},
    {"planView", {"geometry"}},
    {"geometry", {"line", "arc", "spiral", "poly3", "paramPoly3"}},
    {"elevationProfile", {"elevation"}},
    {"lateralProfile", {"superelevation", "crossfall", "shape", "crossSectionSurface"}},
    {"crossSectionSurface", {"tOffset", "surfaceStrips"}},
    {"surfaceStrips", {"strip"}},
    {"strip", {"width", "constant", "linear", "quadratic", "cubic"}},
    {"tOffset", {"coefficients"}},
    {"width", {"coefficients"}},
    {"constant", {"coefficients"}},
    {"linear", {"coefficients"}},
    {"quadratic", {"coefficients"}},
    {"cubic", {"coefficients"}},
    {"lanes", {"laneSection", "laneOffset"}},
    {"laneSection", {"left", "center", "right"}},
    {"left", {"lane"}},
    {"center", {"lane"}},
    {"right", {"lane"}},
    {"lane",
     {"width", "roadMark", "link", "speed", "height", "border", "access", "material", "rule"}},
    {"access", {"restriction"}},
    {"roadMark", {"type"}},
    {"objects", {"object", "objectReference", "bridge", "tunnel"}},
    {"object", {"outline", "outlines", "repeat", "validity", "parkingSpace", "material"}},
    {"outlines", {"outline"}},
    {"outline", {"cornerLocal", "cornerRoad"}},
    {"bridge", {"validity"}},
    {"tunnel", {"validity"}},
    {"signals", {"signal", "signalReference"}},
    {"signal", {"validity", "dependency", "reference", "positionInertial", "positionRoad"}},
    {"signalReference", {"validity"}},
    {"controller", {"control"}},
    {"junction", {"connection", "priority", "controller"}},
    {"connection", {"laneLink", "predecessor", "successor"}},
}};

constexpr std::size_t kNothing = kKnown.size();  // reads no child

// Elements whose children depend on where they stand: a road's <type> has a <speed>, a road
// mark's does not; a junction's <controller> has no <control>.
std::size_t entry_of(std::string_view name, std::string_view parent) {
  if ((name == "type" && parent == "roadMark") || (name == "controller" && parent == "junction")) {
    return kNothing;
  }
  const auto found = std::find_if(kKnown.begin(), kKnown.end(),
                                  [&](const Known& known) { return known.name == name; });
  return static_cast<std::size_t>(found - kKnown.begin());
}

// For each entry the entries of its children, so that the walk compares a handful of names.
using Children = std::array<std::array<std::size_t, 12>, kKnown.size()>;

Children entries_of_children() {
  Children entries{};
  for (std::size_t i = 0; i < kKnown.size(); ++i) {
    for (std::size_t k = 0; k < kKnown[i].children.size(); ++k) {
      entries[i][k] = entry_of(kKnown[i].children[k], kKnown[i].name);
    }
  }
  return entries;
}

class Counter {
 public:
  // Not recursive: depth is the file's, not ours.
  void walk(pugi::xml_node root) {
    std::vector<std::pair<pugi::xml_node, std::size_t>> open{{root, 0}};
    while (!open.empty()) {
      const auto [node, entry] = open.back();
      open.pop_back();
      for (const auto child : node.children()) {
        if (child.type() != pugi::node_element) continue;
        const std::size_t of_child = known_child(entry, child.name());
        if (of_child == kUnknown) {
          ++count_[std::string(node.name()) + "/" + child.name()];
        } else if (child.first_child()) {
          open.emplace_back(child, of_child);
        }
      }
    }
  }

  std::vector<UnusedContent> take() const {
    std::vector<UnusedContent> unused;
    for (const auto& [name, count] : count_) unused.push_back({name, count});
    return unused;
  }

 private:
  static constexpr std::size_t kUnknown = SIZE_MAX;

  std::size_t known_child(std::size_t entry, std::string_view name) const {
    if (entry == kNothing || name.empty()) return kUnknown;
    const auto& children = kKnown[entry].children;
    const auto found = std::find(children.begin(), children.end(), name);
    if (found == children.end()) return kUnknown;
    return entries_[entry][static_cast<std::size_t>(found - children.begin())];
  }

  const Children entries_ = entries_of_children();
  std::map<std::string, std::size_t> count_;
};

}  // namespace

std::vector<UnusedContent> count_unused(const XmlDocument& xml) {
  Counter counter;
  counter.walk(xml.root());
  return counter.take();
}

}  // namespace roadbed::map::opendrive
