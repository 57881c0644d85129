#include "roadbed/map/occupancy/clearance/rectangle_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbed::map::inline occupancy::inline clearance {
namespace {

constexpr double kRounding_cells = 1e-6;  // intervals of cells are this much too long

double squared(double x) { return x * x; }

// Of a point from an axis-aligned box around 0, squared.
double beyond_box_m2(double x_m, double y_m, double half_x_m, double half_y_m) {
  return squared(std::max(std::abs(x_m) - half_x_m, 0.0)) +
         squared(std::max(std::abs(y_m) - half_y_m, 0.0));
}

/// Distances between one rectangle and squares of one size.
class RectangleToSquare {
 public:
  RectangleToSquare(const geometry::Rectangle& rectangle, double half_side_m)
      : c_(rectangle.axis.x()),
        s_(rectangle.axis.y()),
        half_length_m_(rectangle.half_length_m),
        half_width_m_(rectangle.half_width_m),
        half_x_m_(half_length_m_ * std::abs(c_) + half_width_m_ * std::abs(s_)),
        half_y_m_(half_length_m_ * std::abs(s_) + half_width_m_ * std::abs(c_)),
        half_m_(half_side_m),
        half_turned_m_(half_side_m * (std::abs(c_) + std::abs(s_))) {}

  double half_x_m() const { return half_x_m_; }
  double half_y_m() const { return half_y_m_; }
  double half_turned_m() const {
    return half_turned_m_;
  }  // of a square, along the rectangle's axes

  /// Squared, to the square whose centre is (dx, dy) from the rectangle's. Shapes that are apart
  /// along an axis of one of them are nearest at a corner of one of them.
  double distance_m2(double dx_m, double dy_m) const {
    const double along_m = dx_m * c_ + dy_m * s_, across_m = dy_m * c_ - dx_m * s_;
    const bool are_apart = std::abs(along_m) > half_length_m_ + half_turned_m_ ||
                           std::abs(across_m) > half_width_m_ + half_turned_m_ ||
                           std::abs(dx_m) > half_x_m_ + half_m_ ||
                           std::abs(dy_m) > half_y_m_ + half_m_;
    if (!are_apart) return 0.0;
    return std::min(square_corners_m2(along_m, across_m), own_corners_m2(dx_m, dy_m));
  }

 private:
  double square_corners_m2(double along_m, double across_m) const {
    const double p = half_m_ * (c_ + s_), q = half_m_ * (c_ - s_);
    const auto corner = [this](double x_m, double y_m) {
      return beyond_box_m2(x_m, y_m, half_length_m_, half_width_m_);
    };
    return std::min(std::min(corner(along_m + p, across_m + q), corner(along_m - p, across_m - q)),
                    std::min(corner(along_m + q, across_m - p), corner(along_m - q, across_m + p)));
  }

  double own_corners_m2(double dx_m, double dy_m) const {
    const double lc = half_length_m_ * c_, ls = half_length_m_ * s_, wc = half_width_m_ * c_,
                 ws = half_width_m_ * s_;
    const auto corner = [&](double x_m, double y_m) {
      return beyond_box_m2(x_m - dx_m, y_m - dy_m, half_m_, half_m_);
    };
    return std::min(std::min(corner(lc - ws, ls + wc), corner(-lc + ws, -ls - wc)),
                    std::min(corner(lc + ws, ls - wc), corner(-lc - ws, -ls + wc)));
  }

  double c_, s_, half_length_m_, half_width_m_, half_x_m_, half_y_m_, half_m_, half_turned_m_;
};

/// Where a strip of the rectangle's direction crosses rows: dx = slope · dy ± half.
struct Strip {
  double slope, per_m;

  // Along a row, at a right angle to which the strip has no end, it is as good as endless.
  static Strip across(double along_row, double along_column) {
    constexpr double parallel = 1e-6;
    if (std::abs(along_row) < parallel) return {0.0, 1.0 / parallel};
    return {-along_column / along_row, 1.0 / std::abs(along_row)};
  }
};

class RectangleSearch {
 public:
  RectangleSearch(const CellBits& bits, double cell_m, const geometry::Rectangle& rectangle,
                  double reach_m)
      : bits_(bits),
        range_(bits.range()),
        cell_m_(cell_m),
        per_cell_(1.0 / cell_m),
        rectangle_(rectangle),
        shape_(rectangle, 0.5 * cell_m),
        lengthwise_(Strip::across(rectangle.axis.x(), rectangle.axis.y())),
        crosswise_(Strip::across(-rectangle.axis.y(), rectangle.axis.x())),
        reach_m_(reach_m),
        reach_m2_(reach_m * reach_m) {}

  std::optional<NearCell> run() {
    if (range_.empty()) return std::nullopt;
    const double half_m = shape_.half_y_m() + 0.5 * cell_m_ + reach_m_;
    const std::int64_t from = row_at(rectangle_.centre.y() - half_m);
    const std::int64_t to = row_at(rectangle_.centre.y() + half_m);
    for (std::int64_t band = floor_div(from, CellBits::kBandRows);
         band <= floor_div(to, CellBits::kBandRows); ++band) {
      const std::int64_t first = std::max(from, band * CellBits::kBandRows);
      search_band(band, first, std::min(to, band * CellBits::kBandRows + CellBits::kBandRows - 1));
      if (best_ && reach_m_ == 0.0) break;
    }
    return best_;
  }

 private:
  std::int64_t row_at(double y_m) const {
    return whole_below(std::clamp(y_m * per_cell_, static_cast<double>(range_.from_y),
                                  static_cast<double>(range_.to_y - 1)));
  }

  double dy_m(std::int64_t y) const {
    return (static_cast<double>(y) + 0.5) * cell_m_ - rectangle_.centre.y();
  }
  double dx_m(std::int64_t x) const {
    return (static_cast<double>(x) + 0.5) * cell_m_ - rectangle_.centre.x();
  }

  // Columns whose cells may be within reach in rows between two heights; empty where from > to.
  std::pair<std::int64_t, std::int64_t> columns(double from_dy_m, double to_dy_m) const {
    const double grown_m = reach_m_ + shape_.half_turned_m();
    const double x_m = shape_.half_x_m() + 0.5 * cell_m_ + reach_m_;
    const double length_m = (rectangle_.half_length_m + grown_m) * lengthwise_.per_m;
    const double width_m = (rectangle_.half_width_m + grown_m) * crosswise_.per_m;
    const double a_m = lengthwise_.slope * from_dy_m, b_m = lengthwise_.slope * to_dy_m;
    const double c_m = crosswise_.slope * from_dy_m, d_m = crosswise_.slope * to_dy_m;
    const double least_m =
        std::max(std::max(std::min(a_m, b_m) - length_m, std::min(c_m, d_m) - width_m), -x_m);
    const double most_m =
        std::min(std::min(std::max(a_m, b_m) + length_m, std::max(c_m, d_m) + width_m), x_m);
    return {column_at(least_m, 1.0 - kRounding_cells), column_at(most_m, kRounding_cells)};
  }

  // The first cell whose centre lies at or over `dx_m`, or with little added the last one under it.
  std::int64_t column_at(double dx_m, double added) const {
    const double column = (rectangle_.centre.x() + dx_m) * per_cell_ - 0.5 + added;
    return whole_below(std::clamp(column, static_cast<double>(range_.from_x) - 1.0,
                                  static_cast<double>(range_.to_x)));
  }

  std::pair<std::int64_t, std::int64_t> in_range(std::pair<std::int64_t, std::int64_t> x) const {
    return {std::max(x.first, range_.from_x), std::min(x.second, range_.to_x - 1)};
  }

  void search_band(std::int64_t band, std::int64_t first, std::int64_t last) {
    const double from_dy_m = dy_m(first), to_dy_m = dy_m(last);
    const double far_m = std::max(from_dy_m, -to_dy_m) - shape_.half_y_m() - 0.5 * cell_m_;
    if (far_m > reach_m_) return;
    const auto [from_x, to_x] = in_range(columns(from_dy_m, to_dy_m));
    if (from_x > to_x || !bits_.any_in_band(band, from_x, to_x)) return;
    for (std::int64_t y = first; y <= last; ++y) search_row(y);
  }

  void search_row(std::int64_t y) {
    const double dy = dy_m(y);
    const auto [from_x, to_x] = in_range(columns(dy, dy));
    if (from_x > to_x) return;
    const std::int64_t middle = std::clamp(column_at(least_at_m(dy), 1.0), from_x, to_x + 1);
    if (const auto x = bits_.next_in_row(y, middle, to_x)) consider(*x, y, dy);
    if (const auto x = bits_.last_in_row(y, middle - 1, from_x)) consider(*x, y, dy);
  }

  // Where along a row the distance is least.
  double least_at_m(double dy) const {
    const double c = rectangle_.axis.x(), s = rectangle_.axis.y();
    if (std::abs(dy) < shape_.half_y_m()) {
      return std::max(lengthwise_.slope * dy - rectangle_.half_length_m * lengthwise_.per_m,
                      crosswise_.slope * dy - rectangle_.half_width_m * crosswise_.per_m);
    }
    const double highest_m = std::copysign(rectangle_.half_length_m, s) * c -
                             std::copysign(rectangle_.half_width_m, c) * s;
    return std::copysign(1.0, dy) * highest_m;
  }

  void consider(std::int64_t x, std::int64_t y, double dy) {
    const double distance_m2 = shape_.distance_m2(dx_m(x), dy);
    if (!(distance_m2 < reach_m2_ || (!best_ && distance_m2 <= reach_m2_))) return;
    reach_m2_ = distance_m2;
    reach_m_ = std::sqrt(distance_m2);
    best_ = NearCell{reach_m_, x, y};
  }

  const CellBits& bits_;
  const CellRange range_;
  double cell_m_, per_cell_;
  const geometry::Rectangle& rectangle_;
  RectangleToSquare shape_;
  Strip lengthwise_, crosswise_;  // between its ends, and between its sides
  double reach_m_, reach_m2_;
  std::optional<NearCell> best_;
};

}  // namespace

std::optional<NearCell> nearest_set_cell(const CellBits& bits, double cell_m,
                                         const geometry::Rectangle& rectangle, double reach_m) {
  return RectangleSearch(bits, cell_m, rectangle, reach_m).run();
}

}  // namespace roadbed::map::occupancy::clearance
