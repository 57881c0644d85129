#include "roadbed/map/lanelet2/write/autoware/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "roadbed/map/files/mgrs.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/lanelet2/frame.h"

namespace roadbed::map::lanelet2 {
namespace {

using Eigen::Vector2d;

constexpr double kSquare_m = 1e5;
constexpr const char* kLocalInfo = "projector_type: Local\n";

struct Zone {
  int number = 0;
  bool south = false;
  TransverseMercator grid() const { return utm_grid(number, south); }
};

class FrameMaker {
 public:
  FrameMaker(const RoadMap& road_map, const OsmMap& osm, const SourceFrame& source)
      : source_(source) {
    for (const OsmNode& node : osm.nodes) {
      frame_.local.push_back(road_map.to_source(node.in_map.head<2>()));
    }
    frame_.on_earth.resize(osm.nodes.size(), GeographicPoint{});
    frame_.of_file.with_versions = true;
  }

  AutowareFrame make() {
    frame_.projector_info = kLocalInfo;
    if (frame_.local.empty()) return std::move(frame_);
    if (!find_on_earth()) {
      if (!source_.is_autoware) {
        note("where the map is is unknown: projector Local, latitudes and longitudes of 0");
      }
      return std::move(frame_);
    }
    frame_.of_file.z_offset_m = source_.offset_in_crs.z_m;
    if (source_.is_autoware) {
      keep_local();
    } else {
      move_into_square();
    }
    return std::move(frame_);
  }

 private:
  void note(std::string text) { frame_.notes.push_back(std::move(text)); }

  bool find_on_earth() {
    if (source_.crs.empty()) return false;
    const CrsOffset& offset = source_.offset_in_crs;
    const geometry::Pose2 crs_from_source{offset.x_m, offset.y_m, offset.heading_rad};
    std::vector<Vector2d> points = frame_.local;
    for (Vector2d& point : points) point = crs_from_source * point;
    if (const auto grid = transverse_mercator_of(source_.crs)) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        frame_.on_earth[i] = grid->inverse(points[i]);
      }
      return true;
    }
    if (const std::string fault = projection_fault(source_.crs); !fault.empty()) {
      note(fmt::format("PROJ cannot use the map's coordinate system \"{}\": {}", source_.crs,
                       fault));
      return false;
    }
    to_lon_lat(source_.crs, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      frame_.on_earth[i] = {points[i].y(), points[i].x()};
    }
    return true;
  }

  Zone zone_of_middle() const {
    const auto& all = frame_.on_earth;
    const auto [low, high] = std::ranges::minmax(
        all, {}, [](const GeographicPoint& point) { return point.latitude_deg; });
    // About the first node, so that a map at 180° has a middle, too.
    double west_deg = 0.0, east_deg = 0.0;
    for (const GeographicPoint& point : all) {
      const double from_first_deg =
          std::remainder(point.longitude_deg - all.front().longitude_deg, 360.0);
      west_deg = std::min(west_deg, from_first_deg);
      east_deg = std::max(east_deg, from_first_deg);
    }
    const GeographicPoint middle{
        0.5 * (low.latitude_deg + high.latitude_deg),
        std::remainder(all.front().longitude_deg + 0.5 * (west_deg + east_deg), 360.0)};
    return {utm_zone(middle), middle.latitude_deg < 0.0};
  }

  static Vector2d corner_below(const Vector2d& in_zone) {
    return (in_zone / kSquare_m).array().floor() * kSquare_m;
  }

  void move_into_square() {
    const Zone zone = zone_of_middle();
    const TransverseMercator grid = zone.grid();
    std::vector<Vector2d> in_zone;
    std::map<std::pair<double, double>, std::size_t> count;
    for (const GeographicPoint& point : frame_.on_earth) {
      in_zone.push_back(grid.forward(point));
      const Vector2d corner = corner_below(in_zone.back());
      ++count[{corner.x(), corner.y()}];
    }
    const auto most =
        std::ranges::max_element(count, {}, [](const auto& of_square) { return of_square.second; });
    const Vector2d corner(most->first.first, most->first.second);
    const std::string square = square_at(zone, corner);
    if (square.empty()) {
      note("beyond 84° north and 80° south there are no squares: projector Local");
      return;
    }
    const double stretch = stretch_to(in_zone);
    for (std::size_t i = 0; i < in_zone.size(); ++i) {
      frame_.local[i] = in_zone[i] - corner;
      frame_.mgrs_codes.push_back(mgrs_code(zone.number, zone.south, in_zone[i], 3));
    }
    set_square(zone, corner, square);
    if (std::abs(stretch) > 1e-6) {
      note(
          fmt::format("coordinates are those of MGRS square {}, in which the map is {:.4f} % {}; "
                      "--crs unknown keeps the source's (projector Local)",
                      square, 100.0 * std::abs(stretch), stretch > 0.0 ? "longer" : "shorter"));
    }
    if (count.size() > 1) {
      note(
          fmt::format("the map goes beyond square {}: local coordinates go on beyond it, where "
                      "Autoware's own way from latitude and longitude begins anew",
                      square));
    }
  }

  static std::string square_at(const Zone& zone, const Vector2d& corner) {
    return mgrs_code(zone.number, zone.south, corner.array() + 0.5 * kSquare_m, 0);
  }

  void set_square(const Zone& zone, const Vector2d& corner, const std::string& square) {
    frame_.projector_info =
        fmt::format("projector_type: MGRS\nvertical_datum: WGS84\nmgrs_grid: {}\n", square);
    TransverseMercator grid = zone.grid();
    grid.false_easting_m -= corner.x();
    grid.false_northing_m -= corner.y();
    frame_.of_file.crs = crs_text(grid);
  }

  // By how much the map is longer in the zone than in the source, along its box's longer side.
  double stretch_to(const std::vector<Vector2d>& in_zone) const {
    const auto& local = frame_.local;
    std::pair<std::size_t, std::size_t> ends;
    double most_m = 0.0;
    for (const int axis : {0, 1}) {
      const auto [low, high] =
          std::ranges::minmax_element(local, {}, [&](const Vector2d& p) { return p[axis]; });
      const double apart_m = (*high - *low).norm();
      if (apart_m <= most_m) continue;
      most_m = apart_m;
      ends = {static_cast<std::size_t>(low - local.begin()),
              static_cast<std::size_t>(high - local.begin())};
    }
    if (most_m == 0.0) return 0.0;
    return (in_zone[ends.second] - in_zone[ends.first]).norm() / most_m - 1.0;
  }

  // Local coordinates of an Autoware map fit its point cloud: they are not touched.
  void keep_local() {
    frame_.of_file.crs = source_.crs;
    const auto grid = transverse_mercator_of(source_.crs);
    const Zone zone = zone_of_middle();
    const TransverseMercator whole = zone.grid();
    if (!grid || grid->central_meridian_deg != whole.central_meridian_deg ||
        grid->scale != whole.scale || grid->latitude_of_origin_deg != 0.0) {
      return note(
          "local coordinates are kept, and are none of a projector of Autoware's but Local");
    }
    const Vector2d corner(whole.false_easting_m - grid->false_easting_m,
                          whole.false_northing_m - grid->false_northing_m);
    if ((corner - corner_below(corner.array() + 0.5)).norm() < 1e-3) {
      const std::string square = square_at(zone, corner);
      if (!square.empty()) return set_square(zone, corner, square);
    }
    const GeographicPoint origin = grid->inverse({0.0, 0.0});
    frame_.projector_info = fmt::format(
        "projector_type: LocalCartesianUTM\nvertical_datum: WGS84\nmap_origin:\n"
        "  latitude: {:.12f}\n  longitude: {:.12f}\n  altitude: 0.0\n",
        origin.latitude_deg, origin.longitude_deg);
    if (utm_zone(origin) != zone.number) frame_.projector_info = kLocalInfo;
  }

  const SourceFrame& source_;
  AutowareFrame frame_;
};

}  // namespace

AutowareFrame autoware_frame(const RoadMap& road_map, const OsmMap& osm,
                             const SourceFrame& source) {
  return FrameMaker(road_map, osm, source).make();
}

std::string osm_text(const OsmMap& osm, const AutowareFrame& frame) {
  return osm_text(osm, frame.of_file, [&](std::size_t i) {
    OsmPlace place{frame.on_earth[i], frame.local[i]};
    if (!frame.mgrs_codes.empty()) place.mgrs_code = frame.mgrs_codes[i];
    return place;
  });
}

}  // namespace roadbed::map::lanelet2
