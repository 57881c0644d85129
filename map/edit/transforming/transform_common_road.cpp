#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/edit/transforming/transform.h"
#include "roadbed/map/edit/xml_edit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"

namespace roadbed::map::inline edit::inline transforming {
namespace {

using Eigen::Vector2d;

constexpr std::array<std::string_view, 8> kLocationOrder = {
    "country",      "federalState", "geoNameId",         "gpsLatitude",
    "gpsLongitude", "zipcode",      "geoTransformation", "environment"};

// To 0.1 µm, and as many microradians.
void set_value(pugi::xml_node node, double value) {
  constexpr double kPerUnit = 1e7;
  node.text().set(fmt::format("{}", std::round(value * kPerUnit) / kPerUnit + 0.0).c_str());
}

// The shape of an obstacle that moves along is said from where it is.
bool is_in_own_frame(pugi::xml_node node) {
  const std::string_view parent = node.parent().name();
  return std::string_view(node.name()) == "shape" && parent.ends_with("bstacle") &&
         parent != "environmentObstacle";
}

/// Where the file says that something is, and which way it points.
struct Places {
  std::vector<pugi::xml_node> points, orientations;

  explicit Places(pugi::xml_node root) {
    std::vector<pugi::xml_node> open{root};
    while (!open.empty()) {
      const pugi::xml_node node = open.back();
      open.pop_back();
      if (node.child("x") && node.child("y")) points.push_back(node);
      if (std::string_view(node.name()) == "orientation") orientations.push_back(node);
      for (const auto child : node.children()) {
        if (child.type() == pugi::node_element && !is_in_own_frame(child)) open.push_back(child);
      }
    }
  }
};

double in_half_turns(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

// An angle, or an interval of angles within [−2π, 2π].
void turn_orientation(pugi::xml_node orientation, double by_rad) {
  pugi::xml_node from = orientation.child("intervalStart"), to = orientation.child("intervalEnd");
  if (from && to) {
    const double length_rad = to.text().as_double() - from.text().as_double();
    double start_rad = in_half_turns(from.text().as_double() + by_rad);
    if (start_rad + length_rad > 2.0 * std::numbers::pi) start_rad -= 2.0 * std::numbers::pi;
    set_value(from, start_rad);
    set_value(to, start_rad + length_rad);
    return;
  }
  pugi::xml_node exact = orientation.child("exact") ? orientation.child("exact") : orientation;
  if (!exact.text().empty()) set_value(exact, in_half_turns(exact.text().as_double() + by_rad));
}

class ScenarioMover {
 public:
  ScenarioMover(const commonroad::Document& document, const std::string& name,
                const TransformOptions& options)
      : xml_(document.xml), name_(name), options_(options), places_(document.xml.root()) {}

  Edited run() {
    std::vector<Vector2d> at;
    for (const auto node : places_.points) {
      at.push_back(commonroad::read_point(xml_, node, {0, 0}).head<2>());
    }
    const double turn_rad = options_.motion.turn_rad + move(at);
    require_places(at, name_);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const pugi::xml_node node = places_.points[i];
      set_value(node.child("x"), at[i].x());
      set_value(node.child("y"), at[i].y());
      const double up_m = options_.motion.shift_m.z();
      if (node.child("z") && up_m != 0.0) {
        set_value(node.child("z"), node.child("z").text().as_double() + up_m);
      }
    }
    for (const auto node : places_.orientations) turn_orientation(node, turn_rad);
    if (const auto system = options_.to ? options_.to : options_.crs) name_system(*system);
    Edited result;
    result.count("points", at.size());
    result.count("orientations", places_.orientations.size());
    if (options_.motion.shift_m.z() != 0.0 && !at.empty() && !has_heights()) {
      result.notes.push_back("no point of the file has a height: nothing was raised");
    }
    return result;
  }

 private:
  bool has_heights() const {
    for (const auto node : places_.points) {
      if (node.child("z")) return true;
    }
    return false;
  }

  // How far another system turns directions, in the middle of the map.
  double move(std::vector<Vector2d>& at) const {
    for (Vector2d& point : at) point = options_.motion(point);
    if (!options_.to || at.empty()) return 0.0;
    Vector2d middle(0, 0);
    for (const Vector2d& point : at) middle += point / static_cast<double>(at.size());
    constexpr double kProbeM = 100.0;
    at.push_back(middle);
    at.push_back(middle + Vector2d(kProbeM, 0.0));
    const std::string crs = known_system();
    require_metres(crs);
    to_lon_lat(crs, at);
    from_lon_lat(*options_.to, at);
    const Vector2d along = at.back() - at[at.size() - 2];
    at.resize(at.size() - 2);
    return std::atan2(along.y(), along.x());
  }

  std::string known_system() const {
    const auto transformation = xml_.root().child("location").child("geoTransformation");
    const std::string crs =
        options_.crs.value_or(commonroad::text_of(transformation.child("geoReference")));
    const auto extra = transformation.child("additionalTransformation");
    const bool is_shifted = extra.child("xTranslation").text().as_double() != 0.0 ||
                            extra.child("yTranslation").text().as_double() != 0.0 ||
                            extra.child("zRotation").text().as_double() != 0.0 ||
                            extra.child("scaling").text().as_double(1.0) != 1.0;
    if (!crs.empty() && (options_.crs || !is_shifted)) return crs;
    throw InputError({.file = name_,
                      .found = crs.empty() ? "no coordinate system"
                                           : "coordinates moved by an additionalTransformation",
                      .needed = "coordinates in a known system, to bring the map into another",
                      .remedy = "say which with --crs; undo a motion with --turn and --shift"});
  }

  void name_system(const std::string& system) const {
    const pugi::xml_node location = xml_.root().child("location");
    if (!location) return;
    pugi::xml_node transformation = ordered_child(location, "geoTransformation", kLocationOrder);
    transformation.remove_child("geoReference");
    transformation.prepend_child("geoReference").text().set(system.c_str());
    if (options_.to) transformation.remove_child("additionalTransformation");
  }

  const XmlDocument& xml_;
  const std::string& name_;
  const TransformOptions& options_;
  Places places_;
};

}  // namespace

Edited transform_common_road(std::string bytes, const std::string& name,
                             const TransformOptions& options) {
  const std::string indent = indent_of(bytes);
  const commonroad::Document document(std::move(bytes), name);
  Edited result = ScenarioMover(document, name, options).run();
  result.bytes = text_of(document.xml, indent);
  return result;
}

}  // namespace roadbed::map::edit::transforming
