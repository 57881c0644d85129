#include "roadbed/control/cruise_design.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace roadbed::control {
namespace {

constexpr double kLeast_radps = 1e-3;
constexpr int kFrequencies = 20'000;       // over four decades: 0.05 % apart
constexpr int kFrequenciesOfLoop = 2'000;  // over two decades: 0.2 % apart

double gain_at(const CruiseDesign& design, double step_s, double radps) {
  const Eigen::Matrix3d closed = design.model.A - design.model.B * design.K;
  const std::complex<double> z = std::polar(1.0, radps * step_s);
  const Eigen::Matrix3cd resolvent = z * Eigen::Matrix3cd::Identity() - closed;
  const Eigen::Vector3cd response =
      resolvent.partialPivLu().solve(design.model.G.cast<std::complex<double>>());
  return std::abs(response[2]);
}

/// Filter, delay and vehicle as one: z = [x, x̂ of one step before, commands on their way].
struct Loop {
  Eigen::MatrixXd step;
  Eigen::VectorXd by_lead;  ///< of the lead's acceleration
};

Loop whole_loop(const CruiseDesign& design, int delay_steps) {
  const CruiseModel& model = design.model;
  const int commands = std::max(1, delay_steps), n = 6 + commands;
  Eigen::MatrixXd estimate = Eigen::MatrixXd::Zero(3, n);
  const Eigen::Matrix3d trust = Eigen::Matrix3d::Identity() - design.L;
  estimate.leftCols<3>() = design.L;
  estimate.middleCols<3>(3) = trust * model.A;
  estimate.col(6) = trust * model.B;  // of the last command, as the filter believes it acts
  Loop loop{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  loop.step.topLeftCorner<3, 3>() = model.A;
  loop.step.middleRows<3>(3) = estimate;
  loop.step.row(6) = -design.K * estimate;
  for (int i = 1; i < commands; ++i) loop.step(6 + i, 5 + i) = 1.0;
  if (delay_steps == 0) {
    loop.step.topRows<3>() += model.B * loop.step.row(6);
  } else {
    loop.step.block<3, 1>(0, 5 + delay_steps) += model.B;
  }
  loop.by_lead.head<3>() = model.G;
  return loop;
}

double loop_gain_at(const Loop& loop, double step_s, double radps) {
  const std::complex<double> z = std::polar(1.0, radps * step_s);
  const Eigen::Index n = loop.step.rows();
  const Eigen::MatrixXcd resolvent = z * Eigen::MatrixXcd::Identity(n, n) - loop.step;
  const Eigen::VectorXcd response =
      resolvent.partialPivLu().solve(loop.by_lead.cast<std::complex<double>>());
  const std::complex<double> lead_speed = step_s / (z - 1.0);  // of a held acceleration
  return std::abs(1.0 - response[1] / lead_speed);             // x₂ = v_p − v_f
}

template <typename Gain>
StringGain largest_gain(double least_radps, double most_radps, int count, const Gain& gain_of) {
  StringGain largest;
  for (int i = 0; i <= count; ++i) {
    const double fraction = static_cast<double>(i) / count;
    const double radps = least_radps * std::pow(most_radps / least_radps, fraction);
    const double gain = gain_of(radps);
    if (gain > largest.gain) largest = {gain, radps};
  }
  return largest;
}

}  // namespace

StringGain string_gain(const CruiseDesign& design, double step_s) {
  return largest_gain(kLeast_radps, std::numbers::pi / step_s, kFrequencies,
                      [&](double radps) { return gain_at(design, step_s, radps); });
}

StringGain loop_string_gain(const CruiseDesign& design, double step_s, int delay_steps) {
  if (delay_steps < 0) throw std::invalid_argument("loop_string_gain: negative delay");
  const Loop loop = whole_loop(design, delay_steps);
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return largest_gain(0.01 * kTurn, 1.0 * kTurn, kFrequenciesOfLoop,
                      [&](double radps) { return loop_gain_at(loop, step_s, radps); });
}

}  // namespace roadbed::control
