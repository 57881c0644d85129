#include "roadbed/map/edit/plan_cut.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <variant>
#include <vector>

#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit {
namespace {

using Coefficients = std::array<double, 4>;

constexpr double kNoCurveM = 1e-9;  // a shorter piece of curve is none
constexpr std::array<const char*, 4> kU = {"aU", "bU", "cU", "dU"}, kV = {"aV", "bV", "cV", "dV"},
                                     kPoly = {"a", "b", "c", "d"};

Coefficients read(pugi::xml_node node, const std::array<const char*, 4>& names) {
  Coefficients values{};
  for (std::size_t i = 0; i < 4; ++i) values[i] = number(node, names[i]);
  return values;
}

void write(pugi::xml_node node, const std::array<const char*, 4>& names,
           const Coefficients& values) {
  for (std::size_t i = 0; i < 4; ++i) set_number(node, names[i], values[i]);
}

bool goes_by_length(pugi::xml_node poly) {
  return std::string_view(poly.attribute("pRange").value()) == "arcLength";
}

// The cubic about another place, from 0 there.
Coefficients from_place(const Coefficients& c, double at) {
  return {0.0, c[1] + at * (2.0 * c[2] + at * 3.0 * c[3]), c[2] + 3.0 * at * c[3], c[3]};
}

// By a parameter that runs so many times as fast.
Coefficients scaled(const Coefficients& c, double by) {
  return {c[0], c[1] * by, c[2] * by * by, c[3] * by * by * by};
}

void cut_spiral(pugi::xml_node spiral, double length_m, double from_m, double to_m) {
  const double start = number(spiral, "curvStart"), end = number(spiral, "curvEnd");
  const auto at = [&](double s_m) { return start + (end - start) * s_m / length_m; };
  if (from_m > 0.0) set_number(spiral, "curvStart", at(from_m));
  if (to_m < length_m) set_number(spiral, "curvEnd", at(to_m));
}

// Returns the pose of what is left.
geometry::Pose2 cut_poly3(pugi::xml_node poly, const geometry::PlanPiece& piece, double from_m) {
  const Eigen::Vector2d start = geometry::plan_point(piece, piece.s_m + from_m).pose.position();
  const double u = (piece.start.inverse() * start).x();
  write(poly, kPoly, from_place(read(poly, kPoly), u));
  return {start.x(), start.y(), piece.start.heading_rad};
}

geometry::Pose2 cut_param_poly3(pugi::xml_node poly, const geometry::PlanPiece& piece,
                                double from_m, double to_m) {
  const double range = goes_by_length(poly) ? piece.length_m : 1.0;
  const double from = range * from_m / piece.length_m;
  Coefficients u = read(poly, kU), v = read(poly, kV);
  geometry::Pose2 start = piece.start;
  if (from_m > 0.0) {
    u = from_place(u, from), v = from_place(v, from);
    const double turn = u[1] == 0.0 && v[1] == 0.0 ? 0.0 : std::atan2(v[1], u[1]);
    const double c = std::cos(turn), s = std::sin(turn);
    for (std::size_t i = 0; i < 4; ++i) {
      const double along = c * u[i] + s * v[i], across = c * v[i] - s * u[i];
      u[i] = along, v[i] = across;
    }
    v[1] = 0.0;
    const auto position = geometry::plan_point(piece, piece.s_m + from_m).pose.position();
    start = {position.x(), position.y(), piece.start.heading_rad + turn};
  }
  if (!goes_by_length(poly)) {
    const double share = (to_m - from_m) / piece.length_m;
    u = scaled(u, share), v = scaled(v, share);
  }
  write(poly, kU, u);
  write(poly, kV, v);
  return start;
}

}  // namespace

void cut_geometry(pugi::xml_node geometry, double from_m, double to_m) {
  const geometry::PlanPiece piece = plan_piece(geometry);
  geometry::Pose2 start = geometry::plan_point(piece, piece.s_m + from_m).pose;
  if (const auto spiral = geometry.child("spiral")) {
    cut_spiral(spiral, piece.length_m, from_m, to_m);
  } else if (const auto poly = geometry.child("poly3")) {
    if (from_m > 0.0) start = cut_poly3(poly, piece, from_m);
  } else if (const auto param = geometry.child("paramPoly3")) {
    start = cut_param_poly3(param, piece, from_m, to_m);
  }
  if (from_m > 0.0) {
    set_number(geometry, "x", start.x_m);
    set_number(geometry, "y", start.y_m);
    set_number(geometry, "hdg", start.heading_rad);
  }
  set_number(geometry, "length", to_m - from_m);
}

geometry::PlanPiece plan_piece(pugi::xml_node geometry) {
  geometry::PlanPiece piece{number(geometry, "s"),
                            number(geometry, "length"),
                            {number(geometry, "x"), number(geometry, "y"), number(geometry, "hdg")},
                            {}};
  if (const auto arc = geometry.child("arc")) {
    piece.curve = geometry::ArcCurve{number(arc, "curvature")};
  } else if (const auto spiral = geometry.child("spiral")) {
    piece.curve = geometry::SpiralCurve{number(spiral, "curvStart"), number(spiral, "curvEnd")};
  } else if (const auto poly = geometry.child("poly3")) {
    const auto [a, b, c, d] = read(poly, kPoly);
    piece.curve = geometry::Poly3Curve{a, b, c, d};
  } else if (const auto param = geometry.child("paramPoly3")) {
    piece.curve = geometry::ParamPoly3Curve{read(param, kU), read(param, kV),
                                            goes_by_length(param) ? piece.length_m : 1.0};
  }
  return piece;
}

geometry::Pose2 reference_pose(pugi::xml_node road, double s_m) {
  pugi::xml_node holding;
  for (const auto geometry : road.child("planView").children("geometry")) {
    if (number(geometry, "length") < kNoCurveM) continue;  // as those who read maps leave it out
    if (!holding || number(geometry, "s") <= s_m) holding = geometry;
  }
  return holding ? geometry::plan_point(plan_piece(holding), s_m).pose : geometry::Pose2{};
}

void cut_plan_view(pugi::xml_node plan_view, double from_m, double to_m) {
  std::vector<pugi::xml_node> records = children(plan_view, "geometry");
  std::stable_sort(records.begin(), records.end(),
                   [](auto a, auto b) { return number(a, "s") < number(b, "s"); });
  std::size_t left = records.size();
  for (const pugi::xml_node record : records) {
    const double begin_m = number(record, "s"), length_m = number(record, "length");
    const double first_m = std::max(from_m - begin_m, 0.0);
    const double last_m = std::min(to_m - begin_m, length_m);
    if (last_m - first_m < kNoCurveM && left > 1) {
      plan_view.remove_child(record);
      --left;
      continue;
    }
    if (first_m > 0.0 || last_m < length_m) cut_geometry(record, first_m, last_m);
    if (from_m > 0.0) set_number(record, "s", std::max(0.0, begin_m - from_m));
  }
}

pugi::xml_node geometry_across(pugi::xml_node plan_view, double s_m) {
  for (const auto geometry : plan_view.children("geometry")) {
    const double begin_m = number(geometry, "s");
    if (begin_m < s_m && s_m < begin_m + number(geometry, "length")) return geometry;
  }
  return {};
}

}  // namespace roadbed::map::edit
