#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "roadbed/map/edit/osm_edit.h"
#include "roadbed/map/edit/transforming/transform.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::inline edit::inline transforming {
namespace {

using Eigen::Vector2d;
using lanelet2::Document;

[[noreturn]] void refuse_unknown(const Document& document) {
  throw InputError({.file = document.name,
                    .found = "an unknown coordinate system",
                    .needed = "a known one for its latitudes and longitudes",
                    .remedy = "say which with --crs"});
}

// Longitude and latitude, in place; without PROJ where the system is a transverse Mercator one.
void to_degrees(const std::string& crs, std::vector<Vector2d>& points, const std::string& file) {
  const auto grid = lanelet2::transverse_mercator_of(crs);
  if (!grid) return to_lon_lat(crs, points);
  for (Vector2d& point : points) {
    const GeographicPoint place = grid->inverse(point);
    constexpr double most_off_m = 1e-3;
    if (!grid->reaches(place) || !((grid->forward(place) - point).norm() <= most_off_m)) {
      refuse_place(point, "places within 60° of its projection's meridian, short of the poles",
                   file);
    }
    point = {place.longitude_deg, place.latitude_deg};
  }
}

class NodeMover {
 public:
  NodeMover(const Document& document, const TransformOptions& options)
      : document_(document),
        options_(options),
        crs_(options.crs.value_or(document.crs)),
        edit_(document) {}

  Edited run() {
    for (std::size_t i = 0; i < document_.nodes.size(); ++i) {
      if (document_.nodes[i].placed) placed_.push_back(i);
    }
    locals_.reserve(placed_.size());
    for (const std::size_t i : placed_) {
      const Vector2d in_source = document_.nodes[i].in_map.head<2>() + document_.origin_in_source;
      locals_.push_back(options_.motion(in_source));
      has_local_ = has_local_ || document_.places[i].is_local();
    }
    if (has_degrees() || options_.to) {
      if (crs_.empty()) refuse_unknown(document_);
      degrees_ = locals_;
      to_degrees(crs_, degrees_, document_.name);
    }
    if (options_.to) {
      locals_ = degrees_;
      from_lon_lat(*options_.to, locals_);
    }
    require_places(locals_, document_.name);
    for (std::size_t k = 0; k < placed_.size(); ++k) write(k);
    Edited result;
    result.bytes = std::move(edit_).file();
    const auto system = options_.to ? options_.to : options_.crs;
    if (system && (options_.to || has_local_)) {
      result.bytes = with_root_attribute(std::move(result.bytes), "crs", *system);
    }
    result.count("nodes", placed_.size());
    result.count("nodes without a place, left as they are",
                 document_.nodes.size() - placed_.size());
    return result;
  }

 private:
  bool is_geographic(std::size_t i) const {
    const lanelet2::NodePlace& place = document_.places[i];
    const bool zero = place.latitude_deg == 0.0 && place.longitude_deg == 0.0;
    return place.is_on_earth() && !(zero && place.is_local());
  }

  bool has_degrees() const {
    return std::any_of(placed_.begin(), placed_.end(),
                       [&](std::size_t i) { return is_geographic(i); });
  }

  bool moves() const {
    return options_.motion.turn_rad != 0.0 || !options_.motion.shift_m.isZero();
  }

  void write(std::size_t k) {
    const std::size_t i = placed_[k];
    const lanelet2::Node& node = document_.nodes[i];
    OsmElement element(edit_.text_of(node.at));
    if (moves() && is_geographic(i)) {
      element.set_attribute("lat", fmt::format("{}", degrees_[k].y()));
      element.set_attribute("lon", fmt::format("{}", degrees_[k].x()));
    }
    if (options_.to || (moves() && document_.places[i].is_local())) {
      element.set_tag("local_x", fmt::format("{}", locals_[k].x()));
      element.set_tag("local_y", fmt::format("{}", locals_[k].y()));
      element.remove_tag("mgrs_code");  // names another square, or another place in it
    }
    const double up_m = options_.motion.shift_m.z();
    if (up_m != 0.0) element.set_tag("ele", fmt::format("{}", node.in_map.z() + up_m));
    edit_.replace(node.at, element.text());
  }

  const Document& document_;
  const TransformOptions& options_;
  const std::string crs_;
  OsmEdit edit_;
  std::vector<std::size_t> placed_;         // nodes that have a place
  std::vector<Vector2d> locals_, degrees_;  // of each of them, moved
  bool has_local_ = false;
};

}  // namespace

Edited transform_lanelet2(std::string bytes, const std::string& name,
                          const TransformOptions& options) {
  const Document document = lanelet2::read_document(std::move(bytes), name);
  return NodeMover(document, options).run();
}

}  // namespace roadbed::map::edit::transforming
