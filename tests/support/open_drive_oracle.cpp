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
  if (!geometry.child("line")) throw std::runtime_error("the oracle does not know this geometry");
  return {{ds, 0}, 0};
}

}  // namespace

struct OpenDriveOracle::Impl {
  pugi::xml_document document;
  std::map<std::string, pugi::xml_node> roads;
};

OpenDriveOracle::OpenDriveOracle(const std::string& file) : impl_(std::make_unique<Impl>()) {
  if (!impl_->document.load_file(file.c_str())) throw std::runtime_error("cannot parse " + file);
  for (const auto road : impl_->document.child("OpenDRIVE").children("road")) {
    impl_->roads[road.attribute("id").value()] = road;
  }
}

OpenDriveOracle::~OpenDriveOracle() = default;

std::pair<Vector2l, Vector2l> OpenDriveOracle::borders(const std::string& road, int section,
                                                       int lane, long double s_m,
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
  const auto offset = in_force(lanes, "laneOffset", "s", inside_s_m);
  const Real offset_m = offset ? cubic(offset, s_m - number(offset, "s")) : 0;
  auto section_node = lanes.child("laneSection");
  for (int i = 0; i < section; ++i) section_node = section_node.next_sibling("laneSection");
  const Real section_s = number(section_node, "s");
  const auto side = section_node.child(lane > 0 ? "left" : "right");
  Real inner = 0, outer = offset_m;
  for (int id = 1; id <= std::abs(lane); ++id) {
    const auto record =
        side.find_child_by_attribute("lane", "id", std::to_string(lane > 0 ? id : -id).c_str());
    inner = outer;
    if (record.child("width")) {
      const auto width = in_force(record, "width", "sOffset", inside_s_m - section_s);
      outer += (lane > 0 ? 1 : -1) * cubic(width, s_m - section_s - number(width, "sOffset"));
    } else {
      const auto border = in_force(record, "border", "sOffset", inside_s_m - section_s);
      outer = offset_m + cubic(border, s_m - section_s - number(border, "sOffset"));
    }
  }
  const auto roll_record =
      in_force(node.child("lateralProfile"), "superelevation", "s", inside_s_m);
  const Real roll = roll_record ? cubic(roll_record, s_m - number(roll_record, "s")) : 0;
  const Vector2l normal(-std::sin(heading), std::cos(heading));
  return {point + inner * std::cos(roll) * normal, point + outer * std::cos(roll) * normal};
}

}  // namespace roadbed::tests
