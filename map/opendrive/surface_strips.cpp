#include "roadbed/map/opendrive/surface_strips.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbed::map::opendrive {
namespace {

using geometry::CubicValue;
using Strip = SurfaceStrips::Strip;
using Side = SurfaceStrips::Side;

double strip_height_m(const Strip& strip, double s_m, double dt_m, double inside_s_m) {
  double height_m = 0.0;
  for (std::size_t k = strip.factors.size(); k-- > 0;) {
    height_m = height_m * dt_m + strip.factors[k].at(s_m, inside_s_m).value;
  }
  return height_m;
}

// Largest |h|, |h′|, |h″| along s, and largest |∂h/∂t|.
struct StripBounds {
  CubicValue height;
  double slope = 0.0;
};

// h = Σ fₖ(s) dt(s)ᵏ, from bounds of every factor and of dt.
StripBounds strip_bounds(const Strip& strip, double from_s_m, double to_s_m, const CubicValue& dt) {
  StripBounds sum;
  const double x = dt.value;
  for (std::size_t k = 0; k < strip.factors.size(); ++k) {
    const CubicValue f = strip.factors[k].bounds(from_s_m, to_s_m);
    const double n = static_cast<double>(k);
    const double power = std::pow(x, n);
    const double d1 = k > 0 ? n * std::pow(x, n - 1.0) : 0.0;
    const double d2 = k > 1 ? n * (n - 1.0) * std::pow(x, n - 2.0) : 0.0;
    sum.height.value += f.value * power;
    sum.height.d1 += f.d1 * power + f.value * d1 * dt.d1;
    sum.height.d2 +=
        f.d2 * power + 2.0 * f.d1 * d1 * dt.d1 + f.value * (d2 * dt.d1 * dt.d1 + d1 * dt.d2);
    sum.slope += f.value * d1;
  }
  return sum;
}

CubicValue sum_of(const CubicValue& a, const CubicValue& b) {
  return {a.value + b.value, a.d1 + b.d1, a.d2 + b.d2};
}

// What a border may meet along a stretch: the largest of everything, and all slopes, between which
// it may change.
class Worst {
 public:
  void add(const StripBounds& strip) {
    bounds_.height.value = std::max(bounds_.height.value, strip.height.value);
    bounds_.height.d1 = std::max(bounds_.height.d1, strip.height.d1);
    bounds_.height.d2 = std::max(bounds_.height.d2, strip.height.d2);
    slopes_ += strip.slope;
    ++strips_;
  }

  LateralShape::Bounds bounds(double across_d1) const {
    LateralShape::Bounds all = bounds_;
    if (strips_ > 1) all.kinks = slopes_ * across_d1;
    return all;
  }

 private:
  LateralShape::Bounds bounds_;
  double slopes_ = 0.0;
  int strips_ = 0;
};

// A border's distance from the line between the sides: outwards, with its bounds.
struct Outwards {
  double low_m = 0.0, high_m = 0.0;
  CubicValue bounds;
};

void add_side(const Side& side, const Outwards& border, double from_s_m, double to_s_m,
              Worst& worst) {
  if (!side.inner.is_there) return worst.add({});
  const double middle_s_m = 0.5 * (from_s_m + to_s_m);
  const CubicValue width = side.inner.width.bounds(from_s_m, to_s_m);
  const double width_m = side.inner.width.at(middle_s_m).value;
  const double change_m = 0.5 * (to_s_m - from_s_m) * width.d1;
  const bool has_outer = side.outer.is_there;
  if (!has_outer || border.low_m <= width_m + change_m) {
    worst.add(strip_bounds(side.inner, from_s_m, to_s_m, border.bounds));
  }
  if (!has_outer || border.high_m < width_m - change_m) return;
  StripBounds outer = strip_bounds(side.outer, from_s_m, to_s_m, sum_of(border.bounds, width));
  if (side.outer.is_relative) {
    const StripBounds edge = strip_bounds(side.inner, from_s_m, to_s_m, width);
    outer.height = sum_of(outer.height, edge.height);
  }
  worst.add(outer);
}

void add_stations(const geometry::PiecewiseCubic& cubic, std::vector<double>& stations_m) {
  for (const auto& record : cubic.records()) stations_m.push_back(record.s_m);
}

}  // namespace

SurfaceStrips::SurfaceStrips(geometry::PiecewiseCubic t_offset, Side left, Side right)
    : t_offset_(std::move(t_offset)), left_(std::move(left)), right_(std::move(right)) {
  add_stations(t_offset_, stations_m_);
  for (const Side* side : {&left_, &right_}) {
    for (const Strip* strip : {&side->inner, &side->outer}) {
      add_stations(strip->width, stations_m_);
      for (const auto& factor : strip->factors) add_stations(factor, stations_m_);
    }
  }
  std::sort(stations_m_.begin(), stations_m_.end());
}

double SurfaceStrips::height_m(double s_m, double t_m, double inside_s_m, int sign) const {
  const double from_line_m = t_m - t_offset_.at(s_m, inside_s_m).value;
  const bool is_left = from_line_m > 0.0 || (from_line_m == 0.0 && sign > 0);
  const Side& side = is_left ? left_ : right_;
  if (!side.inner.is_there) return 0.0;
  const double width_m = side.inner.width.at(s_m, inside_s_m).value;
  if (!side.outer.is_there || std::abs(from_line_m) <= width_m) {
    return strip_height_m(side.inner, s_m, from_line_m, inside_s_m);
  }
  const double edge_m = is_left ? width_m : -width_m;
  const double height_m = strip_height_m(side.outer, s_m, from_line_m - edge_m, inside_s_m);
  if (!side.outer.is_relative) return height_m;
  return height_m + strip_height_m(side.inner, s_m, edge_m, inside_s_m);
}

LateralShape::Bounds SurfaceStrips::bounds(double from_s_m, double to_s_m, double t_m,
                                           const CubicValue& t_bounds, int sign) const {
  if (empty()) return {};
  const double middle_s_m = 0.5 * (from_s_m + to_s_m);
  const CubicValue offset = t_offset_.bounds(from_s_m, to_s_m);
  const double from_line_m = t_m - t_offset_.at(middle_s_m).value;
  CubicValue across{0.0, t_bounds.d1 + offset.d1, t_bounds.d2 + offset.d2};
  const double reach_m = 0.5 * (to_s_m - from_s_m) * across.d1;
  across.value = std::abs(from_line_m) + reach_m;
  const double low_m = from_line_m - reach_m, high_m = from_line_m + reach_m;
  Worst worst;
  if (high_m > 0.0 || (high_m == 0.0 && sign > 0)) {
    add_side(left_, {low_m, high_m, across}, from_s_m, to_s_m, worst);
  }
  if (low_m < 0.0 || (low_m == 0.0 && sign < 0)) {
    add_side(right_, {-high_m, -low_m, across}, from_s_m, to_s_m, worst);
  }
  return worst.bounds(across.d1);
}

}  // namespace roadbed::map::opendrive
