#include "roadbed/planning/brute_force_obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "roadbed/map/occupancy/ground.h"

namespace roadbed::planning {
namespace {

using Corners = BodyOutline::Corners;

constexpr double kTouch_m = 1e-6;  // heights that overlap by less only touch
constexpr std::int64_t kTileSide = 64;
constexpr double kMostColumns = 1e9;
constexpr double kFarthest_m = 1e9;
constexpr auto kTooMuch = "the drive's surroundings have too many columns to be checked";
constexpr std::size_t kMostTiles = 50'000;      // 800 MB of columns, if all are measured
constexpr std::size_t kMostBoxes = 20'000'000;  // 480 MB; over a ground one for each column

double point_to_edge_m(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                       const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double share = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - share * along).norm();
}

// Whether an edge of `a` has all of `b` strictly on its outer side; both are counter-clockwise.
bool parts(const Corners& a, const Corners& b) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d along = a[(i + 1) % 4] - a[i];
    const auto is_outside = [&](const Eigen::Vector2d& p) {
      return along.x() * (p.y() - a[i].y()) - along.y() * (p.x() - a[i].x()) < 0.0;
    };
    if (std::all_of(b.begin(), b.end(), is_outside)) return true;
  }
  return false;
}

double corners_distance_m(const Corners& a, const Corners& b) {
  if (!parts(a, b) && !parts(b, a)) return 0.0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      least_m = std::min({least_m, point_to_edge_m(a[i], b[k], b[(k + 1) % 4]),
                          point_to_edge_m(b[i], a[k], a[(k + 1) % 4])});
    }
  }
  return least_m;
}

// From a point to a rectangle, 0 inside.
double to_point_m(const Corners& from, const Eigen::Vector2d& point) {
  bool is_inside = true;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d &a = from[i], &b = from[(i + 1) % 4];
    const Eigen::Vector2d along = b - a, there = point - a;
    is_inside = is_inside && along.x() * there.y() - along.y() * there.x() >= 0.0;
    least_m = std::min(least_m, point_to_edge_m(point, a, b));
  }
  return is_inside ? 0.0 : least_m;
}

Corners square(double x_m, double y_m, double half_m) {
  return {{{x_m - half_m, y_m - half_m},
           {x_m + half_m, y_m - half_m},
           {x_m + half_m, y_m + half_m},
           {x_m - half_m, y_m + half_m}}};
}

// Of a cell and the band over ground at a height.
double overlap_m(const map::OccupancyCell& cell, const map::HeightBand& band, double ground_m) {
  const double z_m = cell.centre_in_source.z() - ground_m, half_m = 0.5 * cell.size_m;
  return std::min(z_m + half_m, band.to_m) - std::max(z_m - half_m, band.from_m);
}

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

// Unsigned, as a witness may be said to stand anywhere.
std::int64_t tile_key(std::int64_t tile_x, std::int64_t tile_y) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(tile_x) << 32 |
                                   static_cast<std::uint32_t>(tile_y));
}

std::pair<std::int64_t, std::int64_t> tile_of(std::int64_t key) {
  return {key >> 32, static_cast<std::int32_t>(key)};
}

std::size_t place_in_tile(std::int64_t x, std::int64_t y) {
  return static_cast<std::size_t>((y - floor_div(y, kTileSide) * kTileSide) * kTileSide +
                                  (x - floor_div(x, kTileSide) * kTileSide));
}

}  // namespace

double BodyOutline::Place::distance_m(const Corners& from) const {
  return radius_m > 0.0 ? std::max(0.0, to_point_m(from, corners[0]) - radius_m)
                        : corners_distance_m(corners, from);
}

BodyOutline::BodyOutline(const geometry::BodyPart& part, double margin_m)
    : rear_m_(part.rear_m),
      front_m_(part.front_m),
      right_m_(part.right_m),
      left_m_(part.left_m),
      radius_m_(part.radius_m) {
  if (radius_m_ > 0.0) {
    radius_m_ += margin_m;
    return;
  }
  rear_m_ -= margin_m;
  front_m_ += margin_m;
  right_m_ -= margin_m;
  left_m_ += margin_m;
}

BodyOutline::Place BodyOutline::at(double x_m, double y_m, double heading_rad) const {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  const auto corner = [&](double forward_m, double left_m) {
    return Eigen::Vector2d(x_m + c * forward_m - s * left_m, y_m + s * forward_m + c * left_m);
  };
  return {{corner(rear_m_, right_m_), corner(front_m_, right_m_), corner(front_m_, left_m_),
           corner(rear_m_, left_m_)},
          radius_m_};
}

double BodyOutline::reach_m() const {
  return std::hypot(std::max(std::abs(rear_m_), std::abs(front_m_)),
                    std::max(std::abs(right_m_), std::abs(left_m_))) +
         radius_m_;
}

BruteForceObstacles::BruteForceObstacles(const std::vector<map::OccupancyCell>& cells,
                                         double resolution_m, const map::HeightBand& band,
                                         const BodyOutline& body)
    : cells_(cells), resolution_m_(resolution_m), band_(band), body_(body) {
  if (!cells.empty()) {
    corner_ = cells.front().centre_in_source.head<2>().array() - 0.5 * cells.front().size_m;
  }
  for (const map::OccupancyCell& cell : cells) {
    if (cell.state == map::CellState::occupied) add_occupied(cell);
  }
}

// As a whole over level ground, else column by column.
void BruteForceObstacles::add_occupied(const map::OccupancyCell& cell) {
  const double side_m = band_.ground ? resolution_m_ : cell.size_m;
  const auto count = static_cast<int>(std::lround(cell.size_m / side_m));
  const auto columns = static_cast<std::size_t>(count) * static_cast<std::size_t>(count);
  if (band_.ground && x_m_.size() + columns > kMostBoxes) throw std::length_error(kTooMuch);
  const Eigen::Vector2d corner = cell.centre_in_source.head<2>().array() - 0.5 * cell.size_m;
  for (int x = 0; x < count; ++x) {
    for (int y = 0; y < count; ++y) {
      const double x_m = corner.x() + (x + 0.5) * side_m, y_m = corner.y() + (y + 0.5) * side_m;
      if (overlap_m(cell, band_, ground_m(x_m, y_m)) <= kTouch_m) continue;
      x_m_.push_back(x_m);
      y_m_.push_back(y_m);
      half_m_.push_back(0.5 * side_m);
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
  const BodyOutline::Place body = body_.at(x_m, y_m, heading_rad);
  double least_m = limit_m;
  for (std::size_t i = 0; i < x_m_.size(); ++i) {
    const double near_m = least_m + body_.reach_m() + std::sqrt(2.0) * half_m_[i];
    const double dx_m = x_m_[i] - x_m, dy_m = y_m_[i] - y_m;
    if (dx_m * dx_m + dy_m * dy_m > near_m * near_m) continue;
    least_m = std::min(least_m, body.distance_m(square(x_m_[i], y_m_[i], half_m_[i])));
  }
  return least_m;
}

double BruteForceObstacles::to_box_m(double x_m, double y_m, double heading_rad,
                                     const map::Box2& box) const {
  const Eigen::Vector2d &a = box.min_in_source, &b = box.max_in_source;
  return body_.at(x_m, y_m, heading_rad).distance_m({{a, {b.x(), a.y()}, b, {a.x(), b.y()}}});
}

bool BruteForceObstacles::is_occupied(const map::Box2& box) const {
  const Eigen::Vector2d middle = 0.5 * (box.min_in_source + box.max_in_source);
  for (std::size_t i = 0; i < x_m_.size(); ++i) {
    const double away_m = std::max(std::abs(x_m_[i] - middle.x()), std::abs(y_m_[i] - middle.y()));
    if (away_m < half_m_[i]) return true;
  }
  return false;
}

bool BruteForceObstacles::is_unknown(const map::Box2& box) const {
  const Eigen::Vector2d middle = 0.5 * (box.min_in_source + box.max_in_source);
  const Window at = window(middle, middle);
  return is_unknown_column(at.from_x, at.from_y);
}

BruteForceObstacles::Window BruteForceObstacles::window(const Eigen::Array2d& least,
                                                        const Eigen::Array2d& most) const {
  const auto column = [this](double at_m, double corner_m) {
    return static_cast<Column>(std::floor((at_m - corner_m) / resolution_m_));
  };
  return {column(least.x(), corner_.x()), column(least.y(), corner_.y()),
          column(most.x(), corner_.x()) + 1, column(most.y(), corner_.y()) + 1};
}

BruteForceObstacles::Window BruteForceObstacles::window_around(const BodyOutline::Place& body,
                                                               double limit_m) const {
  Eigen::Array2d least = body.corners[0], most = body.corners[0];
  for (const Eigen::Vector2d& corner : body.corners) {
    least = least.min(corner.array());
    most = most.max(corner.array());
  }
  const double around_m = limit_m + body.radius_m + resolution_m_;
  return window(least - around_m, most + around_m);
}

void BruteForceObstacles::mark(double x_m, double y_m, double limit_m) {
  const double farthest_m = std::max({std::abs(x_m), std::abs(y_m), limit_m + body_.reach_m()});
  if (!(farthest_m <= kFarthest_m)) throw std::length_error(kTooMuch);
  const Eigen::Array2d place(x_m, y_m);
  const double around_m = limit_m + body_.reach_m() + resolution_m_;  // whatever the heading
  const Window marked = window(place - around_m, place + around_m);
  marked_columns_ += static_cast<double>(marked.to_x - marked.from_x) *
                     static_cast<double>(marked.to_y - marked.from_y);
  if (marked_columns_ > kMostColumns) throw std::length_error(kTooMuch);
  for (Column y = floor_div(marked.from_y, kTileSide); y * kTileSide < marked.to_y; ++y) {
    for (Column x = floor_div(marked.from_x, kTileSide); x * kTileSide < marked.to_x; ++x) {
      measured_m_[tile_key(x, y)];
      if (measured_m_.size() > kMostTiles) throw std::length_error(kTooMuch);
    }
  }
}

void BruteForceObstacles::measure() {
  for (auto& [key, tile] : measured_m_) tile.clear();
  for (const map::OccupancyCell& cell : cells_) {
    if (cell.state == map::CellState::unknown) continue;
    if (band_.ground || overlap_m(cell, band_, 0.0) > kTouch_m) measure(cell);
  }
}

// A measured hit makes its column known.
void BruteForceObstacles::measure(const map::OccupancyCell& cell) {
  const Eigen::Array2d least = cell.centre_in_source.head<2>().array() - 0.5 * cell.size_m;
  const Eigen::Array2d from = (least - corner_.array()) / resolution_m_;
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
  if (tiles > measured_m_.size()) {
    for (auto& [key, tile] : measured_m_) add(tile, tile_of(key), columns, cell);
    return;
  }
  for (Column y = tile_from_y; y < tile_to_y; ++y) {
    for (Column x = tile_from_x; x < tile_to_x; ++x) {
      const auto tile = measured_m_.find(tile_key(x, y));
      if (tile != measured_m_.end()) add(tile->second, {x, y}, columns, cell);
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
      tile[place_in_tile(x, y)] += measured_height_m(cell, x, y);
    }
  }
}

// Of a column, by one cell; a hit measures all of it.
float BruteForceObstacles::measured_height_m(const map::OccupancyCell& cell, Column x, Column y) {
  const double x_m = corner_.x() + (static_cast<double>(x) + 0.5) * resolution_m_;
  const double y_m = corner_.y() + (static_cast<double>(y) + 0.5) * resolution_m_;
  const double height_m = overlap_m(cell, band_, ground_m(x_m, y_m));
  if (height_m <= kTouch_m) return 0.0f;
  const bool is_hit = cell.state == map::CellState::occupied;
  return static_cast<float>(is_hit ? band_.to_m - band_.from_m : height_m);
}

bool BruteForceObstacles::is_unknown_column(Column x, Column y) const {
  const auto tile = measured_m_.find(tile_key(floor_div(x, kTileSide), floor_div(y, kTileSide)));
  if (tile == measured_m_.end() || tile->second.empty()) return true;
  constexpr float rounding_m = 1e-4f;  // of some dozens of heights added up
  const auto whole_m = static_cast<float>(band_.to_m - band_.from_m);
  return tile->second[place_in_tile(x, y)] < whole_m - rounding_m;
}

BodyOutline::Corners BruteForceObstacles::column_square(Column x, Column y) const {
  return square(corner_.x() + (static_cast<double>(x) + 0.5) * resolution_m_,
                corner_.y() + (static_cast<double>(y) + 0.5) * resolution_m_, 0.5 * resolution_m_);
}

// Rows from the body outwards, as far as a column may still be nearer: of a wide window, most of
// which was never measured, few are looked at.
double BruteForceObstacles::unknown_m(double x_m, double y_m, double heading_rad,
                                      double limit_m) const {
  const BodyOutline::Place body = body_.at(x_m, y_m, heading_rad);
  const Window around = window_around(body, limit_m);
  const Column middle = floor_div(around.from_y + around.to_y, 2);
  double least_m = limit_m;
  for (Column away = 0;; ++away) {
    const Window near = window_around(body, least_m);
    if (middle - away < near.from_y && middle + away >= near.to_y) return least_m;
    for (const Column y : {middle - away, middle + away}) {
      if (y < near.from_y || y >= near.to_y) continue;
      for (Column x = near.from_x; x < near.to_x && least_m > 0.0; ++x) {
        if (!is_unknown_column(x, y)) continue;
        least_m = std::min(least_m, body.distance_m(column_square(x, y)));
      }
    }
    if (least_m == 0.0) return 0.0;
  }
}

}  // namespace roadbed::planning
