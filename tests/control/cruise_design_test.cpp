#include "roadbed/control/cruise_design.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "roadbed/tests/support/real_data.h"

namespace roadbed::control {
namespace {

// The oracle's state is [d − d_desire, v_p − v_f, a_f] ("gap") or [d_desire − d, v_f − v_p, a_f]
// ("flip"); the paper's has the first sign of one and the second of the other.
struct Oracle {
  Eigen::Vector3d signs;
  CruiseOptions options;
  nlohmann::json figures;
};

Eigen::MatrixXd matrix(const nlohmann::json& rows) {
  Eigen::MatrixXd result(rows.size(), rows.at(0).size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows[i].size(); ++j) {
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows[i][j].get<double>();
    }
  }
  return result;
}

Eigen::VectorXd vector(const nlohmann::json& values) {
  const auto numbers = values.get<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(),
                                           static_cast<Eigen::Index>(numbers.size()));
}

Oracle oracle_of(const nlohmann::json& figures) {
  Oracle oracle;
  oracle.signs = figures["model"] == "gap" ? Eigen::Vector3d(-1, 1, 1) : Eigen::Vector3d(1, -1, 1);
  oracle.options.step_s = figures["Ts"];
  oracle.options.state_weights = vector(figures["Q"]);
  oracle.options.input_weight = figures["R"];
  oracle.figures = figures;
  return oracle;
}

void expect_near(const Eigen::MatrixXd& found, const Eigen::MatrixXd& expected, double relative) {
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), relative * expected.cwiseAbs().maxCoeff())
      << "found\n"
      << found << "\nexpected\n"
      << expected;
}

nlohmann::json read_oracle(const std::filesystem::path& folder) {
  std::ifstream file(folder / "control/lqg_oracle.json");
  return nlohmann::json::parse(file);
}

TEST(CruiseDesign, AgreesWithSciPyOnAllDesigns) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const nlohmann::json oracle = read_oracle(folder);
  for (const nlohmann::json& figures : oracle["lqr"]) {
    const auto [signs, options, expected] = oracle_of(figures);
    const CruiseDesign design = design_cruise(options);
    const Eigen::Matrix3d flip = signs.asDiagonal();
    expect_near(flip * design.model.A * flip, matrix(expected["Ad"]), 1e-12);
    expect_near(flip * design.model.B, vector(expected["Bd"]), 1e-12);
    expect_near(flip * design.model.G, vector(expected["Gd"]), 1e-12);
    expect_near(design.K * flip, vector(expected["K"]).transpose(), 1e-9);
    expect_near(flip * design.P * flip, matrix(expected["P"]), 1e-9);
    EXPECT_LT(design.riccati_residual, 1e-12 * design.P.cwiseAbs().maxCoeff());
    if (expected.contains("string_peak_gain")) {  // not in those of the other sign
      EXPECT_NEAR(string_gain(design, options.step_s).gain,
                  expected["string_peak_gain"].get<double>(), 1e-6);
    }
  }
}

TEST(CruiseDesign, AgreesWithSciPyOnTheFilterGain) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  const nlohmann::json expected = read_oracle(folder)["kalman"][0];  // C = I, the "gap" state
  const Eigen::Matrix3d flip = Eigen::Vector3d(-1, 1, 1).asDiagonal();
  expect_near(flip * design_cruise({}).L * flip, matrix(expected["L_filter"]), 1e-9);
}

// scipy.linalg.solve_discrete_are and SLICOT's SB02MD agree on these to 2e-12; Ts = 0.1 s,
// T_L = 0.45 s, K_L = 1, τ_h = 1.5 s; first sign turned to the paper's distance error.
TEST(CruiseDesign, ReproducesTheGainsOfTwoOtherSolvers) {
  struct Case {
    Eigen::Vector3d weights;
    double r;
    Eigen::RowVector3d K;
  };
  const Case cases[] = {
      {{1, 1, 0}, 1, {0.9114729761, -1.0770738145, 0.7962551427}},
      {{1, 1, 0}, 10, {0.3020879692, -0.6163789658, 0.4023529318}},
      {{1, 2, 0.5}, 5, {0.4200128007, -0.8000870214, 0.5421650321}},
      {{0.04, 1, 0.5}, 1, {0.1863068082, -0.9609544150, 0.5908564297}},
  };
  for (const auto& [weights, r, K] : cases) {
    const CruiseDesign design = design_cruise({.state_weights = weights, .input_weight = r});
    EXPECT_LT((design.K - K).cwiseAbs().maxCoeff(), 2e-10);
  }
}

TEST(CruiseDesign, ReproducesTheFilterGainOfAnotherSolver) {
  Eigen::Matrix3d L;  // filter form; scipy, the same three variances as the defaults
  L << 0.04006845155, -0.07317348333, 0.01035450067,  //
      -0.01170775733, 0.38904618153, -0.00186956829,  //
      0.00041418003, -0.00046739207, 0.02592785570;
  EXPECT_LT((design_cruise({}).L - L).cwiseAbs().maxCoeff(), 2e-11);
}

// Ten thousand Euler steps of the continuous model of paper section 3.3 in one sampling period.
TEST(CruiseDesign, DiscreteModelFollowsTheContinuousOne) {
  const CruiseOptions options{.headway_s = 1.2, .actuator_lag_s = 0.3, .actuator_gain = 0.9};
  const CruiseModel model = discretise(options);
  const Eigen::Vector3d start{2.0, -1.5, 0.7};
  const double u = -1.1, a_p = 0.8;
  Eigen::Vector3d x = start;
  const int steps = 1'000'000;
  const double dt = options.step_s / steps;
  for (int k = 0; k < steps; ++k) {
    x += dt * Eigen::Vector3d(-x[1] + options.headway_s * x[2], a_p - x[2],
                              (options.actuator_gain * u - x[2]) / options.actuator_lag_s);
  }
  EXPECT_LT((model.A * start + model.B * u + model.G * a_p - x).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(CruiseDesign, EveryPoleLiesInsideTheUnitCircle) {
  const CruiseDesign design = design_cruise({});
  for (const auto& pole : design.poles) EXPECT_LT(std::abs(pole), 1.0);
  for (const auto& pole : design.filter_poles) EXPECT_LT(std::abs(pole), 1.0);
  // det(A − BK) is the product of the poles.
  const auto product = design.poles[0] * design.poles[1] * design.poles[2];
  const double determinant = (design.model.A - design.model.B * design.K).determinant();
  EXPECT_NEAR(product.real(), determinant, 1e-12);
}

// The frequency response is what a sine drives the sampled loop to.
TEST(CruiseDesign, StringGainIsTheAmplitudeOfASineThatSettled) {
  const CruiseOptions options{.input_weight = 10.0};
  const CruiseDesign design = design_cruise(options);
  const StringGain largest = string_gain(design, options.step_s);
  EXPECT_GT(largest.gain, 1.005);  // this design amplifies
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  double amplitude = 0.0;
  for (int k = 0; k < 20'000; ++k) {
    const double a_p = std::sin(largest.at_radps * options.step_s * k);
    x = design.model.A * x - design.model.B * design.K.dot(x) + design.model.G * a_p;
    if (k > 10'000) amplitude = std::max(amplitude, std::abs(x[2]));
  }
  EXPECT_NEAR(amplitude, largest.gain, 1e-4);
}

std::string message_of(const CruiseOptions& options) {
  try {
    design_cruise(options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(CruiseDesign, UnusableDesignsAreRefusedByName) {
  EXPECT_THAT(message_of({.actuator_gain = 0.0}), testing::HasSubstr("not controllable: rank 0"));
  EXPECT_THAT(message_of({.state_weights = {0, 1, 0}}), testing::HasSubstr("√Q"));
  EXPECT_THAT(message_of({.input_weight = 0.0}), testing::HasSubstr("input weight"));
  EXPECT_THAT(message_of({.input_weight = std::numeric_limits<double>::quiet_NaN()}),
              testing::HasSubstr("input weight"));
  EXPECT_THAT(message_of({.step_s = 0.0}), testing::HasSubstr("sampling time"));
  EXPECT_THAT(message_of({.state_weights = {1, -1, 0}}), testing::HasSubstr("state weights"));
  EXPECT_THAT(message_of({.measurement_noise_variance = {0, 1, 1}}),
              testing::HasSubstr("measurement variances"));
}

}  // namespace
}  // namespace roadbed::control
