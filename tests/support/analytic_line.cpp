#include "roadbed/tests/support/analytic_line.h"

#include <cmath>
#include <vector>

namespace roadbed::tests {
namespace {

constexpr double kPanel_m = 0.5;

// Five-point Gauss rule over [from, to], good to rounding for panels of half a metre.
Eigen::Vector2d integrate(const AnalyticLine& line, double from, double to) {
  constexpr double kNodes[] = {0.0, -0.5384693101056831, 0.5384693101056831, -0.9061798459386640,
                               0.9061798459386640};
  constexpr double kWeights[] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                 0.2369268850561891, 0.2369268850561891};
  Eigen::Vector2d sum(0, 0);
  for (int i = 0; i < 5; ++i) {
    const double heading = line.heading_rad(0.5 * (from + to) + 0.5 * (to - from) * kNodes[i]);
    sum += kWeights[i] * Eigen::Vector2d(std::cos(heading), std::sin(heading));
  }
  return 0.5 * (to - from) * sum;
}

Eigen::Vector2d position(const AnalyticLine& line, double s_m) {
  const int panels = static_cast<int>(std::abs(s_m) / kPanel_m);
  const double step = s_m < 0.0 ? -kPanel_m : kPanel_m;
  Eigen::Vector2d sum(0, 0);
  for (int i = 0; i < panels; ++i) sum += integrate(line, i * step, (i + 1) * step);
  return sum + integrate(line, panels * step, s_m);
}

// Positions at every panel, so that one look-up costs one panel.
struct Table {
  explicit Table(const AnalyticLine& of) : line(of) {
    for (int i = 0; i <= kPanels; ++i) at_panel.push_back(position(line, kFrom_m + i * kPanel_m));
  }
  Eigen::Vector2d at(double s_m) const {
    const double panel = std::floor((s_m - kFrom_m) / kPanel_m);
    if (panel < 0.0 || panel > kPanels) return position(line, s_m);
    return at_panel[static_cast<std::size_t>(panel)] +
           integrate(line, kFrom_m + panel * kPanel_m, s_m);
  }
  static constexpr double kFrom_m = -20.0;
  static constexpr int kPanels = 400;
  AnalyticLine line;
  std::vector<Eigen::Vector2d> at_panel;
};

planning::ReferencePoint point_at(const AnalyticLine& line, double s, const Eigen::Vector2d& at) {
  const auto& c = line.curvature;
  return {.s_m = s,
          .in_map = at,
          .heading_rad = line.heading_rad(s),
          .curvature_per_m = c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * c[4]))),
          .curvature_d1_per_m2 = c[1] + s * (2 * c[2] + s * (3 * c[3] + s * 4 * c[4])),
          .curvature_d2_per_m3 = 2 * c[2] + s * (6 * c[3] + s * 12 * c[4]),
          .curvature_d3_per_m4 = 6 * c[3] + s * 24 * c[4],
          .curvature_d4_per_m5 = 24 * c[4]};
}

}  // namespace

double AnalyticLine::heading_rad(double s) const {
  const auto& c = curvature;
  return s * (c[0] + s * (c[1] / 2 + s * (c[2] / 3 + s * (c[3] / 4 + s * c[4] / 5))));
}

planning::ReferencePoint AnalyticLine::at(double s_m) const {
  return point_at(*this, s_m, position(*this, s_m));
}

planning::LineView AnalyticLine::view() const {
  const auto table = std::make_shared<const Table>(*this);
  const planning::Corridor corridor{.left_m = left_m, .right_m = right_m, .speed_limit_mps = 13.9};
  return {[table](double s_m) { return point_at(table->line, s_m, table->at(s_m)); },
          [corridor](double) { return corridor; }};
}

}  // namespace roadbed::tests
