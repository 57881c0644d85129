#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/map/edit/named_roads.h"
#include "roadbed/map/edit/plan_cut.h"
#include "roadbed/map/edit/transforming/transform.h"
#include "roadbed/map/edit/xml_edit.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/opendrive/read.h"

namespace roadbed::map::inline edit::inline transforming {
namespace {

using Eigen::Vector2d;

constexpr double kSaidM = 0.01;  // what is less far off is not said

/// From the file's coordinates to the new ones.
class PointMapping {
 public:
  PointMapping(const opendrive::Document& document, const TransformOptions& options,
               const std::string& name)
      : options_(options),
        name_(name),
        offset_(document.offset_in_crs),
        crs_(options.crs.value_or(document.crs)) {
    if (options.to && !crs_.empty()) require_metres(crs_);
    if (!options.to || !crs_.empty()) return;
    throw InputError({.file = name,
                      .found = "no coordinate system",
                      .needed = "a known one, to bring the map into another",
                      .remedy = "say which with --crs"});
  }

  void apply(std::vector<Vector2d>& points) const {
    for (Vector2d& point : points) point = options_.motion(point);
    if (!options_.to) return require_places(points, name_);
    const double c = std::cos(offset_.heading_rad), s = std::sin(offset_.heading_rad);
    for (Vector2d& point : points) {  // the header's offset leads to the system
      point = Vector2d(c * point.x() - s * point.y() + offset_.x_m,
                       s * point.x() + c * point.y() + offset_.y_m);
    }
    to_lon_lat(crs_, points);
    from_lon_lat(*options_.to, points);
    require_places(points, name_);
  }

  /// How much higher all is: in another system the header's offset is taken in.
  double up_m() const { return options_.motion.shift_m.z() + (options_.to ? offset_.z_m : 0.0); }

  bool is_rigid() const { return !options_.to; }

 private:
  const TransformOptions& options_;
  std::string name_;
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

// Stations of a road in the new system: each of its geometries has a scale of its own.
class StationMapping {
 public:
  void add(double from_m, double scale) {
    const double here_m = stretches_.empty() ? scale * from_m : (*this)(from_m);
    stretches_.push_back({from_m, here_m, scale});
  }

  double operator()(double s_m) const {
    const Stretch& stretch = at(s_m);
    return stretch.there_m + stretch.scale * (s_m - stretch.from_m);
  }

  double scale_at(double s_m) const { return at(s_m).scale; }

 private:
  struct Stretch {
    double from_m, there_m, scale;
  };

  const Stretch& at(double s_m) const {
    static constexpr Stretch same{0.0, 0.0, 1.0};
    if (stretches_.empty()) return same;
    const auto after =
        std::upper_bound(stretches_.begin(), stretches_.end(), s_m,
                         [](double s, const Stretch& one) { return s < one.from_m; });
    return after == stretches_.begin() ? *after : *std::prev(after);
  }

  std::vector<Stretch> stretches_;
};

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// What one element of a road says along it or across it, but for stations of roads that it names.
// Returns the station where what it says begins.
// @param base_m  where that of the element around it does.
// @param across  the scale across roads, one for the map: widths that meet go on meeting.
double scale_element(pugi::xml_node node, double base_m, const StationMapping& mapping,
                     double across) {
  const std::string_view name = node.name();
  double here_m = base_m;
  if (node.attribute("s") && named_roads(node).empty()) {
    here_m = number(node, "s");
    set_number(node, "s", mapping(here_m));
  }
  for (const char* offset : {"sOffset", "ds"}) {
    if (!node.attribute(offset)) continue;
    here_m = base_m + number(node, offset);
    set_number(node, offset, mapping(here_m) - mapping(base_m));
  }
  const double along = mapping.scale_at(here_m);
  if (is_one_of(name, {"road", "repeat", "bridge", "tunnel"})) {
    set_number(node, "length", mapping(here_m + number(node, "length")) - mapping(here_m));
  }
  if (name == "repeat") scale_attributes(node, {"distance"}, along);
  if (name == "line") scale_attributes(node, {"length", "space"}, along);  // of a marking
  if (name == "CRG") {
    for (const char* s : {"sStart", "sEnd"}) set_number(node, s, mapping(number(node, s)));
  }
  scale_attributes(node, {"t", "tStart", "tEnd", "tOffset"}, across);
  if (is_one_of(name, {"width", "border", "laneOffset", "sway"})) scale_cubic(node, along, across);
  if (is_one_of(name, {"elevation", "superelevation", "crossfall"})) scale_cubic(node, along, 1.0);
  if (name == "shape") scale_cubic(node, across, 1.0);
  return here_m;
}

void scale_road(pugi::xml_node road, const StationMapping& mapping, double across) {
  std::vector<std::pair<pugi::xml_node, double>> open{{road, 0.0}};
  while (!open.empty()) {
    const auto [node, base_m] = open.back();
    open.pop_back();
    const double here_m = scale_element(node, base_m, mapping, across);
    for (const auto child : node.children()) {
      const bool is_other = is_one_of(child.name(), {"userData", "planView"});
      if (!is_other && child.type() == pugi::node_element) open.emplace_back(child, here_m);
    }
  }
}

// Numbers in a row, as the heights of a grid.
void raise_list(pugi::xml_attribute list, double up_m) {
  std::istringstream numbers(list.value());
  std::string raised;
  for (double z_m = 0.0; numbers >> z_m;) {
    raised += fmt::format("{}{}", raised.empty() ? "" : " ", z_m + up_m);
  }
  if (list) list.set_value(raised.c_str());
}

class Mover {
 public:
  Mover(pugi::xml_node root, const PointMapping& mapping, const TransformOptions& options)
      : root_(root), mapping_(mapping), options_(options) {}

  void run() {
    collect();
    mapping_.apply(points_);
    for (Piece& piece : pieces_) place(piece);
    if (!mapping_.is_rigid()) scale_all();
    for (const auto road : root_.children("road")) lift(road);
    for (const auto junction : root_.children("junction")) lift_grid(junction);
    move_inertial();
    move_header();
  }

  // The largest step between geometries of one road.
  double worst_step_m() const {
    double worst_m = 0.0;
    for (const auto road : root_.children("road")) {
      const auto list = children(road.child("planView"), "geometry");
      for (std::size_t i = 0; i + 1 < list.size(); ++i) {
        const Vector2d end = place_in(list[i], 1.0);
        worst_m = std::max(worst_m, (end - plan_piece(list[i + 1]).start.position()).norm());
      }
    }
    return worst_m;
  }

  // How far the middle of a geometry is at most from where it has to be.
  double worst_middle_m() const {
    double worst_m = 0.0;
    for (const Piece& piece : pieces_) {
      worst_m = std::max(worst_m, (place_in(piece.node, 0.5) - points_[piece.first + 2]).norm());
    }
    return worst_m;
  }

 private:
  static constexpr double kProbeM = 10.0;  // a second point tells direction and scale

  // A geometry; its points are its start, its end, its middle, and one ahead of its start.
  struct Piece {
    pugi::xml_node node;
    std::size_t first;
    Vector2d chord;
    double scale = 1.0;
  };

  static Vector2d place_in(pugi::xml_node geometry, double fraction) {
    const auto piece = plan_piece(geometry);
    return geometry::plan_point(piece, piece.s_m + fraction * piece.length_m).pose.position();
  }

  void collect() {
    for (const auto owner : root_.children()) {
      for (const auto geometry : owner.child("planView").children("geometry")) {
        const Vector2d start(number(geometry, "x"), number(geometry, "y"));
        const Vector2d end = place_in(geometry, 1.0);
        const double heading = number(geometry, "hdg");
        pieces_.push_back({geometry, points_.size(), end - start});
        points_.insert(points_.end(),
                       {start, end, place_in(geometry, 0.5),
                        start + kProbeM * Vector2d(std::cos(heading), std::sin(heading))});
      }
    }
  }

  // A motion turns all alike. In another system a geometry is turned and scaled so that it ends
  // where it has to, or begins in its direction where it is a loop.
  void place(Piece& piece) const {
    const Vector2d& start = points_[piece.first];
    const double heading = number(piece.node, "hdg");
    const bool is_loop = piece.chord.norm() < 0.1 * number(piece.node, "length");
    const Vector2d before =
        is_loop ? Vector2d(kProbeM * Vector2d(std::cos(heading), std::sin(heading))) : piece.chord;
    const Vector2d after = points_[piece.first + (is_loop ? 3 : 1)] - start;
    set_number(piece.node, "x", start.x());
    set_number(piece.node, "y", start.y());
    double turn_rad = options_.motion.turn_rad;
    if (!mapping_.is_rigid() && before.norm() > 0.0) {
      piece.scale = after.norm() / before.norm();
      turn_rad = std::atan2(geometry::cross(before, after), before.dot(after));
    }
    set_number(piece.node, "hdg", heading + turn_rad);
  }

  void scale_all() const {
    std::map<pugi::xml_node, StationMapping> mappings;  // of each that has a plan view
    double before_m = 0.0, after_m = 0.0;
    for (const Piece& piece : pieces_) {
      before_m += number(piece.node, "length");
      after_m += piece.scale * number(piece.node, "length");
      mappings[piece.node.parent().parent()].add(number(piece.node, "s"), piece.scale);
    }
    const double across = before_m > 0.0 ? after_m / before_m : 1.0;
    for (const Piece& piece : pieces_) {
      const StationMapping& mapping = mappings.at(piece.node.parent().parent());
      scale_attributes(piece.node, {"length"}, piece.scale);
      set_number(piece.node, "s", mapping(number(piece.node, "s")));
      scale_curve(piece.node, piece.scale);
    }
    std::map<std::string, const StationMapping*> by_id;
    for (const auto& [owner, mapping] : mappings) {
      if (std::string_view(owner.name()) == "road") {
        scale_road(owner, mapping, across);
        by_id.emplace(text(owner, "id"), &mapping);
      } else if (pugi::xml_node grid = owner.child("elevationGrid")) {
        scale_attributes(grid, {"gridSpacing"}, mapping.scale_at(number(grid, "sStart")));
        scale_attributes(grid, {"sStart"}, mapping.scale_at(0.0));
      }
    }
    for_each_named_road(root_, [&](const NamedRoad& named) {
      const auto found = by_id.find(named.road());
      if (found == by_id.end()) return;
      for (auto [node, station] : named.stations) {
        const auto written = node.attribute(station);
        const bool is_word = std::isalpha(static_cast<unsigned char>(*written.value())) != 0;
        if (!is_word) set_number(node, station, (*found->second)(written.as_double()));
      }
    });
  }

  void lift_grid(pugi::xml_node junction) const {
    const double up_m = mapping_.up_m();
    if (up_m == 0.0) return;
    for (const auto row : junction.child("elevationGrid").children("elevation")) {
      for (const char* side : {"center", "left", "right"}) raise_list(row.attribute(side), up_m);
    }
  }

  void lift(pugi::xml_node road) const {
    const double up_m = mapping_.up_m();
    if (up_m == 0.0) return;
    pugi::xml_node profile = ordered_child(road, "elevationProfile", kRoadOrder);
    const auto records = children(profile, "elevation");
    const bool begins_at_start = std::ranges::any_of(
        records, [](pugi::xml_node record) { return number(record, "s") <= 0.0; });
    if (!begins_at_start) {  // the road is at height 0 up to its first record
      pugi::xml_node record = profile.prepend_child("elevation");
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
        set_number(inertial, "z", number(inertial, "z") + mapping_.up_m());
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
  std::vector<Piece> pieces_;
  std::vector<Vector2d> points_;  // of the pieces
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
  const double off_m = mover.worst_middle_m();
  if (off_m > kSaidM) {
    result.notes.push_back(
        fmt::format("a line, arc or spiral is none in the new system: reference lines are up to "
                    "{:.3f} m off where they would be",
                    off_m));
  }
  result.bytes = text_of(xml, indent);
  return result;
}

}  // namespace roadbed::map::edit::transforming
