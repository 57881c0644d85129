#include "roadbed/planning/audit/check/brute_force_obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "roadbed/map/occupancy/ground/ground.h"

namespace roadbed::planning::inline audit {
namespace {

using Corners = BodyOutline::Corners;

constexpr double kTouch_m = 1e-6;  // heights that overlap by less only touch
constexpr std::int64_t kTileSide = 64;
constexpr double kBucketSide = 16.0;             // columns
constexpr std::size_t kMostMarked = 20'000'000;  // tiles, of all marks
constexpr std::size_t kMostTiles = 50'000;       // 800 MB of columns, if all are measured

// Of a cell and the band over ground at a height.
double overlap_m(const map::OccupancyCell& cell, const map::HeightBand& band, double ground_m) {
  const double z_m = cell.centre_in_source.z() - ground_m, half_m = 0.5 * cell.size_m;
  return std::min(z_m + half_m, band.to_m) - std::max(z_m - half_m, band.from_m);
}

// How many layers of cells, of which one begins at `base_m`, a level band meets by more than a
// touch.
double layers_of(const map::HeightBand& band, double base_m, double layer_m) {
  return std::floor((band.to_m - kTouch_m - base_m) / layer_m) -
         std::floor((band.from_m + kTouch_m - base_m) / layer_m) + 1.0;
}

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

// A convex polygon of few corners, cut by straight lines.
struct Cut {
  std::array<Eigen::Vector2d, 8> corners;
  std::size_t count = 0;

  // What lies where a coordinate is at least, or with a sign of -1 at most, a number.
  Cut beyond(int axis, double sign, double at) const {
    Cut kept;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % count];
      const double over_a = sign * (a[axis] - at), over_b = sign * (b[axis] - at);
      if (over_a >= 0.0) kept.corners[kept.count++] = a;
      if ((over_a > 0.0 && over_b < 0.0) || (over_a < 0.0 && over_b > 0.0)) {
        kept.corners[kept.count++] = a + over_a / (over_a - over_b) * (b - a);
      }
    }
    return kept;
  }

  double area_m2() const {
    double twice_m2 = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % count];
      twice_m2 += a.x() * b.y() - b.x() * a.y();
    }
    return 0.5 * twice_m2;
  }
};

// Of a rectangle and a box, seen from the box's corner, so that numbers are small.
double common_area_m2(const Corners& rectangle, const map::Box2& box) {
  Cut cut;
  for (const Eigen::Vector2d& corner : rectangle) {
    cut.corners[cut.count++] = corner - box.min_in_source;
  }
  const Eigen::Vector2d size = box.max_in_source - box.min_in_source;
  return cut.beyond(0, 1.0, 0.0)
      .beyond(0, -1.0, size.x())
      .beyond(1, 1.0, 0.0)
      .beyond(1, -1.0, size.y())
      .area_m2();
}

std::pair<std::int64_t, std::int64_t> tile_of(std::int64_t key) {
  return {key >> 32, static_cast<std::int32_t>(key)};
}

std::size_t place_in_tile(std::int64_t x, std::int64_t y) {
  return static_cast<std::size_t>((y - floor_div(y, kTileSide) * kTileSide) * kTileSide +
                                  (x - floor_div(x, kTileSide) * kTileSide));
}

}  // namespace

BruteForceObstacles::BruteForceObstacles(const std::vector<map::OccupancyCell>& cells,
                                         double resolution_m, const map::HeightBand& band,
                                         const BodyOutline& body)
    : cells_(cells),
      resolution_m_(resolution_m),
      band_(band),
      body_(body),
      occupied_(kBucketSide * resolution_m),
      unknown_(kBucketSide * resolution_m) {
  if (!cells.empty()) {
    corner_ = cells.front().centre_in_source.array() - 0.5 * cells.front().size_m;
  }
  whole_ = band.ground ? band.to_m - band.from_m : layers_of(band, corner_.z(), resolution_m);
  for (const map::OccupancyCell& cell : cells) {
    if (cell.state == map::CellState::occupied) add_occupied(cell);
  }
}

// As a whole over level ground, else column by column.
void BruteForceObstacles::add_occupied(const map::OccupancyCell& cell) {
  const double side_m = band_.ground ? resolution_m_ : cell.size_m;
  const auto count = static_cast<int>(std::lround(cell.size_m / side_m));
  const auto columns = static_cast<std::size_t>(count) * static_cast<std::size_t>(count);
  if (band_.ground && occupied_.size() + columns > kMostBoxes) {
    throw std::length_error(kTooMuchToCheck);
  }
  const Eigen::Vector2d corner = cell.centre_in_source.head<2>().array() - 0.5 * cell.size_m;
  for (int x = 0; x < count; ++x) {
    for (int y = 0; y < count; ++y) {
      const Eigen::Array2d middle = corner + side_m * Eigen::Vector2d(x + 0.5, y + 0.5);
      if (overlap_m(cell, band_, ground_m(middle.x(), middle.y())) <= kTouch_m) continue;
      occupied_.add({middle - 0.5 * side_m, middle + 0.5 * side_m});
    }
  }
}

// The nearest place is at most a tile's diagonal farther away than the one that is nearest to the
// tile's middle.
double BruteForceObstacles::ground_m(double x_m, double y_m) {
  if (!band_.ground) return 0.0;
  const auto& places = band_.ground->places();
  constexpr double tile_m = 8.0;
  const Eigen::Vector2d point(x_m, y_m);
  const auto tile_x = static_cast<Column>(std::floor(x_m / tile_m));
  const auto tile_y = static_cast<Column>(std::floor(y_m / tile_m));
  std::vector<std::size_t>& near = places_near_[tile_key(tile_x, tile_y)];
  if (near.empty()) {
    const Eigen::Vector2d middle((static_cast<double>(tile_x) + 0.5) * tile_m,
                                 (static_cast<double>(tile_y) + 0.5) * tile_m);
    double least_m = std::numeric_limits<double>::infinity();
    for (const auto& place : places) {
      least_m = std::min(least_m, (place.in_source - middle).norm());
    }
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double away_m = (places[i].in_source - middle).norm();
      if (away_m <= least_m + 1.5 * tile_m) near.push_back(i);
    }
  }
  std::size_t nearest = near.front();
  for (const std::size_t i : near) {
    const double away_m = (places[i].in_source - point).squaredNorm();
    if (away_m < (places[nearest].in_source - point).squaredNorm()) nearest = i;
  }
  const auto& place = places[nearest];
  return place.z_m + place.slope.x() * (x_m - place.in_source.x()) +
         place.slope.y() * (y_m - place.in_source.y());
}

double BruteForceObstacles::occupied_m(double x_m, double y_m, double heading_rad,
                                       double limit_m) const {
  return occupied_.distance_m(body_.at(x_m, y_m, heading_rad), limit_m);
}

double BruteForceObstacles::to_box_m(double x_m, double y_m, double heading_rad,
                                     const map::Box2& box) const {
  return body_.at(x_m, y_m, heading_rad).distance_m(corners_of(box));
}

bool BruteForceObstacles::is_occupied(const map::Box2& box) const {
  return occupied_.holds(0.5 * (box.min_in_source + box.max_in_source));
}

bool BruteForceObstacles::is_unknown(const map::Box2& box) const {
  return unknown_.holds(0.5 * (box.min_in_source + box.max_in_source));
}

BruteForceObstacles::Window BruteForceObstacles::window(const Eigen::Array2d& least,
                                                        const Eigen::Array2d& most) const {
  const auto column = [this](double at_m, double corner_m) {
    return static_cast<Column>(std::floor((at_m - corner_m) / resolution_m_));
  };
  return {column(least.x(), corner_.x()), column(least.y(), corner_.y()),
          column(most.x(), corner_.x()) + 1, column(most.y(), corner_.y()) + 1};
}

map::Box2 BruteForceObstacles::columns_box(const Window& columns) const {
  const Eigen::Vector2d corner = corner_.head<2>();
  const auto at = [&](Column x, Column y) -> Eigen::Vector2d {
    return corner + resolution_m_ * Eigen::Vector2d(static_cast<double>(x), static_cast<double>(y));
  };
  return {at(columns.from_x, columns.from_y), at(columns.to_x, columns.to_y)};
}

void BruteForceObstacles::mark(double x_m, double y_m, double limit_m) {
  const double farthest_m = std::max({std::abs(x_m), std::abs(y_m), limit_m + body_.reach_m()});
  if (!(farthest_m <= kFarthest_m)) throw std::length_error(kTooMuchToCheck);
  const Eigen::Array2d place(x_m, y_m);
  const double around_m = limit_m + body_.reach_m() + resolution_m_;  // whatever the heading
  const Window marked = window(place - around_m, place + around_m);
  for (Column y = floor_div(marked.from_y, kTileSide); y * kTileSide < marked.to_y; ++y) {
    for (Column x = floor_div(marked.from_x, kTileSide); x * kTileSide < marked.to_x; ++x) {
      measured_[tile_key(x, y)];
      if (measured_.size() > kMostTiles || ++marked_tiles_ > kMostMarked) {
        throw std::length_error(kTooMuchToCheck);
      }
    }
  }
}

void BruteForceObstacles::measure() {
  for (auto& [key, tile] : measured_) tile.clear();
  for (const map::OccupancyCell& cell : cells_) {
    if (cell.state == map::CellState::unknown) continue;
    if (band_.ground || overlap_m(cell, band_, 0.0) > kTouch_m) measure(cell);
  }
  for (const auto& [key, tile] : measured_) add_unknown(tile_of(key), tile);
}

// Neighbours in a row are one box; so is a tile of which nothing was measured.
void BruteForceObstacles::add_unknown(const std::pair<Column, Column>& at,
                                      const std::vector<float>& tile) {
  const Column first_x = at.first * kTileSide, first_y = at.second * kTileSide;
  if (tile.empty()) {
    return unknown_.add(columns_box({first_x, first_y, first_x + kTileSide, first_y + kTileSide}));
  }
  for (Column y = first_y; y < first_y + kTileSide; ++y) {
    for (Column x = first_x; x < first_x + kTileSide; ++x) {
      const Column from_x = x;
      while (x < first_x + kTileSide && is_unknown_height(tile[place_in_tile(x, y)])) ++x;
      if (x > from_x) unknown_.add(columns_box({from_x, y, x, y + 1}));
    }
  }
}

bool BruteForceObstacles::is_unknown_height(float measured) const {
  constexpr double rounding = 1e-4;  // of some dozens of heights added up
  return static_cast<double>(measured) < whole_ - rounding;
}

// A measured hit makes its column known.
void BruteForceObstacles::measure(const map::OccupancyCell& cell) {
  const Eigen::Array2d least = cell.centre_in_source.head<2>().array() - 0.5 * cell.size_m;
  const Eigen::Array2d from = (least - corner_.head<2>().array()) / resolution_m_;
  const auto from_x = static_cast<Column>(std::llround(from.x()));
  const auto from_y = static_cast<Column>(std::llround(from.y()));
  const auto side = static_cast<Column>(std::llround(cell.size_m / resolution_m_));
  const Window columns{from_x, from_y, from_x + side, from_y + side};
  const Column tile_from_x = floor_div(from_x, kTileSide),
               tile_from_y = floor_div(from_y, kTileSide);
  const Column tile_to_x = floor_div(columns.to_x - 1, kTileSide) + 1;
  const Column tile_to_y = floor_div(columns.to_y - 1, kTileSide) + 1;
  const auto tiles =
      static_cast<std::uint64_t>((tile_to_x - tile_from_x) * (tile_to_y - tile_from_y));
  if (tiles > measured_.size()) {
    for (auto& [key, tile] : measured_) add(tile, tile_of(key), columns, cell);
    return;
  }
  for (Column y = tile_from_y; y < tile_to_y; ++y) {
    for (Column x = tile_from_x; x < tile_to_x; ++x) {
      const auto tile = measured_.find(tile_key(x, y));
      if (tile != measured_.end()) add(tile->second, {x, y}, columns, cell);
    }
  }
}

void BruteForceObstacles::add(std::vector<float>& tile, const std::pair<Column, Column>& at,
                              const Window& columns, const map::OccupancyCell& cell) {
  const Column first_x = at.first * kTileSide, first_y = at.second * kTileSide;
  const Column from_x = std::max(columns.from_x, first_x),
               from_y = std::max(columns.from_y, first_y);
  const Column to_x = std::min(columns.to_x, first_x + kTileSide);
  const Column to_y = std::min(columns.to_y, first_y + kTileSide);
  if (from_x >= to_x || from_y >= to_y) return;
  if (tile.empty()) tile.resize(kTileSide * kTileSide);
  for (Column y = from_y; y < to_y; ++y) {
    for (Column x = from_x; x < to_x; ++x) {
      tile[place_in_tile(x, y)] += measured_height(cell, x, y);
    }
  }
}

// Of a column, by one cell; a hit measures all of it. Over level ground in layers, of which a cell
// that is cut by the band's end has a whole one.
float BruteForceObstacles::measured_height(const map::OccupancyCell& cell, Column x, Column y) {
  const double x_m = corner_.x() + (static_cast<double>(x) + 0.5) * resolution_m_;
  const double y_m = corner_.y() + (static_cast<double>(y) + 0.5) * resolution_m_;
  const double height_m = overlap_m(cell, band_, ground_m(x_m, y_m));
  if (height_m <= kTouch_m) return 0.0f;
  if (cell.state == map::CellState::occupied) return static_cast<float>(whole_);
  if (band_.ground) return static_cast<float>(height_m);
  const double low_m = cell.centre_in_source.z() - 0.5 * cell.size_m;
  const map::HeightBand common{std::max(band_.from_m, low_m),
                               std::min(band_.to_m, low_m + cell.size_m)};
  return static_cast<float>(layers_of(common, low_m, resolution_m_));
}

double BruteForceObstacles::unknown_m(double x_m, double y_m, double heading_rad,
                                      double limit_m) const {
  return unknown_.distance_m(body_.at(x_m, y_m, heading_rad), limit_m);
}

double BruteForceObstacles::measured_fraction(Column x, Column y) const {
  const auto tile = measured_.find(tile_key(floor_div(x, kTileSide), floor_div(y, kTileSide)));
  if (tile == measured_.end() || tile->second.empty()) return 0.0;
  const double measured = static_cast<double>(tile->second[place_in_tile(x, y)]);
  return is_unknown_height(tile->second[place_in_tile(x, y)]) ? measured / whole_ : 1.0;
}

std::optional<map::Box2> BruteForceObstacles::measured_column(const Eigen::Vector2d& point) const {
  const Window at = window(point, point);
  if (measured_fraction(at.from_x, at.from_y) == 0.0) return std::nullopt;
  return columns_box({at.from_x, at.from_y, at.from_x + 1, at.from_y + 1});
}

// Most columns lie wholly in the rectangle or beside it.
double BruteForceObstacles::measured_fraction(double x_m, double y_m, double heading_rad) const {
  const BodyOutline::Corners body = body_.box_at(x_m, y_m, heading_rad);
  const map::Box2 around = BodyOutline::Place{body, 0.0}.around();
  const Window columns = window(around.min_in_source, around.max_in_source);
  const Eigen::Vector2d length = body[1] - body[0], width = body[2] - body[1];
  const Eigen::Vector2d ahead = length.normalized(), middle = 0.5 * (body[0] + body[2]);
  const double half_m = 0.5 * resolution_m_ * (std::abs(ahead.x()) + std::abs(ahead.y()));
  double measured_m2 = 0.0;
  for (Column y = columns.from_y; y < columns.to_y; ++y) {
    for (Column x = columns.from_x; x < columns.to_x; ++x) {
      const map::Box2 column = columns_box({x, y, x + 1, y + 1});
      const Eigen::Vector2d off = 0.5 * (column.min_in_source + column.max_in_source) - middle;
      const double over_m =
          std::max(std::abs(off.dot(ahead)) - 0.5 * length.norm(),
                   std::abs(ahead.x() * off.y() - ahead.y() * off.x()) - 0.5 * width.norm());
      if (over_m >= half_m) continue;
      const double fraction = measured_fraction(x, y);
      if (fraction == 0.0) continue;
      measured_m2 += fraction * (over_m <= -half_m ? resolution_m_ * resolution_m_
                                                   : common_area_m2(body, column));
    }
  }
  return std::min(1.0, measured_m2 / (length.norm() * width.norm()));
}

}  // namespace roadbed::planning::audit
