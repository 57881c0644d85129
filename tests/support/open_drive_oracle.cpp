#include "roadbed/tests/support/open_drive_oracle.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <pugixml.hpp>
#include <stdexcept>
#include <vector>

namespace roadbed::tests {
namespace {

using Real = long double;

Real number(pugi::xml_node node, const char* name) {
  return std::strtold(node.attribute(name).value(), nullptr);
}

// The child of that name with the greatest station that is at or below `at`, else the first.
pugi::xml_node in_force(pugi::xml_node parent, const char* name, const char* station, Real at) {
  pugi::xml_node found = parent.child(name);
  for (const auto node : parent.children(name)) {
    if (number(node, station) <= at) found = node;
  }
  return found;
}

// The last listed one that starts at or below `at`; none before the first.
pugi::xml_node begun(pugi::xml_node parent, const char* name, const char* station, Real at) {
  pugi::xml_node found;
  for (const auto node : parent.children(name)) {
    if (number(node, station) <= at) found = node;
  }
  return found;
}

Real cubic(pugi::xml_node node, Real ds) {
  if (!node) return 0;
  return number(node, "a") + number(node, "b") * ds + number(node, "c") * ds * ds +
         number(node, "d") * ds * ds * ds;
}

struct Frame {
  Vector2l point;
  Real heading;
};

// Composite Simpson over the heading: x = ∫ cos, y = ∫ sin.
Frame by_heading(Real curvature, Real rate, Real ds) {
  const auto heading = [&](Real s) { return curvature * s + rate * s * s / 2; };
  const int n = 512;
  Vector2l sum(0, 0);
  for (int i = 0; i <= n; ++i) {
    const Real weight = (i == 0 || i == n) ? 1 : (i % 2 == 1 ? 4 : 2);
    const Real angle = heading(ds * i / n);
    sum += weight * Vector2l(std::cos(angle), std::sin(angle));
  }
  return {sum * ds / (3 * n), heading(ds)};
}

Frame param_poly(pugi::xml_node node, Real p) {
  const auto value = [&](const char* a, const char* b, const char* c, const char* d) {
    return number(node, a) + p * number(node, b) + p * p * number(node, c) +
           p * p * p * number(node, d);
  };
  const auto slope = [&](const char* b, const char* c, const char* d) {
    return number(node, b) + 2 * p * number(node, c) + 3 * p * p * number(node, d);
  };
  return {{value("aU", "bU", "cU", "dU"), value("aV", "bV", "cV", "dV")},
          std::atan2(slope("bV", "cV", "dV"), slope("bU", "cU", "dU"))};
}

// v(u) a cubic, s its arc length: u is found by Newton's method on the length up to it, which
// Simpson's rule sums.
Frame poly3(pugi::xml_node node, Real ds) {
  const Real b = number(node, "b"), c = number(node, "c"), d = number(node, "d");
  const auto slope = [&](Real u) { return b + 2 * c * u + 3 * d * u * u; };
  const auto speed = [&](Real u) { return std::sqrt(1 + slope(u) * slope(u)); };
  const auto length = [&](Real u) {
    const int n = 2000;
    Real sum = 0;
    for (int i = 0; i <= n; ++i)
      sum += ((i == 0 || i == n) ? 1 : (i % 2 == 1 ? 4 : 2)) * speed(u * i / n);
    return sum * u / (3 * n);
  };
  Real u = ds;
  for (int i = 0; i < 20; ++i) u -= (length(u) - ds) / speed(u);
  return {{u, number(node, "a") + u * (b + u * (c + u * d))}, std::atan(slope(u))};
}

Frame local_frame(pugi::xml_node geometry, Real ds) {
  const Real length = number(geometry, "length");
  if (const auto arc = geometry.child("arc")) return by_heading(number(arc, "curvature"), 0, ds);
  if (const auto spiral = geometry.child("spiral")) {
    const Real k = number(spiral, "curvStart");
    return by_heading(k, (number(spiral, "curvEnd") - k) / length, ds);
  }
  if (const auto poly = geometry.child("paramPoly3")) {
    const bool by_length = std::string(poly.attribute("pRange").value()) == "arcLength";
    return param_poly(poly, by_length ? ds : ds / length);
  }
  if (const auto poly = geometry.child("poly3")) return poly3(poly, ds);
  if (!geometry.child("line")) throw std::runtime_error("the oracle does not know this geometry");
  return {{ds, 0}, 0};
}

// Of the <shape> records at station s: the one that holds at t, else the first of them.
Real shape_at(pugi::xml_node lateral, Real s, Real t) {
  pugi::xml_node found;
  for (const auto node : lateral.children("shape")) {
    if (number(node, "s") != s) continue;
    if (!found || number(node, "t") <= t) found = node;
  }
  return cubic(found, t - number(found, "t"));
}

// Linear between the nearest stations of <shape> before and after s.
Real shape_height(pugi::xml_node lateral, Real s, Real t) {
  if (!lateral.child("shape")) return 0;
  const Real far = 1e30L;
  Real before = -far, after = far;
  for (const auto node : lateral.children("shape")) {
    const Real at = number(node, "s");
    if (at <= s) before = std::max(before, at);
    if (at > s) after = std::min(after, at);
  }
  if (before == -far) return shape_at(lateral, after, t);
  if (after == far) return shape_at(lateral, before, t);
  const Real fraction = (s - before) / (after - before);
  return (1 - fraction) * shape_at(lateral, before, t) + fraction * shape_at(lateral, after, t);
}

// A function of s inside <crossSectionSurface>, 0 where it is missing.
Real coefficients_at(pugi::xml_node parent, Real s, Real inside) {
  const auto record = begun(parent, "coefficients", "s", inside);
  return record ? cubic(record, s - number(record, "s")) : 0;
}

Real strip_height(pugi::xml_node strip, Real s, Real dt, Real inside) {
  return coefficients_at(strip.child("constant"), s, inside) +
         coefficients_at(strip.child("linear"), s, inside) * dt +
         coefficients_at(strip.child("quadratic"), s, inside) * dt * dt +
         coefficients_at(strip.child("cubic"), s, inside) * dt * dt * dt;
}

// Of the surface given by strips, by the formulas of ASAM OpenDRIVE 1.8; at its very middle the
// side of the lane's sign counts.
Real strips_height(pugi::xml_node surface, Real s, Real t, Real inside, int sign) {
  if (!surface) return 0;
  const Real effective = t - coefficients_at(surface.child("tOffset"), s, inside);
  const bool left = effective > 0 || (effective == 0 && sign > 0);
  const auto strips = surface.child("surfaceStrips");
  const auto inner = strips.find_child_by_attribute("strip", "id", left ? "1" : "-1");
  const auto outer = strips.find_child_by_attribute("strip", "id", left ? "2" : "-2");
  const Real width = coefficients_at(inner.child("width"), s, inside);
  if (!outer || std::abs(effective) <= width) return strip_height(inner, s, effective, inside);
  const Real edge = left ? width : -width;
  const Real height = strip_height(outer, s, effective - edge, inside);
  const bool relative = std::string(outer.attribute("mode").value()) == "relative";
  return relative ? height + strip_height(inner, s, edge, inside) : height;
}

// The crossfall in force on a side.
Real crossfall_at(pugi::xml_node lateral, const std::string& side, Real s, Real inside) {
  pugi::xml_node found;
  for (const auto node : lateral.children("crossfall")) {
    const std::string names = node.attribute("side").value();
    if (names != side && names != "both") continue;
    if (number(node, "s") <= inside) found = node;
  }
  return found ? cubic(found, s - number(found, "s")) : 0;
}

}  // namespace

struct OpenDriveOracle::Impl {
  pugi::xml_document document;
  std::map<std::string, pugi::xml_node> roads;

  void list_roads() {
    for (const auto road : document.child("OpenDRIVE").children("road")) {
      roads[road.attribute("id").value()] = road;
    }
  }
};

OpenDriveOracle::OpenDriveOracle() : impl_(std::make_unique<Impl>()) {}

OpenDriveOracle::OpenDriveOracle(const std::string& file) : OpenDriveOracle() {
  if (!impl_->document.load_file(file.c_str())) throw std::runtime_error("cannot parse " + file);
  impl_->list_roads();
}

OpenDriveOracle OpenDriveOracle::of_text(const std::string& text) {
  OpenDriveOracle oracle;
  if (!oracle.impl_->document.load_string(text.c_str())) throw std::runtime_error("cannot parse");
  oracle.impl_->list_roads();
  return oracle;
}

OpenDriveOracle::~OpenDriveOracle() = default;
OpenDriveOracle::OpenDriveOracle(OpenDriveOracle&&) noexcept = default;

std::pair<Vector2l, Vector2l> OpenDriveOracle::borders(const std::string& road, int section,
                                                       int lane, long double s_m,
                                                       long double inside_s_m) const {
  const auto [inner, outer] = borders_with_height(road, section, lane, s_m, inside_s_m);
  return {inner.head<2>(), outer.head<2>()};
}

std::pair<Vector3l, Vector3l> OpenDriveOracle::borders_with_height(const std::string& road,
                                                                   int section, int lane,
                                                                   long double s_m,
                                                                   long double inside_s_m) const {
  const pugi::xml_node node = impl_->roads.at(road);
  const auto geometry = in_force(node.child("planView"), "geometry", "s", inside_s_m);
  const Frame local = local_frame(geometry, s_m - number(geometry, "s"));
  const Real start = number(geometry, "hdg");
  const Vector2l origin(number(geometry, "x"), number(geometry, "y"));
  const Vector2l point =
      origin + Vector2l(std::cos(start) * local.point.x() - std::sin(start) * local.point.y(),
                        std::sin(start) * local.point.x() + std::cos(start) * local.point.y());
  const Real heading = start + local.heading;

  const auto lanes = node.child("lanes");
  const auto offset = begun(lanes, "laneOffset", "s", inside_s_m);
  const Real offset_m = offset ? cubic(offset, s_m - number(offset, "s")) : 0;
  auto section_node = lanes.child("laneSection");
  for (int i = 0; i < section; ++i) section_node = section_node.next_sibling("laneSection");
  const Real section_s = number(section_node, "s");
  const auto side = section_node.child(lane > 0 ? "left" : "right");
  const auto lateral = node.child("lateralProfile");
  const auto roll_record = begun(lateral, "superelevation", "s", inside_s_m);
  const Real roll = roll_record ? cubic(roll_record, s_m - number(roll_record, "s")) : 0;
  const Real fall = crossfall_at(lateral, lane > 0 ? "left" : "right", s_m, inside_s_m);
  // Sideways and up, of a place at t on the surface.
  const auto surface = [&](Real t) {
    const Real h = shape_height(lateral, s_m, t) +
                   strips_height(lateral.child("crossSectionSurface"), s_m, t, inside_s_m, lane);
    return Vector2l(t * std::cos(roll) - h * std::sin(roll),
                    t * std::sin(roll) + h * std::cos(roll) - std::abs(t) * std::tan(fall));
  };
  Real t = offset_m;
  Vector2l outer = surface(t), inner = outer;
  for (int id = 1; id <= std::abs(lane); ++id) {
    const auto record =
        side.find_child_by_attribute("lane", "id", std::to_string(lane > 0 ? id : -id).c_str());
    const Real before = t;
    if (record.child("width")) {
      const auto width = in_force(record, "width", "sOffset", inside_s_m - section_s);
      t += (lane > 0 ? 1 : -1) * cubic(width, s_m - section_s - number(width, "sOffset"));
    } else {
      const auto border = in_force(record, "border", "sOffset", inside_s_m - section_s);
      t = offset_m + cubic(border, s_m - section_s - number(border, "sOffset"));
    }
    inner = outer;
    const bool level = std::string(record.attribute("level").value()) == "true";
    outer += level ? Vector2l(t - before, 0) : Vector2l(surface(t) - surface(before));
  }
  const auto rise = begun(node.child("elevationProfile"), "elevation", "s", inside_s_m);
  const Real elevation = rise ? cubic(rise, s_m - number(rise, "s")) : 0;
  const auto place = [&](const Vector2l& at) {
    return Vector3l(point.x() - at.x() * std::sin(heading), point.y() + at.x() * std::cos(heading),
                    elevation + at.y());
  };
  return {place(inner), place(outer)};
}

}  // namespace roadbed::tests
