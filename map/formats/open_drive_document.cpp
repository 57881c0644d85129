#include "roadbed/map/formats/open_drive_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "roadbed/map/formats/open_drive_sections.h"
#include "roadbed/map/formats/open_drive_values.h"
#include "roadbed/map/input_error.h"

namespace roadbed::map::open_drive {
namespace {

void read_header(const XmlDocument& xml, Document& document) {
  const pugi::xml_node header = xml.root().child("header");
  const std::string major = header.attribute("revMajor").value();
  const std::string minor = header.attribute("revMinor").value();
  if (!major.empty() && major != "1") {
    xml.refuse(header, fmt::format("OpenDRIVE revision {}.{}", major, minor), "revision 1.4 to 1.8",
               "convert the file to a 1.x revision");
  }
  document.version = major.empty() ? "of unknown revision" : major + "." + minor;
  if (major.empty() || minor.empty()) {
    document.remarks.push_back({"import.version", true, "header", xml.line_of(header),
                                "revMajor or revMinor is missing; state the revision"});
  }
  std::string crs = header.child("geoReference").text().get();
  const auto first = crs.find_first_not_of(" \t\r\n");
  const auto last = crs.find_last_not_of(" \t\r\n");
  document.crs = first == std::string::npos ? "" : crs.substr(first, last - first + 1);
}

std::optional<RoadLink> read_road_link(pugi::xml_node node) {
  if (!node) return {};
  RoadLink link;
  link.to_junction = std::string_view(node.attribute("elementType").value()) == "junction";
  link.element_id = node.attribute("elementId").value();
  const std::string_view contact = node.attribute("contactPoint").value();
  if (contact == "start") link.contact = ContactPoint::start;
  if (contact == "end") link.contact = ContactPoint::end;
  return link;
}

geometry::PlanCurve read_curve(const XmlDocument& xml, pugi::xml_node geometry, double length_m) {
  if (const auto arc = geometry.child("arc")) {
    return geometry::ArcCurve{xml.number(arc, "curvature")};
  }
  if (const auto spiral = geometry.child("spiral")) {
    return geometry::SpiralCurve{xml.number(spiral, "curvStart"), xml.number(spiral, "curvEnd")};
  }
  if (const auto poly = geometry.child("poly3")) {
    return geometry::Poly3Curve{xml.number(poly, "a"), xml.number(poly, "b"), xml.number(poly, "c"),
                                xml.number(poly, "d")};
  }
  if (const auto poly = geometry.child("paramPoly3")) {
    const bool by_length = std::string_view(poly.attribute("pRange").value()) == "arcLength";
    return geometry::ParamPoly3Curve{{xml.number(poly, "aU"), xml.number(poly, "bU"),
                                      xml.number(poly, "cU"), xml.number(poly, "dU")},
                                     {xml.number(poly, "aV"), xml.number(poly, "bV"),
                                      xml.number(poly, "cV"), xml.number(poly, "dV")},
                                     by_length ? length_m : 1.0};
  }
  if (!geometry.child("line")) {
    xml.refuse(geometry, "no known curve", "line, arc, spiral, poly3 or paramPoly3",
               "describe the geometry by one of them");
  }
  return geometry::LineCurve{};
}

// Limits far beyond any road: a number past them is a slip, and would ask for endless points.
constexpr double kFarthestM = 1e8, kLongestM = 1e6, kMostTurningRad = 100.0;

void check_range(const XmlDocument& xml, pugi::xml_node node, const geometry::PlanPiece& piece) {
  const auto turning = [&](double curvature) { return std::abs(curvature) * piece.length_m; };
  double turning_rad = 0.0;
  if (const auto* arc = std::get_if<geometry::ArcCurve>(&piece.curve)) {
    turning_rad = turning(arc->curvature_per_m);
  } else if (const auto* spiral = std::get_if<geometry::SpiralCurve>(&piece.curve)) {
    turning_rad =
        std::max(turning(spiral->start_curvature_per_m), turning(spiral->end_curvature_per_m));
  }
  if (std::abs(piece.start.x_m) > kFarthestM || std::abs(piece.start.y_m) > kFarthestM ||
      std::abs(piece.start.heading_rad) > 1e6 || piece.length_m > kLongestM ||
      turning_rad > kMostTurningRad) {
    xml.refuse(node, "a place, length or curvature beyond that of any road",
               "|x|, |y| ≤ 1e8 m, length ≤ 1e6 m, turning ≤ 100 rad", "correct the values");
  }
}

// paramPoly3: its parameter is taken as proportional to s, so its length must be the stated one.
void check_param_poly3(const RoadRecord& road, const geometry::PlanPiece& piece, long line,
                       Document& document) {
  const auto* curve = std::get_if<geometry::ParamPoly3Curve>(&piece.curve);
  if (curve == nullptr) return;
  const double length_m = geometry::arc_length_m(*curve);
  if (std::abs(length_m - piece.length_m) > 1e-3 * std::max(1.0, piece.length_m)) {
    document.remarks.push_back(
        {"import.param-poly3-length", true, "road " + road.id, line,
         fmt::format("paramPoly3 is {:.4f} m long but its length says {:.4f} m; correct one",
                     length_m, piece.length_m)});
  }
}

// Shorter than this a piece has no direction of its own; leaving it out moves nothing.
constexpr double kShortestPieceM = 1e-9;

void read_plan_view(const XmlDocument& xml, pugi::xml_node node, RoadRecord& road,
                    Document& document) {
  for (const auto record : node.child("planView").children("geometry")) {
    const double length_m = xml.number(record, "length");
    if (length_m < kShortestPieceM) {
      document.remarks.push_back(
          {"import.zero-length", true, "road " + road.id, xml.line_of(record),
           fmt::format("geometry of length {} m is left out; remove it", length_m)});
      continue;
    }
    road.plan_pieces.push_back(
        {xml.number(record, "s"),
         length_m,
         {xml.number(record, "x"), xml.number(record, "y"), xml.number(record, "hdg")},
         read_curve(xml, record, length_m)});
    check_range(xml, record, road.plan_pieces.back());
    check_param_poly3(road, road.plan_pieces.back(), xml.line_of(record), document);
  }
  std::stable_sort(road.plan_pieces.begin(), road.plan_pieces.end(),
                   [](const auto& a, const auto& b) { return a.s_m < b.s_m; });
}

void check_length(const RoadRecord& road, Document& document) {
  const geometry::PlanPiece& last = road.plan_pieces.back();
  const double off_m = last.s_m + last.length_m - road.length_m;
  if (std::abs(off_m) > 0.01) {
    document.remarks.push_back(
        {"import.road-length", true, "road " + road.id, road.line,
         fmt::format("length is {} m but its plan view ends at {} m; correct one of them",
                     road.length_m, last.s_m + last.length_m)});
  }
}

void read_crossfall(const XmlDocument& xml, pugi::xml_node lateral, RoadRecord& road) {
  std::vector<geometry::CubicRecord> left, right;
  for (const auto node : lateral.children("crossfall")) {
    const std::string_view side = node.attribute("side").value();
    const geometry::CubicRecord record = read_cubic(xml, node, "s", 0.0);
    if (side != "right") left.push_back(record);
    if (side != "left") right.push_back(record);
  }
  road.crossfall_left = geometry::PiecewiseCubic(sorted(std::move(left)));
  road.crossfall_right = geometry::PiecewiseCubic(sorted(std::move(right)));
}

RoadRecord read_road(const XmlDocument& xml, pugi::xml_node node, Document& document) {
  RoadRecord road;
  road.line = xml.line_of(node);
  road.id = xml.text(node, "id");
  road.name = node.attribute("name").value();
  road.length_m = xml.number(node, "length");
  if (road.length_m > kLongestM) {
    xml.refuse(node, fmt::format("length {} m", road.length_m), "at most 1e6 m",
               "correct the length");
  }
  const std::string junction = node.attribute("junction").value();
  if (junction != "-1") road.junction_id = junction;
  road.left_hand_traffic = std::string_view(node.attribute("rule").value()) == "LHT";
  road.predecessor = read_road_link(node.child("link").child("predecessor"));
  road.successor = read_road_link(node.child("link").child("successor"));
  for (const auto type : node.children("type")) {
    road.speeds.push_back({xml.number_or(type, "s", 0.0), read_speed(xml, type.child("speed"))});
  }
  read_plan_view(xml, node, road, document);
  const auto lateral = node.child("lateralProfile");
  road.elevation = read_cubics(xml, node.child("elevationProfile"), "elevation", "s", 0.0);
  road.superelevation = read_cubics(xml, lateral, "superelevation", "s", 0.0);
  road.lane_offset = read_cubics(xml, node.child("lanes"), "laneOffset", "s", 0.0);
  read_crossfall(xml, lateral, road);
  road.sections = read_sections(xml, node.child("lanes"), road, document.remarks);
  return road;
}

void read_roads(const XmlDocument& xml, Document& document) {
  std::set<std::string> seen;
  for (const auto node : xml.root().children("road")) {
    RoadRecord road = read_road(xml, node, document);
    if (!seen.insert(road.id).second) {
      xml.refuse(node, fmt::format("a second road with id {}", road.id), "unique road ids",
                 "give one of them another id");
    }
    if (road.plan_pieces.empty() || !(road.length_m > 0.0)) {
      document.remarks.push_back({"import.no-geometry", true, "road " + road.id, road.line,
                                  "has no plan view of positive length and is left out"});
      continue;
    }
    check_length(road, document);
    document.roads.push_back(std::move(road));
  }
  if (document.roads.empty()) {
    xml.refuse(xml.root(), "no road with a geometry", "at least one road",
               "check whether the file is complete");
  }
}

JunctionConnection read_connection(const XmlDocument& xml, pugi::xml_node node) {
  JunctionConnection connection;
  connection.line = xml.line_of(node);
  connection.incoming_road = node.attribute("incomingRoad").value();
  connection.direct = !node.attribute("connectingRoad") && node.attribute("linkedRoad");
  connection.connecting_road =
      node.attribute(connection.direct ? "linkedRoad" : "connectingRoad").value();
  const std::string_view contact = node.attribute("contactPoint").value();
  connection.contact = contact == "end" ? ContactPoint::end : ContactPoint::start;
  for (const auto link : node.children("laneLink")) {
    connection.lane_links.emplace_back(xml.integer(link, "from"), xml.integer(link, "to"));
  }
  return connection;
}

void read_junctions(const XmlDocument& xml, Document& document) {
  for (const auto node : xml.root().children("junction")) {
    JunctionRecord junction{xml.text(node, "id"), node.attribute("name").value(), {}};
    for (const auto connection : node.children("connection")) {
      junction.connections.push_back(read_connection(xml, connection));
    }
    document.junctions.push_back(std::move(junction));
  }
}

SignalRecord read_signal(const XmlDocument& xml, pugi::xml_node node, const std::string& road_id) {
  SignalRecord signal;
  signal.id = node.attribute("id").value();
  signal.name = node.attribute("name").value();
  signal.road_id = road_id;
  signal.s_m = xml.number(node, "s");
  signal.t_m = xml.number_or(node, "t", 0.0);
  signal.country = node.attribute("country").value();
  signal.type = node.attribute("type").value();
  signal.subtype = node.attribute("subtype").value();
  signal.unit = node.attribute("unit").value();
  signal.value = xml.optional_number(node, "value");
  signal.dynamic = std::string_view(node.attribute("dynamic").value()) == "yes";
  signal.orientation = node.attribute("orientation").value();
  for (const auto validity : node.children("validity")) {
    signal.lane_ranges.emplace_back(xml.integer(validity, "fromLane"),
                                    xml.integer(validity, "toLane"));
  }
  return signal;
}

void read_signals(const XmlDocument& xml, Document& document) {
  for (const auto road : xml.root().children("road")) {
    const std::string road_id = road.attribute("id").value();
    for (const auto node : road.child("signals").children("signal")) {
      document.signals.push_back(read_signal(xml, node, road_id));
    }
  }
}

// Elements that are read; what else the file holds is counted, not silently dropped.
const std::set<std::string_view>& used_elements() {
  static const std::set<std::string_view> used = {"header",
                                                  "geoReference",
                                                  "offset",
                                                  "road",
                                                  "link",
                                                  "predecessor",
                                                  "successor",
                                                  "type",
                                                  "speed",
                                                  "planView",
                                                  "geometry",
                                                  "line",
                                                  "arc",
                                                  "spiral",
                                                  "poly3",
                                                  "paramPoly3",
                                                  "elevationProfile",
                                                  "elevation",
                                                  "lateralProfile",
                                                  "superelevation",
                                                  "crossfall",
                                                  "lanes",
                                                  "laneOffset",
                                                  "laneSection",
                                                  "left",
                                                  "center",
                                                  "right",
                                                  "lane",
                                                  "width",
                                                  "border",
                                                  "roadMark",
                                                  "height",
                                                  "junction",
                                                  "connection",
                                                  "laneLink",
                                                  "signals",
                                                  "signal",
                                                  "validity",
                                                  "objects",
                                                  "OpenDRIVE"};
  return used;
}

struct UnusedCounter : pugi::xml_tree_walker {
  std::map<std::string, std::pair<long, pugi::xml_node>> count;
  bool for_each(pugi::xml_node& node) override {
    if (node.type() != pugi::node_element || used_elements().contains(node.name())) return true;
    auto& [times, first] = count[node.name()];
    if (times++ == 0) first = node;
    return true;
  }
};

void count_unused(const XmlDocument& xml, Document& document) {
  UnusedCounter counter;
  pugi::xml_node root = xml.root();
  root.traverse(counter);
  for (const auto& [name, found] : counter.count) {
    document.remarks.push_back({"import.unused-element", false, "<" + name + ">",
                                xml.line_of(found.second),
                                fmt::format("{} × <{}> not used", found.first, name)});
  }
}

// Far from the file's origin coordinates are kept relative to a place near the map, so that
// products of them stay exact to far below a millimetre.
void move_to_local_origin(Document& document) {
  constexpr double far_m = 20'000.0, grid_m = 1'000.0;
  const geometry::Pose2 first = document.roads.front().plan_pieces.front().start;
  if (std::abs(first.x_m) < far_m && std::abs(first.y_m) < far_m) return;
  document.origin_in_source = {grid_m * std::round(first.x_m / grid_m),
                               grid_m * std::round(first.y_m / grid_m)};
  for (RoadRecord& road : document.roads) {
    for (geometry::PlanPiece& piece : road.plan_pieces) {
      piece.start.x_m -= document.origin_in_source.x();
      piece.start.y_m -= document.origin_in_source.y();
    }
  }
}

}  // namespace

bool is_open_drive(const std::string& root_element) {
  const auto colon = root_element.find(':');
  return root_element.substr(colon == std::string::npos ? 0 : colon + 1) == "OpenDRIVE";
}

Document read_document(const XmlDocument& xml) {
  Document document;
  read_header(xml, document);
  read_roads(xml, document);
  read_junctions(xml, document);
  read_signals(xml, document);
  count_unused(xml, document);
  move_to_local_origin(document);
  return document;
}

}  // namespace roadbed::map::open_drive
