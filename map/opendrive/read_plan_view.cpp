#include "roadbed/map/opendrive/element_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "roadbed/map/files/coordinate_limits.h"

namespace roadbed::map::opendrive {
namespace {

std::optional<geometry::PlanCurve> read_curve(AttributeReader& in, pugi::xml_node geometry,
                                              double length_m) {
  const auto numbers = [&](pugi::xml_node node, const std::array<const char*, 4>& names) {
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < 4; ++i) values[i] = in.number(node, names[i]);
    return values;
  };
  if (const auto arc = geometry.child("arc"))
    return geometry::ArcCurve{in.number(arc, "curvature")};
  if (const auto spiral = geometry.child("spiral")) {
    return geometry::SpiralCurve{in.number(spiral, "curvStart"), in.number(spiral, "curvEnd")};
  }
  if (const auto poly = geometry.child("poly3")) {
    const auto [a, b, c, d] = numbers(poly, {"a", "b", "c", "d"});
    return geometry::Poly3Curve{a, b, c, d};
  }
  if (const auto poly = geometry.child("paramPoly3")) {
    const bool by_length = std::string_view(poly.attribute("pRange").value()) == "arcLength";
    return geometry::ParamPoly3Curve{numbers(poly, {"aU", "bU", "cU", "dU"}),
                                     numbers(poly, {"aV", "bV", "cV", "dV"}),
                                     by_length ? length_m : 1.0};
  }
  if (geometry.child("line")) return geometry::LineCurve{};
  in.refuse(geometry, "no known curve", "line, arc, spiral, poly3 or paramPoly3",
            "describe the geometry by one of them");
  return {};
}

bool has_broken_number(const geometry::PlanCurve& curve) {
  double sum = 0.0;
  if (const auto* arc = std::get_if<geometry::ArcCurve>(&curve)) sum = arc->curvature_per_m;
  if (const auto* spiral = std::get_if<geometry::SpiralCurve>(&curve)) {
    sum = spiral->start_curvature_per_m + spiral->end_curvature_per_m;
  }
  if (const auto* poly = std::get_if<geometry::Poly3Curve>(&curve)) {
    sum = poly->a + poly->b + poly->c + poly->d;
  }
  if (const auto* poly = std::get_if<geometry::ParamPoly3Curve>(&curve)) {
    for (const double value : poly->u) sum += value;
    for (const double value : poly->v) sum += value;
  }
  return !std::isfinite(sum);
}

// Limits far beyond any road: a number past them is a slip, and would ask for endless points.
constexpr double kMostTurningRad = 100.0;

/// A curve of a parameter may be far longer than its element says.
bool is_too_long(const geometry::ParamPoly3Curve& curve) {
  const double p = curve.p_end;
  double most_m = 0.0;  // a bound that costs nothing
  for (const auto* of : {&curve.u, &curve.v}) {
    const auto& [a, b, c, d] = *of;
    most_m += p * (std::abs(b) + p * (2.0 * std::abs(c) + 3.0 * p * std::abs(d)));
  }
  return !(most_m <= kLongestRoadM) && !(geometry::arc_length_m(curve) <= kLongestRoadM);
}

bool is_in_range(const geometry::PlanPiece& piece) {
  const auto turning = [&](double curvature) { return std::abs(curvature) * piece.length_m; };
  double turning_rad = 0.0;
  if (const auto* arc = std::get_if<geometry::ArcCurve>(&piece.curve)) {
    turning_rad = turning(arc->curvature_per_m);
  } else if (const auto* spiral = std::get_if<geometry::SpiralCurve>(&piece.curve)) {
    turning_rad =
        std::max(turning(spiral->start_curvature_per_m), turning(spiral->end_curvature_per_m));
  } else if (const auto* curve = std::get_if<geometry::ParamPoly3Curve>(&piece.curve)) {
    if (is_too_long(*curve)) return false;
  }
  return std::abs(piece.start.x_m) <= kFarthestM && std::abs(piece.start.y_m) <= kFarthestM &&
         std::abs(piece.start.heading_rad) <= 1e6 && piece.length_m <= kLongestRoadM &&
         turning_rad <= kMostTurningRad;
}

// paramPoly3: its parameter is taken as proportional to s, so its length must be the stated one.
void check_param_poly3(const RoadRecord& road, const geometry::PlanPiece& piece, long line,
                       RoadNotes& notes) {
  const auto* curve = std::get_if<geometry::ParamPoly3Curve>(&piece.curve);
  if (curve == nullptr) return;
  const double length_m = geometry::arc_length_m(*curve);
  if (std::abs(length_m - piece.length_m) > 1e-3 * std::max(1.0, piece.length_m)) {
    notes.remarks.push_back(
        {"import.param-poly3-length", true, "road " + road.id, line,
         fmt::format("paramPoly3 is {:.4f} m long but its length says {:.4f} m; correct one",
                     length_m, piece.length_m)});
  }
}

void check_length(const RoadRecord& road, RoadNotes& notes) {
  const geometry::PlanPiece* last = nullptr;
  for (const GeometryRecord& geometry : road.geometry) {
    if (geometry.piece && (!last || geometry.piece->s_m >= last->s_m)) last = &*geometry.piece;
  }
  if (last == nullptr) return;
  const double off_m = last->s_m + last->length_m - road.length_m;
  if (std::abs(off_m) > 0.01) {
    notes.remarks.push_back(
        {"import.road-length", true, "road " + road.id, road.line,
         fmt::format("length is {} m but its plan view ends at {} m; correct one of them",
                     road.length_m, last->s_m + last->length_m)});
  }
}

// The place and the curve of a geometry whose length is known; none if a number is broken.
std::optional<geometry::PlanPiece> read_piece(AttributeReader& in, const GeometryRecord& record) {
  const pugi::xml_node node = record.node;
  const geometry::Pose2 start{in.number(node, "x"), in.number(node, "y"), in.number(node, "hdg")};
  const auto curve = read_curve(in, node, record.length_m);
  if (!curve || std::isnan(record.s_m) || has_broken_number(*curve)) return {};
  const geometry::PlanPiece piece{record.s_m, record.length_m, start, *curve};
  if (is_in_range(piece)) return piece;
  in.refuse(node, "a place, length or curvature beyond that of any road",
            "|x|, |y| ≤ 1e8 m, length ≤ 1e6 m, turning ≤ 100 rad", "correct the values");
  return {};
}

}  // namespace

void read_plan_view(AttributeReader& in, RoadRecord& road, RoadNotes& notes) {
  for (const auto node : road.node.child("planView").children("geometry")) {
    GeometryRecord& record = road.geometry.emplace_back();
    record.node = node;
    record.length_m = in.number(node, "length");
    if (record.length_m < kShortestPieceM) {
      notes.remarks.push_back(
          {"import.zero-length", true, "road " + road.id, in.xml.line_of(node),
           fmt::format("geometry of length {} m is left out; remove it", record.length_m)});
      in.set_aside([&] { record.s_m = in.number(node, "s"); });
      continue;
    }
    record.s_m = in.station_m(node, "s");
    record.piece = read_piece(in, record);
    if (record.piece) check_param_poly3(road, *record.piece, in.xml.line_of(node), notes);
  }
  check_length(road, notes);
}

}  // namespace roadbed::map::opendrive
