#include "roadbed/control/string_gain.h"

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <numbers>

namespace roadbed::control {
namespace {

constexpr double kLeast_radps = 1e-3;
constexpr int kFrequencies = 20'000;  // over four decades: 0.05 % apart

double gain_at(const CruiseDesign& design, double step_s, double radps) {
  const Eigen::Matrix3d closed = design.model.A - design.model.B * design.K;
  const std::complex<double> z = std::polar(1.0, radps * step_s);
  const Eigen::Matrix3cd resolvent = z * Eigen::Matrix3cd::Identity() - closed;
  const Eigen::Vector3cd response =
      resolvent.partialPivLu().solve(design.model.G.cast<std::complex<double>>());
  return std::abs(response[2]);
}

}  // namespace

StringGain string_gain(const CruiseDesign& design, double step_s) {
  const double most_radps = std::numbers::pi / step_s;
  StringGain largest;
  for (int i = 0; i <= kFrequencies; ++i) {
    const double share = static_cast<double>(i) / kFrequencies;
    const double radps = kLeast_radps * std::pow(most_radps / kLeast_radps, share);
    const double gain = gain_at(design, step_s, radps);
    if (gain > largest.gain) largest = {gain, radps};
  }
  return largest;
}

}  // namespace roadbed::control
