#include "roadbed/map/formats/open_drive_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "roadbed/map/formats/open_drive_marks.h"
#include "roadbed/map/formats/open_drive_values.h"

namespace roadbed::map::open_drive {
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
    lane.predecessors = ids(node.child("link"), "predecessor");
    lane.successors = ids(node.child("link"), "successor");
    lane.width = read_cubics(xml_, node, "width", "sOffset", section_s_m_);
    if (lane.width.empty())
      lane.border = read_cubics(xml_, node, "border", "sOffset", section_s_m_);
    read_marks(node, lane);
    read_speeds(node, lane);
    read_heights(node, lane);
    read_accesses(node, lane);
    keep_words(node, lane);
    return lane;
  }

 private:
  double station(pugi::xml_node record) const {
    return section_s_m_ + xml_.number_or(record, "sOffset", 0.0);
  }

  std::vector<int> ids(pugi::xml_node link, const char* name) const {
    std::vector<int> ids;
    for (const auto node : link.children(name)) ids.push_back(xml_.integer(node, "id"));
    return ids;
  }

  void read_marks(pugi::xml_node node, LaneRecord& lane) const {
    for (const auto mark : node.children("roadMark")) {
      lane.marks.push_back(read_mark(xml_, mark, lane.id, station(mark)));
    }
    sort_by_station(lane.marks);
  }

  void read_speeds(pugi::xml_node node, LaneRecord& lane) {
    for (const auto speed : node.children("speed")) {
      lane.speeds.push_back({station(speed), read_speed(xml_, speed, remarks_)});
    }
    sort_by_station(lane.speeds);
  }

  void read_heights(pugi::xml_node node, LaneRecord& lane) const {
    for (const auto height : node.children("height")) {
      lane.heights.push_back({station(height), xml_.number_or(height, "inner", 0.0),
                              xml_.number_or(height, "outer", 0.0)});
    }
    sort_by_station(lane.heights);
  }

  // Up to 1.7 the restriction is an attribute, from 1.8 on child elements.
  void read_accesses(pugi::xml_node node, LaneRecord& lane) const {
    for (const auto access : node.children("access")) {
      const bool allow = std::string_view(access.attribute("rule").value()) == "allow";
      const double s_m = station(access);
      if (const auto word = access.attribute("restriction")) {
        lane.accesses.push_back({s_m, allow, word.value()});
      }
      for (const auto restriction : access.children("restriction")) {
        lane.accesses.push_back({s_m, allow, restriction.attribute("type").value()});
      }
    }
    sort_by_station(lane.accesses);
  }

  // What the model has no words for.
  void keep_words(pugi::xml_node node, LaneRecord& lane) const {
    keep_attributes(node, {"advisory", "dynamicLaneDirection", "dynamicLaneType", "roadWorks"},
                    lane.attributes);
    for (const auto child : node.children("material")) {
      lane.attributes.emplace_back("material", described(child));
    }
    for (const auto child : node.children("rule")) {
      lane.attributes.emplace_back("rule", described(child));
    }
  }

  const XmlDocument& xml_;
  double section_s_m_;
  std::vector<ImportRemark>& remarks_;
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
        xml.refuse(child, fmt::format("a second lane {} in one lane section", id),
                   "unique lane ids within a section", "give one of them another id");
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

}  // namespace roadbed::map::open_drive
