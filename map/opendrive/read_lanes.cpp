#include "roadbed/map/opendrive/element_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include "roadbed/map/elements/outside_links.h"
#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive {
namespace {

class LaneReader {
 public:
  LaneReader(AttributeReader& in, double section_s_m, std::vector<ImportDiagnostic>& remarks)
      : in_(in), section_s_m_(section_s_m), remarks_(remarks) {}

  /// None if its id is no whole number.
  std::optional<LaneRecord> read(pugi::xml_node node, const char* side) {
    const std::optional<int> id = in_.integer(node, "id");
    if (!id) return {};
    std::optional<LaneRecord> made{std::in_place};
    LaneRecord& lane = *made;
    lane.node = node;
    lane.side = side;
    lane.id = *id;
    lane.type = lane_type(node.attribute("type").value());
    lane.direction = node.attribute("direction").value();
    lane.level = is_true(node.attribute("level").value());
    lane.line = in_.xml.line_of(node);
    // What the model has no words for.
    keep_attributes(node, {"advisory", "dynamicLaneDirection", "dynamicLaneType", "roadWorks"},
                    lane.attributes);
    borders_.clear();
    rules_.clear();
    for (const auto child : node.children()) read_child(child, lane);
    lane.attributes.insert(lane.attributes.end(), rules_.begin(), rules_.end());
    if (lane.width.listed.empty()) {
      read_borders(lane);
    } else if (!borders_.empty()) {  // do not hold beside widths, nor do their faults
      in_.set_aside([&] { read_borders(lane); });
    }
    return made;
  }

 private:
  void read_child(pugi::xml_node child, LaneRecord& lane) {
    const std::string_view name = child.name();
    if (name == "width") {
      lane.width.listed.push_back({child, read_cubic(in_, child, "sOffset", section_s_m_)});
    } else if (name == "border") {
      borders_.push_back(child);
    } else if (name == "roadMark") {
      lane.marks.push_back(read_mark(in_.xml, child, lane.id, station(child)));
    } else if (name == "link") {
      if (lane.predecessors.empty()) lane.predecessors = ids(child, "predecessor");
      if (lane.successors.empty()) lane.successors = ids(child, "successor");
    } else if (name == "speed") {
      const double s_m = station(child);
      lane.speeds.push_back({s_m, read_speed(in_.xml, child, remarks_)});
    } else if (name == "height") {
      lane.heights.push_back(
          {station(child), in_.number_or(child, "inner", 0.0), in_.number_or(child, "outer", 0.0)});
    } else if (name == "access") {
      read_access(child, lane);
    } else if (name == "material") {
      lane.attributes.emplace_back("material", described(child));
    } else if (name == "rule") {
      rules_.emplace_back("rule", described(child));
    }
  }

  void read_borders(LaneRecord& lane) {
    for (const auto node : borders_) {
      lane.border.listed.push_back({node, read_cubic(in_, node, "sOffset", section_s_m_)});
    }
  }

  double station(pugi::xml_node record) {
    return section_s_m_ + in_.number_or(record, "sOffset", 0.0);
  }

  std::vector<int> ids(pugi::xml_node link, const char* name) {
    std::vector<int> ids;
    for (const auto node : link.children(name)) {
      if (const auto id = in_.integer(node, "id")) ids.push_back(*id);
    }
    return ids;
  }

  // Up to 1.7 the restriction is an attribute, from 1.8 on child elements.
  void read_access(pugi::xml_node access, LaneRecord& lane) {
    const bool allow = std::string_view(access.attribute("rule").value()) == "allow";
    const double s_m = station(access);
    if (const auto word = access.attribute("restriction")) {
      lane.accesses.push_back({s_m, allow, word.value()});
    }
    for (const auto restriction : access.children("restriction")) {
      lane.accesses.push_back({s_m, allow, restriction.attribute("type").value()});
    }
  }

  AttributeReader& in_;
  double section_s_m_;
  std::vector<ImportDiagnostic>& remarks_;
  // Of the lane that is being read.
  std::vector<pugi::xml_node> borders_;
  Attributes rules_;
};

void add_lane(LaneRecord lane, const XmlDocument& xml, LaneSection& section, RoadNotes& notes) {
  if (section.find(lane.id) != nullptr) {
    notes.remarks.push_back({"import.duplicate-lane", true, XmlDocument::place_of(lane.node),
                             xml.line_of(lane.node),
                             "has the id of a lane before it in its section and is left out; "
                             "give it another id"});
  }
  const int id = lane.id;
  lane.place = static_cast<int>(section.lanes.size());
  section.lanes.emplace(id, std::move(lane));
}

constexpr std::array<const char*, 3> kSides = {"left", "center", "right"};

void read_section(AttributeReader& in, pugi::xml_node node, LaneSection& section,
                  RoadNotes& notes) {
  section.node = node;
  section.s_m = in.station_m(node, "s");
  section.line = in.xml.line_of(node);
  section.single_side = is_true(node.attribute("singleSide").value());
  LaneReader reader(in, section.s_m, notes.remarks);
  for (const char* side : kSides) {
    for (const auto child : node.child(side).children("lane")) {
      if (auto lane = reader.read(child, side)) {
        add_lane(*std::move(lane), in.xml, section, notes);
      }
    }
  }
}

// Calls `f` with each lane, until it is true. @returns that lane
template <typename F>
pugi::xml_node find_lane(pugi::xml_node lanes, const F& f) {
  for (const auto section : lanes.children("laneSection")) {
    for (const char* side : kSides) {
      for (const auto lane : section.child(side).children("lane")) {
        if (f(lane)) return lane;
      }
    }
  }
  return {};
}

// The first lane of a road that memory is not granted for; none if it is for all.
pugi::xml_node first_lane_beyond(std::size_t most_lanes, pugi::xml_node lanes) {
  return find_lane(lanes, [&](pugi::xml_node) { return most_lanes-- == 0; });
}

// The records in order of station; they are not needed one by one any more.
std::vector<geometry::CubicRecord> taken_in_order(Profile& profile) {
  std::vector<geometry::CubicRecord> records;
  records.reserve(profile.listed.size());
  for (const CubicElement& element : profile.listed) records.push_back(element.record);
  profile.listed = {};
  sort_by_station(records);
  return records;
}

void mend_profile(Profile& profile) {
  profile.cubic = geometry::PiecewiseCubic(taken_in_order(profile));
}

void mend_road_profile(Profile& profile) {
  std::vector<geometry::CubicRecord> records = taken_in_order(profile);
  begin_at_zero(records);
  profile.cubic = geometry::PiecewiseCubic(std::move(records));
}

void mend_lane(LaneRecord& lane) {
  mend_profile(lane.width);
  if (lane.width.cubic.empty()) mend_profile(lane.border);
  lane.border.listed = {};
  sort_by_station(lane.marks);
  sort_by_station(lane.speeds);
  sort_by_station(lane.heights);
  sort_by_station(lane.accesses);
}

// Where a clip cut a road, or took its link off, it says so (map/edit): lanes that end there lead
// to what is not in the file.
void mark_clipped_ends(pugi::xml_node node, RoadRecord& road) {
  const auto memory = node.find_child_by_attribute("userData", "code", "roadbed.clip");
  if (!memory || road.sections.empty()) return;
  const auto cut = memory.child("cut");
  const auto lost = [&](const char* link) {
    return memory.child("link").child(link) && !node.child("link").child(link);
  };
  const auto mark = [](LaneSection& section) {
    for (auto& [id, lane] : section.lanes) {
      lane.attributes.emplace_back(kSuccessorsOutside, "clipped");
      lane.attributes.emplace_back(kPredecessorsOutside, "clipped");
    }
  };
  if (cut.attribute("from").as_double() > 0.0 || lost("predecessor")) mark(road.sections.front());
  if (cut.attribute("to").as_double() < cut.attribute("length").as_double() || lost("successor")) {
    mark(road.sections.back());
  }
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

std::vector<std::reference_wrapper<const LaneRecord>> LaneSection::listed() const {
  std::vector<std::reference_wrapper<const LaneRecord>> list;
  list.reserve(lanes.size());
  for (const auto& [id, lane] : lanes) list.emplace_back(lane);
  std::sort(list.begin(), list.end(),
            [](const LaneRecord& a, const LaneRecord& b) { return a.place < b.place; });
  return list;
}

std::size_t count_lanes(pugi::xml_node lanes) {
  std::size_t count = 0;
  find_lane(lanes, [&](pugi::xml_node) {
    ++count;
    return false;
  });
  return count;
}

void read_lane_offset(AttributeReader& in, pugi::xml_node lanes, RoadRecord& road) {
  road.lane_offset.listed = read_cubics(in, lanes, "laneOffset", "s", 0.0);
}

void read_lanes(AttributeReader& in, pugi::xml_node lanes, RoadRecord& road, RoadNotes& notes) {
  if (const auto beyond = first_lane_beyond(notes.most_lanes, lanes)) {
    in.refuse(beyond, "more lanes than a map of this size can hold", "fewer lane sections",
              "check whether the file is whole");
    return;
  }
  const auto nodes = lanes.children("laneSection");
  road.sections.reserve(static_cast<std::size_t>(std::distance(nodes.begin(), nodes.end())));
  for (const auto node : nodes) read_section(in, node, road.sections.emplace_back(), notes);
  mark_clipped_ends(lanes.parent(), road);
  if (road.sections.empty()) {
    notes.remarks.push_back({"import.no-lanes", true, "road " + road.id, road.line,
                             "has no lane section and gives no lane"});
  }
}

void mend_road(RoadRecord& road) {
  sort_by_station(road.speeds);
  for (const GeometryRecord& geometry : road.geometry) {
    if (geometry.piece) road.plan_pieces.push_back(*geometry.piece);
  }
  road.geometry = {};
  sort_by_station(road.plan_pieces);
  for (Profile* profile : {&road.elevation, &road.superelevation, &road.lane_offset}) {
    mend_road_profile(*profile);
  }
  for (LaneSection& section : road.sections) {
    auto& lanes = section.lanes;
    for (auto lane = lanes.begin(); lane != lanes.end();) {
      const bool repeated = lane != lanes.begin() && std::prev(lane)->first == lane->first;
      if (!repeated) mend_lane(lane->second);
      lane = repeated ? lanes.erase(lane) : std::next(lane);
    }
  }
  sort_by_station(road.sections);
  connect_sections(road.sections);
}

}  // namespace roadbed::map::opendrive
