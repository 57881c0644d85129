#include "roadbed/map/gis/write.h"

#include <fmt/format.h>

#include <iterator>

#include "roadbed/map/derived/surface.h"
#include "roadbed/map/files/csv_field.h"

namespace roadbed::map::inline gis {
namespace {

/// The four columns that all rows of a lane share.
std::string lane_columns(const RoadMap& road_map, const Lane& lane) {
  const std::string road = lane.road ? road_map.road(*lane.road).source_id : "";
  return fmt::format("{},{},{},{}", csv_field(road), lane.origin.section,
                     csv_field(lane.origin.source_id), to_string(lane.type));
}

void add_line(const RoadMap& road_map, const std::string& columns, std::string_view which,
              const LaneLine& line, std::string& text) {
  const auto& points = line.in_map.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d in_source = road_map.to_source(points[i]);
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{}\n", columns, which,
                   line.station_m[i], in_source.x(), in_source.y(), line.z_m[i]);
  }
}

/// Points beside a line, `fraction` of the width to its left.
geometry::Polyline beside(const geometry::MedialBranch& branch, double fraction) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < branch.width_m.size(); ++i) {
    const double s_m = branch.line.stations_m()[i];
    const Eigen::Vector2d along = branch.line.at(s_m + 0.05) - branch.line.at(s_m - 0.05);
    const Eigen::Vector2d left = Eigen::Vector2d(-along.y(), along.x()).normalized();
    points.emplace_back(branch.line.points()[i] + fraction * branch.width_m[i] * left);
  }
  return geometry::Polyline(std::move(points));
}

/// A stretch of road area in the columns of a lane: its borders are half the width from its
/// middle.
void add_branch(const RoadMap& road_map, const geometry::MedialBranch& branch, std::size_t number,
                std::string& text) {
  const std::string columns = fmt::format(",0,area {},other", number);
  const std::vector<double> z_m(branch.width_m.size(), 0.0);
  const std::vector<double>& stations_m = branch.line.stations_m();
  add_line(road_map, columns, "left", {beside(branch, 0.5), z_m, stations_m}, text);
  add_line(road_map, columns, "right", {beside(branch, -0.5), z_m, stations_m}, text);
  add_line(road_map, columns, "centre", {branch.line, z_m, stations_m}, text);
}

}  // namespace

std::string write_csv(const RoadMap& road_map) {
  std::string text = "road,section,lane,type,line,s_m,x_m,y_m,z_m\n";
  for (const Lane& lane : road_map.lanes()) {
    const std::string columns = lane_columns(road_map, lane);
    add_line(road_map, columns, "left", lane.left, text);
    add_line(road_map, columns, "right", lane.right, text);
    add_line(road_map, columns, "centre", lane.centre, text);
  }
  std::size_t number = 0;
  for (const geometry::MedialBranch& branch : road_centrelines(road_map)) {
    add_branch(road_map, branch, ++number, text);
  }
  return text;
}

}  // namespace roadbed::map::gis
