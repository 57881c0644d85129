#include "roadbed/geometry/curves/curve_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace roadbed::geometry::inline curves {
namespace {

// The polynomial on [0, h] whose value and first N/2 − 1 derivatives are given at both ends
// (Hermite), by ascending power. Divided differences of the node list 0 … 0, h … h: those between
// equal nodes are derivatives over a factorial.
template <std::size_t N>
std::array<double, N> hermite(const std::array<double, N / 2>& at_0,
                              const std::array<double, N / 2>& at_h, double h) {
  constexpr std::size_t half = N / 2;
  std::array<double, N> difference{}, newton{};
  for (std::size_t i = 0; i < N; ++i) difference[i] = i < half ? at_0[0] : at_h[0];
  newton[0] = difference[0];
  double factorial = 1.0;
  for (std::size_t order = 1; order < N; ++order) {
    factorial *= static_cast<double>(order);
    for (std::size_t i = 0; i + order < N; ++i) {
      if (i + order < half) {
        difference[i] = at_0[order] / factorial;
      } else if (i >= half) {
        difference[i] = at_h[order] / factorial;
      } else {
        difference[i] = (difference[i + 1] - difference[i]) / h;
      }
    }
    newton[order] = difference[0];
  }
  // Newton's form to powers: Horner over the factors (s − node).
  std::array<double, N> power{};
  for (std::size_t i = N; i-- > 0;) {
    const double node = i < half ? 0.0 : h;
    for (std::size_t k = N - 1; k > 0; --k) power[k] = power[k - 1] - node * power[k];
    power[0] = newton[i] - node * power[0];
  }
  return power;
}

template <std::size_t N>
double value_of(const std::array<double, N>& power, double s) {
  double sum = power[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) sum = sum * s + power[i];
  return sum;
}

// x, x′, x″, x‴ by arc length, and the same of y.
struct PositionDerivatives {
  std::array<double, 4> x, y;
};

PositionDerivatives position_derivatives(const CurvePoint& point) {
  const double c = std::cos(point.heading_rad), s = std::sin(point.heading_rad);
  const double k = point.curvature_per_m[0], k1 = point.curvature_per_m[1];
  return {{point.position.x(), c, -k * s, -k1 * s - k * k * c},
          {point.position.y(), s, k * c, k1 * c - k * k * s}};
}

// κ … κ⁗ at s: Horner's scheme carried on to the derivatives.
std::array<double, 5> with_derivatives(const std::array<double, 10>& power, double s) {
  std::array<double, 5> value{};
  for (std::size_t i = power.size(); i-- > 0;) {
    for (std::size_t order = 4; order > 0; --order) {
      value[order] = value[order] * s + value[order - 1];
    }
    value[0] = value[0] * s + power[i];
  }
  return {value[0], value[1], 2.0 * value[2], 6.0 * value[3], 24.0 * value[4]};
}

double turned_after(const std::array<double, 10>& curvature, double s) {
  double sum = 0.0;
  for (std::size_t i = curvature.size(); i-- > 0;) {
    sum = sum * s + curvature[i] / static_cast<double>(i + 1);
  }
  return sum * s;
}

}  // namespace

CurveTable::Piece CurveTable::piece_between(const CurvePoint& from, const CurvePoint& to) {
  const double h = to.s_m - from.s_m;
  const PositionDerivatives a = position_derivatives(from), b = position_derivatives(to);
  return {.s_m = from.s_m,
          .heading_rad = from.heading_rad,
          .curvature = hermite<10>(from.curvature_per_m, to.curvature_per_m, h),
          .x = hermite<8>(a.x, b.x, h),
          .y = hermite<8>(a.y, b.y, h)};
}

CurveTable::CurveTable(const std::vector<CurvePoint>& nodes) {
  if (nodes.size() < 2) throw std::invalid_argument("CurveTable: needs at least two points");
  pieces_.reserve(nodes.size() - 1);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    if (!(nodes[i + 1].s_m > nodes[i].s_m)) {
      throw std::invalid_argument("CurveTable: the points' stations must increase");
    }
    pieces_.push_back(piece_between(nodes[i], nodes[i + 1]));
  }
  length_m_ = nodes.back().s_m;
  buckets_per_m_ = static_cast<double>(pieces_.size()) / length_m_;
  std::size_t piece = 0;
  for (std::size_t bucket = 0; bucket < pieces_.size(); ++bucket) {
    const double start_m = static_cast<double>(bucket) / buckets_per_m_;
    while (piece + 1 < pieces_.size() && pieces_[piece + 1].s_m <= start_m) ++piece;
    first_in_bucket_.push_back(piece);
  }
}

const CurveTable::Piece& CurveTable::piece_at(double s_m) const {
  const auto bucket = static_cast<std::size_t>(s_m * buckets_per_m_);
  std::size_t i = first_in_bucket_[std::min(bucket, first_in_bucket_.size() - 1)];
  while (i > 0 && pieces_[i].s_m > s_m) --i;  // rounding at a bucket's start
  while (i + 1 < pieces_.size() && pieces_[i + 1].s_m <= s_m) ++i;
  return pieces_[i];
}

CurvePoint CurveTable::at(double s_m) const {
  const double within = std::clamp(s_m, 0.0, length_m_);
  const Piece& piece = piece_at(within);
  const double s = within - piece.s_m;
  return {.s_m = within,
          .position = {value_of(piece.x, s), value_of(piece.y, s)},
          .heading_rad = piece.heading_rad + turned_after(piece.curvature, s),
          .curvature_per_m = with_derivatives(piece.curvature, s)};
}

}  // namespace roadbed::geometry::curves
