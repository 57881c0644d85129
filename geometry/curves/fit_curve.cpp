#include "roadbed/geometry/curves/fit_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "roadbed/geometry/curves/spline_problem.h"

namespace roadbed::geometry::inline curves {
namespace {

constexpr int kLeastIterations = 4;  // until the parameters have settled
constexpr int kMostIterations = 40;
constexpr double kAim = 0.9;         // of the tolerance, so that the last bit does not take long
constexpr double kMostLength = 2.0;  // of a curve to its line's
constexpr double kMostWeight = 1e4;  // beyond it the equations lose their digits
constexpr double kWiderScale = 3.0;  // of the scale: detail of wider stretches is smoothed away
constexpr double kMostKnotsPerScale = 4.0;
constexpr double kScales[] = {1.0, 0.8, 0.65, 0.5};  // tried in turn where the curve bends too much

struct Sample {
  double u;
  Eigen::Vector2d point, along;
  double tolerance_m;
  double weight = 1.0;
};

void check(const FitOptions& options) {
  const bool fine = options.knot_distance_m > 0.0 && options.tolerance_m > 0.0 &&
                    options.scale_m > 0.0 &&
                    options.scale_m <= kMostKnotsPerScale * options.knot_distance_m;
  if (!fine) {
    throw std::invalid_argument(fmt::format(
        "fit_curve: knot distance {} m, tolerance {} m and scale {} m must be positive and the "
        "scale at most {} knot distances",
        options.knot_distance_m, options.tolerance_m, options.scale_m, kMostKnotsPerScale));
  }
}

std::vector<Sample> samples_along(const Polyline& line, std::size_t count,
                                  const FitOptions& options) {
  const double step_m = line.length_m() / static_cast<double>(count);
  std::vector<Sample> samples;
  samples.reserve(count + 1);
  for (std::size_t i = 0; i <= count; ++i) {
    const double u = step_m * static_cast<double>(i);
    const Eigen::Vector2d along = (line.at(u + step_m) - line.at(u - step_m)).normalized();
    samples.push_back({u, line.at(u), along, options.tolerance_m});
    for (const WiderStretch& wider : options.wider) {
      if (u < wider.from_m || u > wider.to_m) continue;
      samples.back().tolerance_m = wider.tolerance_m;
      samples.back().weight = std::pow(kWiderScale, -6);
    }
  }
  return samples;
}

// On the line, and on its straight extensions: the j-th control point acts at parameter j − 3.
std::vector<Eigen::Vector2d> first_control_points(const Polyline& line, std::size_t spans) {
  const double step_m = line.length_m() / static_cast<double>(spans);
  const Eigen::Vector2d first = line.at(0.0), last = line.at(line.length_m());
  const Eigen::Vector2d ahead = (line.at(step_m) - first).normalized();
  const Eigen::Vector2d back = (line.at(line.length_m() - step_m) - last).normalized();
  std::vector<Eigen::Vector2d> points;
  for (std::size_t j = 0; j < spans + kSplineDegree; ++j) {
    const double u = step_m * (static_cast<double>(j) - 3.0);
    const double before_m = std::min(0.0, u), past_m = std::max(0.0, u - line.length_m());
    points.push_back(line.at(u) + before_m * ahead - past_m * back);
  }
  return points;
}

// One smoothing spline through the points of a line, refined until it keeps the tolerance.
class Fit {
 public:
  Fit(const Polyline& line, double scale_m, const FitOptions& options)
      : length_m_(line.length_m()),
        scale_m_(scale_m),
        spans_(static_cast<std::size_t>(
            std::max(1.0, std::ceil(length_m_ / options.knot_distance_m)))),
        samples_(samples_along(line, std::max<std::size_t>(2 * spans_, kSplineOrder), options)),
        control_points_(first_control_points(line, spans_)),
        curve_(control_points_, knot_distance()) {}

  FittedCurve refined() {
    for (int iteration = 1; iteration <= kMostIterations; ++iteration) {
      if (!solve()) break;  // keeps the curve before
      measure();
      if (keeps_tolerance_ && iteration >= kLeastIterations) break;
    }
    return {std::move(curve_), largest_move_m_, 0.0};
  }

 private:
  double knot_distance() const { return length_m_ / static_cast<double>(spans_); }

  bool solve() {
    const double step_m = length_m_ / static_cast<double>(samples_.size() - 1);
    SplineProblem problem(control_points_, knot_distance());
    problem.smooth(std::pow(scale_m_, 6));
    for (const Sample& sample : samples_) {
      const Eigen::Vector2d normal(-sample.along.y(), sample.along.x());
      const Eigen::Matrix2d weight =
          sample.along * sample.along.transpose() + sample.weight * normal * normal.transpose();
      problem.attract(sample.u, sample.point, step_m * weight);
    }
    auto solution = std::move(problem).solve();
    if (!solution) return false;
    SmoothCurve curve(*solution, knot_distance());
    if (!(curve.length_m() < kMostLength * length_m_)) return false;  // the digits were lost
    control_points_ = std::move(*solution);
    curve_ = std::move(curve);
    return true;
  }

  // Moves the parameters to the feet, so that the first point stays at the start of the curve and
  // the last one at its end, and raises weights.
  void measure() {
    const double s_per_u = curve_.length_m() / length_m_;
    std::vector<LinePosition> feet;
    feet.reserve(samples_.size());
    for (const Sample& sample : samples_) {
      feet.push_back(curve_.project(sample.point, sample.u * s_per_u));
    }
    const double first_m = feet.front().s_m, range_m = feet.back().s_m - first_m;
    largest_move_m_ = 0.0;
    keeps_tolerance_ = true;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      Sample& sample = samples_[i];
      if (range_m > 0.0) {
        sample.u = std::clamp((feet[i].s_m - first_m) / range_m, 0.0, 1.0) * length_m_;
      }
      const double move_m = std::abs(feet[i].d_m);
      largest_move_m_ = std::max(largest_move_m_, move_m);
      const double excess = move_m / (kAim * sample.tolerance_m);
      if (move_m > sample.tolerance_m) {
        keeps_tolerance_ = false;
        sample.weight = std::min(kMostWeight, sample.weight * excess * excess);
      }
    }
  }

  double length_m_, scale_m_;
  std::size_t spans_;
  std::vector<Sample> samples_;
  std::vector<Eigen::Vector2d> control_points_;
  SmoothCurve curve_;
  double largest_move_m_ = 0.0;
  bool keeps_tolerance_ = false;
};

double peak_curvature(const SmoothCurve& curve, double step_m) {
  double peak = 0.0;
  for (double s = 0.0; s < curve.length_m(); s += step_m) {
    peak = std::max(peak, std::abs(curve.at(s).curvature_per_m[0]));
  }
  return peak;
}

}  // namespace

FittedCurve fit_curve(std::span<const Eigen::Vector2d> points, const FitOptions& options) {
  check(options);
  const Polyline line({points.begin(), points.end()});
  if (!(line.length_m() > 0.0)) {
    throw std::invalid_argument("fit_curve: needs at least two distinct points");
  }
  FittedCurve best;
  for (const double fraction : kScales) {
    FittedCurve fitted = Fit(line, fraction * options.scale_m, options).refined();
    fitted.peak_curvature_per_m = peak_curvature(fitted.curve, 0.25 * options.knot_distance_m);
    const bool straighter = fitted.peak_curvature_per_m < best.peak_curvature_per_m;
    if (fraction == kScales[0] || straighter) best = std::move(fitted);
    if (best.peak_curvature_per_m <= options.max_curvature_per_m) break;
  }
  return best;
}

}  // namespace roadbed::geometry::curves
