#include "roadbed/map/edit/clipping/osm_nodes.h"

#include <fmt/format.h>

#include <cmath>

namespace roadbed::map::inline edit::inline clipping {

NodeText::NodeText(const lanelet2::Document& document)
    : document_(document), grid_(lanelet2::transverse_mercator_of(document.crs)) {}

std::string NodeText::between(std::uint32_t from, std::uint32_t to, double fraction,
                              std::int64_t id) const {
  const lanelet2::NodePlace &a = document_.places[from], &b = document_.places[to];
  const Eigen::Vector3d in_map =
      document_.nodes[from].in_map +
      fraction * (document_.nodes[to].in_map - document_.nodes[from].in_map);
  const Eigen::Vector2d in_source = in_map.head<2>() + document_.origin_in_source;
  std::string node = fmt::format("<node id=\"{}\" visible=\"true\" version=\"1\"", id);
  if (a.is_on_earth() && b.is_on_earth()) {
    GeographicPoint place{std::lerp(a.latitude_deg, b.latitude_deg, fraction),
                          std::lerp(a.longitude_deg, b.longitude_deg, fraction)};
    // Zeros stand where only local coordinates are known.
    const bool known = place.latitude_deg != 0.0 || place.longitude_deg != 0.0;
    if (grid_ && known) place = grid_->inverse(in_source);
    node += fmt::format(" lat=\"{}\" lon=\"{}\"", place.latitude_deg, place.longitude_deg);
  }
  std::string tags;
  const auto tag = [&](const char* key, double value) {
    tags += fmt::format("\n    <tag k=\"{}\" v=\"{}\" />", key, value);
  };
  if (a.is_local() && b.is_local()) {
    tag("local_x", in_source.x());
    tag("local_y", in_source.y());
  }
  if (in_map.z() != 0.0) tag("ele", in_map.z());
  return tags.empty() ? node + " />" : node + ">" + tags + "\n  </node>";
}

}  // namespace roadbed::map::edit::clipping
