#include "roadbed/map/lanelet2/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace roadbed::map::lanelet2 {
namespace {

constexpr double kFarthest_m = 1e8;  // no coordinate of a map is larger
constexpr double kAgreement_m = 0.01;

bool is_local_place(const NodePlace& node) {
  return std::abs(node.local_x_m) <= kFarthest_m && std::abs(node.local_y_m) <= kFarthest_m;
}

// Autoware writes zeros where it knows local coordinates only.
bool is_geographic(const NodePlace& node) {
  return std::abs(node.latitude_deg) <= 90.0 && std::abs(node.longitude_deg) <= 360.0 &&
         !(is_local_place(node) && node.latitude_deg == 0.0 && node.longitude_deg == 0.0);
}

GeographicPoint geographic(const NodePlace& node) {
  return {node.latitude_deg, node.longitude_deg};
}

std::string epsg_of_utm(int zone, bool south) {
  return fmt::format("EPSG:{}", (south ? 32700 : 32600) + zone);
}

// The grid as a PROJ string, its shift in whole millimetres; as an EPSG code if it has none.
std::string text_of(const TransverseMercator& grid) {
  const double longitude_deg = grid.central_meridian_deg;
  const int zone = static_cast<int>((longitude_deg + 183.0) / 6.0);
  for (const bool south : {false, true}) {
    const TransverseMercator whole = utm_grid(zone, south);
    if (grid.false_easting_m == whole.false_easting_m &&
        grid.false_northing_m == whole.false_northing_m) {
      return epsg_of_utm(zone, south);
    }
  }
  return fmt::format(
      "+proj=tmerc +lat_0=0 +lon_0={} +k=0.9996 +x_0={} +y_0={} +datum=WGS84 +units=m +no_defs",
      longitude_deg, grid.false_easting_m, grid.false_northing_m);
}

}  // namespace

Frame::Frame(std::span<const NodePlace> nodes, std::string_view mgrs_code) {
  const auto locals = std::count_if(nodes.begin(), nodes.end(), is_local_place);
  const auto others = std::count_if(nodes.begin(), nodes.end(), [](const NodePlace& node) {
    return !is_local_place(node) && is_geographic(node);
  });
  local_ = locals > 0 && locals >= others;
  if (local_) {
    find_local_grid(nodes, mgrs_code);
    return;
  }
  const auto first = std::find_if(nodes.begin(), nodes.end(), is_geographic);
  if (first == nodes.end()) return;
  const int zone = utm_zone(geographic(*first));
  const bool south = first->latitude_deg < 0.0;
  grid_ = utm_grid(zone, south);
  crs_ = epsg_of_utm(zone, south);
}

void Frame::find_local_grid(std::span<const NodePlace> nodes, std::string_view mgrs_code) {
  const auto has_both = [](const NodePlace& n) { return is_local_place(n) && is_geographic(n); };
  const auto first = std::find_if(nodes.begin(), nodes.end(), has_both);
  TransverseMercator grid;
  if (first == nodes.end()) {
    const std::optional<MgrsSquare> square = mgrs_square(mgrs_code);
    if (!square) {
      doubt_ = "its nodes have local_x and local_y only";
      return;
    }
    grid = utm_grid(square->zone, square->south);
    grid.false_easting_m -= square->corner_m.x();
    grid.false_northing_m -= square->corner_m.y();
  } else {
    grid = utm_grid(utm_zone(geographic(*first)), first->latitude_deg < 0.0);
    const Eigen::Vector2d shift_m =
        grid.forward(geographic(*first)) - Eigen::Vector2d(first->local_x_m, first->local_y_m);
    grid.false_easting_m -= std::round(shift_m.x() * 1e3) / 1e3;
    grid.false_northing_m -= std::round(shift_m.y() * 1e3) / 1e3;
    double worst_m = 0.0;
    for (const NodePlace& node : nodes) {
      if (!has_both(node)) continue;
      const Eigen::Vector2d local(node.local_x_m, node.local_y_m);
      worst_m = std::max(worst_m, (grid.forward(geographic(node)) - local).norm());
    }
    if (!(worst_m <= kAgreement_m)) {
      doubt_ =
          fmt::format("its local coordinates differ from its lat/lon by up to {:.3g} m", worst_m);
      return;
    }
  }
  grid_ = grid;
  crs_ = text_of(grid);
}

std::optional<Eigen::Vector2d> Frame::place(const NodePlace& node) const {
  if (local_ && is_local_place(node)) return Eigen::Vector2d(node.local_x_m, node.local_y_m);
  if (!grid_ || !is_geographic(node)) return {};
  const double from_meridian_deg =
      std::remainder(node.longitude_deg - grid_->central_meridian_deg, 360.0);
  if (std::abs(from_meridian_deg) > 60.0) return {};
  return grid_->forward(geographic(node));
}

std::optional<MgrsSquare> mgrs_square(std::string_view code) {
  constexpr std::string_view bands = "CDEFGHJKLMNPQRSTUVWX";  // 8° each from 80° S
  constexpr std::string_view rows = "ABCDEFGHJKLMNPQRSTUV";   // 100 km each, every 2,000 km again
  constexpr std::string_view columns[] = {"STUVWXYZ", "ABCDEFGH", "JKLMNPQR"};  // by zone mod 3
  std::size_t digits = 0;
  int zone = 0;
  while (digits < code.size() && digits < 2 && code[digits] >= '0' && code[digits] <= '9') {
    zone = 10 * zone + (code[digits++] - '0');
  }
  if (digits == 0 || zone < 1 || zone > 60 || code.size() < digits + 3) return {};
  const std::size_t band = bands.find(code[digits]);
  const std::size_t column = columns[zone % 3].find(code[digits + 1]);
  std::size_t row = rows.find(code[digits + 2]);
  if (band == bands.npos || column == columns[0].npos || row == rows.npos) return {};
  if (zone % 2 == 0) row = (row + 15) % 20;  // even zones begin with F
  const bool south = band < 10;
  // The row's letter repeats; the band says which of its squares is meant.
  const TransverseMercator grid = utm_grid(zone, south);
  const double middle_deg = -80.0 + 8.0 * static_cast<double>(band) + 4.0;
  const double middle_m = grid.forward({middle_deg, grid.central_meridian_deg}).y();
  const double first_m = 1e5 * static_cast<double>(row);
  const double turns = std::round((middle_m - first_m - 5e4) / 2e6);
  return MgrsSquare{zone, south, {1e5 * static_cast<double>(column + 1), first_m + 2e6 * turns}};
}

}  // namespace roadbed::map::lanelet2
