#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/edit/plan_cut.h"
#include "roadbed/map/edit/transforming/transform.h"
#include "roadbed/map/edit/xml_edit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/opendrive/read.h"

namespace roadbed::map::inline edit::inline transforming {
namespace {

using Eigen::Vector2d;

/// From the file's coordinates to the new ones.
class PointMapping {
 public:
  PointMapping(const opendrive::Document& document, const TransformOptions& options,
               const std::string& name)
      : options_(options),
        offset_(document.offset_in_crs),
        crs_(options.crs.value_or(document.crs)) {
    if (!options.to || !crs_.empty()) return;
    throw InputError({.file = name,
                      .found = "no coordinate system",
                      .needed = "a known one, to bring the map into another",
                      .remedy = "say which with --crs"});
  }

  void apply(std::vector<Vector2d>& points) const {
    for (Vector2d& point : points) point = options_.motion(point);
    if (!options_.to) return;
    const double c = std::cos(offset_.heading_rad), s = std::sin(offset_.heading_rad);
    for (Vector2d& point : points) {  // the header's offset leads to the system
      point = Vector2d(c * point.x() - s * point.y() + offset_.x_m,
                       s * point.x() + c * point.y() + offset_.y_m);
    }
    to_lon_lat(crs_, points);
    from_lon_lat(*options_.to, points);
  }

  bool is_rigid() const { return !options_.to; }

 private:
  const TransformOptions& options_;
  CrsOffset offset_;
  std::string crs_;
};

// How a cubic's coefficients scale with lengths along the road, and its value with `value`.
void scale_cubic(pugi::xml_node record, double along, double value) {
  const std::array<const char*, 4> names = {"a", "b", "c", "d"};
  double factor = value;
  for (const char* name : names) {
    if (factor != 1.0) set_number(record, name, number(record, name) * factor);
    factor /= along;
  }
}

void scale_attributes(pugi::xml_node node, std::initializer_list<const char*> names, double by) {
  for (const char* name : names) {
    if (node.attribute(name)) set_number(node, name, number(node, name) * by);
  }
}

void scale_curve(pugi::xml_node geometry, double by) {
  scale_attributes(geometry.child("arc"), {"curvature"}, 1.0 / by);
  scale_attributes(geometry.child("spiral"), {"curvStart", "curvEnd"}, 1.0 / by);
  if (const auto poly = geometry.child("poly3")) scale_cubic(poly, by, by);
  const pugi::xml_node param = geometry.child("paramPoly3");
  const bool by_length = text(param, "pRange") == "arcLength";
  for (const char* axis : {"U", "V"}) {
    double factor = by;
    for (const char* power : {"a", "b", "c", "d"}) {
      scale_attributes(param, {(std::string(power) + axis).c_str()}, factor);
      if (by_length) factor /= by;
    }
  }
}

// Everything of a road that is measured along it or across it.
void scale_road(pugi::xml_node road, double by) {
  std::vector<pugi::xml_node> open{road};
  while (!open.empty()) {
    const pugi::xml_node node = open.back();
    open.pop_back();
    const std::string_view name = node.name();
    if (name == "userData" || name == "outline" || name == "outlines") continue;
    scale_attributes(node, {"s", "sOffset", "t", "tStart", "tEnd", "elementS"}, by);
    if (name == "road" || name == "geometry" || name == "repeat" || name == "bridge" ||
        name == "tunnel") {
      scale_attributes(node, {"length"}, by);
    }
    if (name == "geometry") scale_curve(node, by);
    if (name == "width" || name == "border" || name == "laneOffset") scale_cubic(node, by, by);
    if (name == "elevation" || name == "superelevation" || name == "crossfall") {
      scale_cubic(node, by, 1.0);
    }
    for (const auto child : node.children()) {
      if (name != "geometry" && child.type() == pugi::node_element) open.push_back(child);
    }
  }
}

class Mover {
 public:
  Mover(pugi::xml_node root, const PointMapping& mapping, const TransformOptions& options)
      : root_(root), mapping_(mapping), options_(options) {}

  void run() {
    collect();
    mapping_.apply(points_);
    std::size_t next = 0;
    for (const auto road : root_.children("road")) {
      if (!mapping_.is_rigid()) scale_whole(road, next);
      for (const auto geometry : road.child("planView").children("geometry"))
        place(geometry, next++);
      lift(road);
    }
    move_inertial();
    move_header();
  }

  // The largest step between geometries of one road that was not there before.
  double worst_step_m() const {
    double worst_m = 0.0;
    for (const auto road : root_.children("road")) {
      const auto list = children(road.child("planView"), "geometry");
      for (std::size_t i = 0; i + 1 < list.size(); ++i) {
        const auto piece = plan_piece(list[i]);
        const auto end = geometry::plan_point(piece, piece.s_m + piece.length_m).pose.position();
        worst_m = std::max(worst_m, (end - plan_piece(list[i + 1]).start.position()).norm());
      }
    }
    return worst_m;
  }

 private:
  static constexpr double kProbeM = 10.0;  // a second point tells direction and scale

  void collect() {
    for (const auto road : root_.children("road")) {
      for (const auto geometry : road.child("planView").children("geometry")) {
        const double heading = number(geometry, "hdg");
        points_.emplace_back(number(geometry, "x"), number(geometry, "y"));
        points_.emplace_back(points_.back() +
                             kProbeM * Vector2d(std::cos(heading), std::sin(heading)));
      }
    }
  }

  double scale_at(std::size_t i) const {
    return (points_[2 * i + 1] - points_[2 * i]).norm() / kProbeM;
  }

  // By the scale of the geometry in its middle.
  void scale_whole(pugi::xml_node road, std::size_t first) const {
    const std::size_t count = children(road.child("planView"), "geometry").size();
    if (count > 0) scale_road(road, scale_at(first + count / 2));
  }

  void place(pugi::xml_node geometry, std::size_t i) const {
    const Vector2d along = points_[2 * i + 1] - points_[2 * i];
    set_number(geometry, "x", points_[2 * i].x());
    set_number(geometry, "y", points_[2 * i].y());
    set_number(geometry, "hdg",
               mapping_.is_rigid() ? number(geometry, "hdg") + options_.motion.turn_rad
                                   : std::atan2(along.y(), along.x()));
  }

  void lift(pugi::xml_node road) const {
    const double up_m = options_.motion.shift_m.z();
    if (up_m == 0.0) return;
    pugi::xml_node profile = ordered_child(road, "elevationProfile", kRoadOrder);
    if (!profile.child("elevation")) {
      pugi::xml_node record = profile.append_child("elevation");
      for (const char* name : {"s", "a", "b", "c", "d"}) set_number(record, name, 0.0);
    }
    for (const auto record : profile.children("elevation")) {
      set_number(record, "a", number(record, "a") + up_m);
    }
  }

  void move_inertial() const {
    for (const auto road : root_.children("road")) {
      for (const auto signal : road.child("signals").children("signal")) {
        const auto inertial = signal.child("positionInertial");
        if (!inertial) continue;
        const double heading = number(inertial, "hdg");
        std::vector<Vector2d> points{{number(inertial, "x"), number(inertial, "y")}};
        points.emplace_back(points[0] + kProbeM * Vector2d(std::cos(heading), std::sin(heading)));
        mapping_.apply(points);
        const Vector2d along = points[1] - points[0];
        set_number(inertial, "x", points[0].x());
        set_number(inertial, "y", points[0].y());
        set_number(inertial, "hdg", std::atan2(along.y(), along.x()));
        set_number(inertial, "z", number(inertial, "z") + options_.motion.shift_m.z());
      }
    }
  }

  // The box around the old one, the name of the system; the offset led to the old system.
  void move_header() const {
    pugi::xml_node header = root_.child("header");
    if (header.attribute("north") && header.attribute("west")) {
      std::vector<Vector2d> corners;
      for (const char* x : {"west", "east"}) {
        for (const char* y : {"south", "north"}) {
          corners.emplace_back(number(header, x), number(header, y));
        }
      }
      mapping_.apply(corners);
      Eigen::AlignedBox2d box;
      for (const Vector2d& corner : corners) box.extend(corner);
      set_number(header, "west", box.min().x());
      set_number(header, "south", box.min().y());
      set_number(header, "east", box.max().x());
      set_number(header, "north", box.max().y());
    }
    const auto system = options_.to ? options_.to : options_.crs;
    if (!system) return;
    header.remove_child("geoReference");
    if (!system->empty()) {
      pugi::xml_node reference = header.prepend_child("geoReference");
      reference.append_child(pugi::node_cdata).set_value(system->c_str());
    }
    if (options_.to) header.remove_child("offset");
  }

  pugi::xml_node root_;
  const PointMapping& mapping_;
  const TransformOptions& options_;
  std::vector<Vector2d> points_;  // of each geometry: its start, and one ahead
};

}  // namespace

Edited transform_open_drive(std::string bytes, const std::string& name,
                            const TransformOptions& options) {
  const std::string indent = indent_of(bytes);
  const XmlDocument xml(std::move(bytes), name);
  const opendrive::Document document = opendrive::read_document(xml);
  if (document.refusal) throw *document.refusal;
  const PointMapping mapping(document, options, name);
  Mover mover(xml.root(), mapping, options);
  const double before_m = mover.worst_step_m();
  mover.run();
  Edited result;
  result.count("roads", document.roads.size());
  const double after_m = mover.worst_step_m();
  if (after_m > before_m + 1e-6) {
    result.notes.push_back(fmt::format(
        "geometries of a road are up to {:.6f} m apart, {:.6f} m before", after_m, before_m));
  }
  result.bytes = text_of(xml, indent);
  return result;
}

}  // namespace roadbed::map::edit::transforming
