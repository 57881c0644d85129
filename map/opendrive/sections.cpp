#include "roadbed/map/opendrive/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "roadbed/map/opendrive/marks.h"
#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive {
namespace {

template <typename Record>
void sort_by_station(std::vector<Record>& records) {
  const auto earlier = [](const Record& a, const Record& b) { return a.s_m < b.s_m; };
  if (!std::is_sorted(records.begin(), records.end(), earlier)) {
    std::stable_sort(records.begin(), records.end(), earlier);
  }
}

class LaneReader {
 public:
  LaneReader(const XmlDocument& xml, double section_s_m, std::vector<ImportRemark>& remarks)
      : xml_(xml), section_s_m_(section_s_m), remarks_(remarks) {}

  LaneRecord read(pugi::xml_node node) {
    LaneRecord lane;
    lane.id = xml_.integer(node, "id");
    lane.type = lane_type(node.attribute("type").value());
    lane.direction = node.attribute("direction").value();
    lane.level = is_true(node.attribute("level").value());
    lane.line = xml_.line_of(node);
    // What the model has no words for.
    keep_attributes(node, {"advisory", "dynamicLaneDirection", "dynamicLaneType", "roadWorks"},
                    lane.attributes);
    widths_.clear();
    borders_.clear();
    rules_.clear();
    for (const auto child : node.children()) read_child(child, lane);
    lane.attributes.insert(lane.attributes.end(), rules_.begin(), rules_.end());
    lane.width = geometry::PiecewiseCubic(sorted(widths_));
    if (lane.width.empty()) lane.border = read_borders();
    sort_by_station(lane.marks);
    sort_by_station(lane.speeds);
    sort_by_station(lane.heights);
    sort_by_station(lane.accesses);
    return lane;
  }

 private:
  void read_child(pugi::xml_node child, LaneRecord& lane) {
    const std::string_view name = child.name();
    if (name == "width") {
      widths_.push_back(read_cubic(xml_, child, "sOffset", section_s_m_));
    } else if (name == "border") {
      borders_.push_back(child);
    } else if (name == "roadMark") {
      lane.marks.push_back(read_mark(xml_, child, lane.id, station(child)));
    } else if (name == "link") {
      if (lane.predecessors.empty()) lane.predecessors = ids(child, "predecessor");
      if (lane.successors.empty()) lane.successors = ids(child, "successor");
    } else if (name == "speed") {
      lane.speeds.push_back({station(child), read_speed(xml_, child, remarks_)});
    } else if (name == "height") {
      lane.heights.push_back({station(child), xml_.number_or(child, "inner", 0.0),
                              xml_.number_or(child, "outer", 0.0)});
    } else if (name == "access") {
      read_access(child, lane);
    } else if (name == "material") {
      lane.attributes.emplace_back("material", described(child));
    } else if (name == "rule") {
      rules_.emplace_back("rule", described(child));
    }
  }

  geometry::PiecewiseCubic read_borders() const {
    std::vector<geometry::CubicRecord> records;
    for (const auto node : borders_) {
      records.push_back(read_cubic(xml_, node, "sOffset", section_s_m_));
    }
    return geometry::PiecewiseCubic(sorted(std::move(records)));
  }

  double station(pugi::xml_node record) const {
    return section_s_m_ + xml_.number_or(record, "sOffset", 0.0);
  }

  std::vector<int> ids(pugi::xml_node link, const char* name) const {
    std::vector<int> ids;
    for (const auto node : link.children(name)) ids.push_back(xml_.integer(node, "id"));
    return ids;
  }

  // Up to 1.7 the restriction is an attribute, from 1.8 on child elements.
  void read_access(pugi::xml_node access, LaneRecord& lane) const {
    const bool allow = std::string_view(access.attribute("rule").value()) == "allow";
    const double s_m = station(access);
    if (const auto word = access.attribute("restriction")) {
      lane.accesses.push_back({s_m, allow, word.value()});
    }
    for (const auto restriction : access.children("restriction")) {
      lane.accesses.push_back({s_m, allow, restriction.attribute("type").value()});
    }
  }

  const XmlDocument& xml_;
  double section_s_m_;
  std::vector<ImportRemark>& remarks_;
  // Of the lane that is being read.
  std::vector<geometry::CubicRecord> widths_;
  std::vector<pugi::xml_node> borders_;
  Attributes rules_;
};

LaneSection read_section(const XmlDocument& xml, pugi::xml_node node, Document& document) {
  LaneSection section;
  section.s_m = xml.number(node, "s");
  section.line = xml.line_of(node);
  section.single_side = is_true(node.attribute("singleSide").value());
  LaneReader reader(xml, section.s_m, document.remarks);
  for (const char* side : {"left", "center", "right"}) {
    for (const auto child : node.child(side).children("lane")) {
      if (document.lanes_left-- == 0) {
        xml.refuse(child, "more lanes than a map of this size can hold", "fewer lane sections",
                   "check whether the file is whole");
      }
      LaneRecord lane = reader.read(child);
      const int id = lane.id;
      if (!section.lanes.emplace(id, std::move(lane)).second) {
        document.remarks.push_back({"import.duplicate-lane", true, XmlDocument::place_of(child),
                                    xml.line_of(child),
                                    "has the id of a lane before it in its section and is left "
                                    "out; give it another id"});
      }
    }
  }
  return section;
}

bool speaks_of(const LaneSection& section, int sign) {
  if (!section.single_side) return true;
  const auto& lanes = section.lanes;
  return !lanes.empty() && (sign > 0 ? lanes.rbegin()->first > 0 : lanes.begin()->first < 0);
}

}  // namespace

void connect_sections(std::vector<LaneSection>& sections) {
  for (const int sign : {1, -1}) {
    std::size_t before = sections.size();
    for (std::size_t i = 0; i < sections.size(); ++i) {
      (sign > 0 ? sections[i].before_left : sections[i].before_right) = before;
      if (speaks_of(sections[i], sign)) before = i;
    }
    std::size_t next = sections.size();
    for (std::size_t i = sections.size(); i-- > 0;) {
      (sign > 0 ? sections[i].next_left : sections[i].next_right) = next;
      if (speaks_of(sections[i], sign)) next = i;
    }
  }
}

std::vector<LaneSection> read_sections(const XmlDocument& xml, pugi::xml_node lanes,
                                       const RoadRecord& road, Document& document) {
  const auto nodes = lanes.children("laneSection");
  std::vector<LaneSection> sections;
  sections.reserve(static_cast<std::size_t>(std::distance(nodes.begin(), nodes.end())));
  for (const auto node : nodes) sections.push_back(read_section(xml, node, document));
  sort_by_station(sections);
  connect_sections(sections);
  if (sections.empty()) {
    document.remarks.push_back({"import.no-lanes", true, "road " + road.id, road.line,
                                "has no lane section and gives no lane"});
  }
  return sections;
}

}  // namespace roadbed::map::opendrive
