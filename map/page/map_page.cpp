#include "roadbed/map/page/map_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/files/html_page.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/page/lon_lat_fit.h"
#include "roadbed/map/page/page_data.h"
#include "roadbed/map/validation/validate.h"

namespace roadbed::map::inline page {

void LineColumns::step_to(const Eigen::Vector2d& in_map) {
  const std::int64_t x = std::llround(in_map.x() * kUnitsPerMetre);
  const std::int64_t y = std::llround(in_map.y() * kUnitsPerMetre);
  steps_.add(x - x_);
  steps_.add(y - y_);
  x_ = x;
  y_ = y;
}

void LineColumns::add(std::span<const Eigen::Vector2d> points_in_map) {
  counts_.add(static_cast<std::int64_t>(points_in_map.size()));
  for (const Eigen::Vector2d& point : points_in_map) step_to(point);
}

Json LineColumns::json() const { return {{"counts", counts_.text()}, {"steps", steps_.text()}}; }

namespace {

using Eigen::AlignedBox2d;
using Eigen::Vector2d;

AlignedBox2d box_of(const RoadMap& road_map) {
  AlignedBox2d box;
  for (const Lane& lane : road_map.lanes()) {
    for (const LaneLine* line : {&lane.left, &lane.right}) {
      for (const Vector2d& point : line->in_map.points()) box.extend(point);
    }
  }
  for (const Area& area : road_map.areas()) {
    for (const geometry::Polygon& polygon : area.in_map) {
      for (const Vector2d& point : polygon.outer) box.extend(point);
    }
  }
  return box;
}

/// From raw coordinates to those of the CRS, as map/gis does with whole layers.
Vector2d in_crs(const CrsOffset& offset, const Vector2d& in_source) {
  return Eigen::Rotation2Dd(offset.heading_rad) * in_source + Vector2d(offset.x_m, offset.y_m);
}

Json numbers_json(const std::vector<double>& numbers) { return numbers; }

/// Longitude and latitude within the map's box and some way around it; null with a note where the
/// system is not known, or not to PROJ.
Json lon_lat_json(const RoadMap& road_map, AlignedBox2d box, const MapPageOptions& options) {
  if (options.crs.empty() || box.isEmpty()) return nullptr;
  const double margin_m = 200.0 + 0.1 * box.sizes().maxCoeff();
  box = AlignedBox2d(box.min().array() - margin_m, box.max().array() + margin_m);
  const CrsOffset offset = options.is_own_crs ? road_map.offset_in_crs() : CrsOffset{};
  const auto project = [&](std::span<Vector2d> places) {
    for (Vector2d& place : places) place = in_crs(offset, road_map.to_source(place));
    to_lon_lat(options.crs, places);
  };
  try {
    const LonLatFit fit = fit_lon_lat(box, project);
    return {{"box", {box.min().x(), box.min().y(), box.max().x(), box.max().y()}},
            {"terms", fit.terms},
            {"longitude", numbers_json(fit.longitude_deg)},
            {"latitude", numbers_json(fit.latitude_deg)},
            {"error", fit.most_error_deg}};
  } catch (const InputError& error) {
    if (options.notes != nullptr) {
      options.notes->push_back(fmt::format("without longitude and latitude: {}", error.what()));
    }
    return nullptr;
  }
}

std::string title_of(const MapPageOptions& options) {
  return options.title.empty() ? "Map" : options.title;
}

/// Of everything but lanes, which have a column of their own.
Json lines_of_things_json(const validation::ElementLines& lines) {
  Json made = Json::object();
  for (const auto& [element, line] : lines) {
    if (!element.starts_with("lane ") && line > 0) made[element] = line;
  }
  return made;
}

}  // namespace

std::vector<PageRemark> remarks_of(const std::vector<validation::Finding>& findings) {
  std::vector<PageRemark> remarks;
  remarks.reserve(findings.size());
  for (const validation::Finding& finding : findings) {
    remarks.push_back({finding.rule, std::string(to_string(finding.severity)), finding.element,
                       finding.message, finding.line, finding.in_map});
  }
  return remarks;
}

std::string map_page_data(const RoadMap& road_map, const MapPageOptions& options) {
  const AlignedBox2d box = box_of(road_map);
  const Vector2d low = box.isEmpty() ? Vector2d(-10, -10) : box.min();
  const Vector2d high = box.isEmpty() ? Vector2d(10, 10) : box.max();
  const Vector2d& origin = road_map.origin_in_source();
  Json data = {
      {"file", options.file.empty() ? title_of(options) : options.file},
      {"format", road_map.format()},
      {"crs", options.crs},
      {"origin", {origin.x(), origin.y()}},
      {"box", {low.x(), low.y(), high.x(), high.y()}},
      {"unit", 1.0 / kUnitsPerMetre},
      {"lonLat", lon_lat_json(road_map, box, options)},
      {"remarksTitle", options.remarks_title.empty() ? "Findings" : options.remarks_title}};
  data["remarks"] =
      remarks_json(options.remarks ? *options.remarks : remarks_of(validation::validate(road_map)));
  data["overlays"] = overlays_json(options.overlays);
  data["lanes"] = lanes_json(road_map, options.lines);
  data["lines"] = lines_of_things_json(options.lines);
  data.update(things_json(road_map));
  return json_for_script(json_text(data));
}

std::string write_map_page(const RoadMap& road_map, const MapPageOptions& options) {
  return filled_page(kMapTemplate, {{"title", html_text(title_of(options))},
                                    {"css", std::string(kMapCss)},
                                    {"js", std::string(kMapJs)},
                                    {"data", map_page_data(road_map, options)}});
}

}  // namespace roadbed::map::page
