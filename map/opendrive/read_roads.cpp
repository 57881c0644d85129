#include "roadbed/map/opendrive/element_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <string_view>

#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/opendrive/budget.h"
#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive {
namespace {

// What a profile says from its first record on does not hold before it.
void remark_late_start(const std::vector<CubicElement>& listed, const RoadRecord& road,
                       const XmlDocument& xml, std::vector<ImportDiagnostic>& remarks) {
  if (listed.empty()) return;
  const auto& [node, first] = listed.front();
  if (!(first.s_m > kRoundingM) || std::abs(first.a) <= kRoundingM) return;
  remarks.push_back({"import.late-profile", true, "road " + road.id, xml.line_of(node),
                     fmt::format("<{}> begins at s {} m with {}; before it the value is 0, begin "
                                 "it at s 0",
                                 node.name(), first.s_m, first.a)});
}

geometry::PiecewiseCubic cubic_of(std::vector<geometry::CubicRecord> records) {
  sort_by_station(records);
  begin_at_zero(records);
  return geometry::PiecewiseCubic(std::move(records));
}

std::vector<geometry::CubicRecord> records_of(const std::vector<CubicElement>& listed) {
  std::vector<geometry::CubicRecord> records;
  for (const CubicElement& element : listed) records.push_back(element.record);
  return records;
}

void read_crossfall(AttributeReader& in, pugi::xml_node lateral, RoadRecord& road,
                    std::vector<ImportDiagnostic>& remarks) {
  std::vector<CubicElement> left, right;
  for (const auto node : lateral.children("crossfall")) {
    const std::string_view side = node.attribute("side").value();
    const CubicElement element{node, read_cubic(in, node, "s", 0.0)};
    if (side != "right") left.push_back(element);
    if (side != "left") right.push_back(element);
  }
  if (in.fault()) return;  // no map will ask
  remark_late_start(left, road, in.xml, remarks);
  if (left.empty() || right.empty() || left.front().node != right.front().node) {
    remark_late_start(right, road, in.xml, remarks);
  }
  road.crossfall_left = cubic_of(records_of(left));
  road.crossfall_right = cubic_of(records_of(right));
}

// Cubics over t, gathered by their station.
LateralShape read_shape(AttributeReader& in, pugi::xml_node lateral) {
  std::vector<std::pair<double, geometry::CubicRecord>> records;
  for (const auto node : lateral.children("shape")) {
    const double s_m = in.station_m(node, "s");
    records.emplace_back(s_m, read_cubic(in, node, "t", 0.0));
  }
  if (in.fault()) return {};  // no map will ask
  std::stable_sort(records.begin(), records.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first, a.second.s_m) < std::pair(b.first, b.second.s_m);
  });
  std::vector<LateralShape::Profile> profiles;
  for (auto from = records.begin(); from != records.end();) {
    const auto to = std::find_if(from, records.end(),
                                 [&](const auto& record) { return record.first != from->first; });
    std::vector<geometry::CubicRecord> over_t;
    std::transform(from, to, std::back_inserter(over_t), [](const auto& r) { return r.second; });
    profiles.push_back({from->first, geometry::PiecewiseCubic(std::move(over_t))});
    from = to;
  }
  return LateralShape(std::move(profiles));
}

std::vector<geometry::CubicRecord> read_coefficients(AttributeReader& in, pugi::xml_node parent) {
  std::vector<geometry::CubicRecord> records;
  for (const auto node : parent.children("coefficients")) {
    records.push_back({in.station_m(node, "s"), in.number_or(node, "a", 0.0),
                       in.number_or(node, "b", 0.0), in.number_or(node, "c", 0.0),
                       in.number_or(node, "d", 0.0)});
  }
  return records;
}

// A function of s; 0 if the numbers are broken, and no map will ask.
geometry::PiecewiseCubic read_function(AttributeReader& in, pugi::xml_node parent) {
  std::vector<geometry::CubicRecord> records = read_coefficients(in, parent);
  if (in.fault()) return {};
  return cubic_of(std::move(records));
}

SurfaceStrips::Strip read_strip(AttributeReader& in, pugi::xml_node strip) {
  SurfaceStrips::Strip made;
  made.is_there = static_cast<bool>(strip);
  constexpr std::array<const char*, 4> kFactors = {"constant", "linear", "quadratic", "cubic"};
  for (std::size_t k = 0; k < kFactors.size(); ++k) {
    made.factors[k] = read_function(in, strip.child(kFactors[k]));
  }
  made.width = read_function(in, strip.child("width"));
  made.is_relative = std::string_view(strip.attribute("mode").value()) == "relative";
  return made;
}

// An outer strip is none where the inner one has no width: nobody knows where it begins.
SurfaceStrips::Side read_strips(AttributeReader& in, pugi::xml_node strips, const char* inner,
                                const char* outer) {
  SurfaceStrips::Side side{read_strip(in, strips.find_child_by_attribute("strip", "id", inner)),
                           read_strip(in, strips.find_child_by_attribute("strip", "id", outer))};
  side.outer.is_there = side.outer.is_there && !side.inner.width.empty();
  return side;
}

SurfaceStrips read_cross_section(AttributeReader& in, pugi::xml_node surface) {
  const auto strips = surface.child("surfaceStrips");
  return {read_function(in, surface.child("tOffset")), read_strips(in, strips, "1", "2"),
          read_strips(in, strips, "-1", "-2")};
}

void read_profiles(AttributeReader& in, pugi::xml_node node, RoadRecord& road,
                   std::vector<ImportDiagnostic>& remarks) {
  const auto lateral = node.child("lateralProfile");
  road.elevation.listed = read_cubics(in, node.child("elevationProfile"), "elevation", "s", 0.0);
  road.superelevation.listed = read_cubics(in, lateral, "superelevation", "s", 0.0);
  read_lane_offset(in, node.child("lanes"), road);
  read_crossfall(in, lateral, road, remarks);
  road.shape = read_shape(in, lateral);
  road.strips = read_cross_section(in, lateral.child("crossSectionSurface"));
  for (const Profile* profile : {&road.elevation, &road.superelevation, &road.lane_offset}) {
    remark_late_start(profile->listed, road, in.xml, remarks);
  }
}

void read_speeds(AttributeReader& in, pugi::xml_node node, RoadRecord& road,
                 std::vector<ImportDiagnostic>& remarks) {
  for (const auto type : node.children("type")) {
    const double s_m = in.number_or(type, "s", 0.0);
    road.speeds.push_back({s_m, read_speed(in.xml, type.child("speed"), remarks)});
  }
}

void read_length(AttributeReader& in, RoadRecord& road) {
  road.length_m = in.number(road.node, "length");
  if (road.length_m > kLongestRoadM) {
    in.refuse(road.node, fmt::format("length {} m", road.length_m), "at most 1e6 m",
              "correct the length");
  }
}

void read_road(AttributeReader& in, RoadRecord& road, RoadNotes& notes) {
  const pugi::xml_node node = road.node;
  road.line = in.xml.line_of(node);
  road.name = node.attribute("name").value();
  read_length(in, road);
  const std::string_view junction = node.attribute("junction").value();
  if (junction != "-1") road.junction_id = junction;
  road.left_hand_traffic = std::string_view(node.attribute("rule").value()) == "LHT";
  road.predecessor = read_road_link(in, node.child("link").child("predecessor"));
  road.successor = read_road_link(in, node.child("link").child("successor"));
  read_speeds(in, node, road, notes.remarks);
  read_plan_view(in, road, notes);
  read_profiles(in, node, road, notes.remarks);
  read_lanes(in, node.child("lanes"), road, notes);
  read_signals(in, node.child("signals"), road, notes.remarks);
  read_objects(in, node.child("objects"), road, notes.remarks);
}

// Links could mean either of two roads of one id: only the first is taken. The rules look at the
// other, too; what it costs and what is wrong in it is not the map's.
void read_repeated(AttributeReader& in, RoadRecord& road, RoadNotes& notes) {
  notes.remarks.push_back({"import.duplicate-road", true, XmlDocument::place_of(road.node),
                           in.xml.line_of(road.node),
                           "has the id of a road before it and is left out, as links could "
                           "mean either; give it another id"});
  const std::size_t remarks = notes.remarks.size();
  in.set_aside([&] { read_road(in, road, notes); });
  notes.remarks.resize(remarks);
}

void read_listed(AttributeReader& in, RoadRecord& road, RoadNotes& notes) {
  in.text(road.node, "id");  // or it is a fault
  if (road.is_repeated) return read_repeated(in, road, notes);
  read_road(in, road, notes);
  if (is_usable(road)) return;
  notes.remarks.push_back({"import.no-geometry", true, "road " + road.id, road.line,
                           "has no plan view of positive length and is left out"});
}

// The roads, and how many lanes each may have.
std::vector<RoadNotes> list_roads(const XmlDocument& xml, Document& document) {
  std::vector<RoadNotes> notes;
  std::size_t lanes_left = most_lanes(xml.size_bytes());
  std::set<std::string_view> seen;
  for (const auto node : xml.root().children("road")) {
    RoadRecord& road = document.roads.emplace_back();
    road.node = node;
    road.id = node.attribute("id").value();
    road.is_repeated = !seen.insert(node.attribute("id").value()).second;
    notes.push_back({{}, lanes_left});
    const std::size_t lanes = count_lanes(node.child("lanes"));
    if (!road.is_repeated && lanes <= lanes_left) lanes_left -= lanes;
  }
  return notes;
}

}  // namespace

std::optional<RoadLink> read_road_link(AttributeReader& in, pugi::xml_node node) {
  if (!node) return {};
  RoadLink link;
  link.node = node;
  link.to_junction = std::string_view(node.attribute("elementType").value()) == "junction";
  link.element_id = node.attribute("elementId").value();
  const std::string_view contact = node.attribute("contactPoint").value();
  if (contact == "start") link.contact = ContactPoint::start;
  if (contact == "end") link.contact = ContactPoint::end;
  if (!link.contact && !link.to_junction)
    link.element_s_m = in.xml.optional_number(node, "elementS");
  link.element_forward = std::string_view(node.attribute("elementDir").value()) != "-";
  return link;
}

bool is_usable(const RoadRecord& road) {
  const auto has_length = [](const GeometryRecord& geometry) { return geometry.piece.has_value(); };
  return !road.is_repeated && road.length_m > 0.0 &&
         std::any_of(road.geometry.begin(), road.geometry.end(), has_length);
}

void read_roads(AttributeReader& in, Document& document, int threads) {
  std::vector<RoadNotes> notes = list_roads(in.xml, document);
  std::vector<std::optional<InputError>> faults(notes.size());
  in_threads(notes.size(), threads, [&](std::size_t i) {
    AttributeReader own(in.xml);
    read_listed(own, document.roads[i], notes[i]);
    faults[i] = own.fault();
  });
  for (std::size_t i = 0; i < notes.size(); ++i) {
    std::ranges::move(notes[i].remarks, std::back_inserter(document.remarks));
    if (faults[i]) in.keep(*std::move(faults[i]));
  }
  if (std::none_of(document.roads.begin(), document.roads.end(), is_usable)) {
    in.refuse(in.xml.root(), "no road with a geometry", "at least one road",
              "check whether the file is complete");
  }
}

}  // namespace roadbed::map::opendrive
