#include "roadbed/map/opendrive/plan_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace roadbed::map::opendrive {
namespace {

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
constexpr double kFarthestM = 1e8, kMostTurningRad = 100.0;

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
      std::abs(piece.start.heading_rad) > 1e6 || piece.length_m > kLongestRoadM ||
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

}  // namespace

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
  if (!road.plan_pieces.empty()) check_length(road, document);
}

}  // namespace roadbed::map::opendrive
