#include "roadbed/tools/simulation/metrics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace roadbed::tools::inline simulation {
namespace {

using Values = std::vector<double>;

constexpr int kAccelerationWindow = 8, kJerkWindow = 15, kTurnWindow = 5;

/// Weights of a window's values for the derivative at `place`, counted from its first value.
Eigen::VectorXd weights(int window, int order, int derivative, double place) {
  Eigen::MatrixXd powers(window, order + 1);
  for (int i = 0; i < window; ++i) {
    for (int k = 0; k <= order; ++k) powers(i, k) = std::pow(i - place, k);
  }
  const Eigen::MatrixXd fit =
      powers.completeOrthogonalDecomposition().pseudoInverse();  // coefficients by values
  return std::tgamma(derivative + 1.0) * fit.row(derivative).transpose();
}

double at_window(const Values& values, std::size_t from, const Eigen::VectorXd& by) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < by.size(); ++i)
    sum += by[i] * values[from + static_cast<std::size_t>(i)];
  return sum;
}

double largest(const Values& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

/// All rows, without the last one if the drive ended between two.
std::vector<geometry::TrajectoryPoint> equally_spaced(const geometry::Trajectory& drive) {
  std::vector<geometry::TrajectoryPoint> rows = drive.points();
  const std::size_t n = rows.size();
  constexpr double kRounding_s = 1e-6;
  if (n > 2 &&
      std::abs(rows[n - 1].t_s - rows[n - 2].t_s - rows[1].t_s + rows[0].t_s) > kRounding_s) {
    rows.pop_back();
  }
  return rows;
}

template <typename Value>
Values signal(const std::vector<geometry::TrajectoryPoint>& rows, Value value) {
  Values values;
  for (const geometry::TrajectoryPoint& row : rows) values.push_back(value(row));
  return values;
}

}  // namespace

Values savitzky_golay(const Values& values, double step_s, int window, int order, int derivative) {
  const int count = static_cast<int>(values.size());
  window = std::min(window, count);
  if (order < 0 || order >= window || derivative < 0 || derivative > order) {
    throw std::invalid_argument("savitzky_golay: the order must be less than the window");
  }
  const int half = window / 2;
  const double middle = 0.5 * (window - 1);
  const double scale = std::pow(step_s, -derivative);
  const Eigen::VectorXd inside = weights(window, order, derivative, middle);
  Values result;
  for (int i = 0; i < count; ++i) {
    const int ahead = window - half - 1 + (window % 2 == 0 ? 1 : 0);
    const int behind = window - 1 - ahead;
    if (i < half) {
      result.push_back(scale * at_window(values, 0, weights(window, order, derivative, i)));
    } else if (i >= count - half) {
      const int from = count - window;
      result.push_back(scale * at_window(values, static_cast<std::size_t>(from),
                                         weights(window, order, derivative, i - from)));
    } else {
      result.push_back(scale * at_window(values, static_cast<std::size_t>(i - behind), inside));
    }
  }
  return result;
}

Comfort comfort_of(const geometry::Trajectory& drive) {
  Comfort comfort;
  const std::vector<geometry::TrajectoryPoint> rows = equally_spaced(drive);
  if (rows.size() < kTurnWindow) return comfort;  // nothing to smooth over
  const double step_s = rows[1].t_s - rows[0].t_s;
  const auto smooth = [&](const Values& values, int window, int order, int derivative) {
    return savitzky_golay(values, step_s, window, order, derivative);
  };
  const auto across = [](const geometry::TrajectoryPoint& row) {
    return row.curvature_per_m * row.speed_mps * row.speed_mps;
  };
  const Values along = smooth(signal(rows, [](const auto& row) { return row.acceleration_mps2; }),
                              kAccelerationWindow, 2, 0);
  const Values magnitude = smooth(
      signal(rows, [&](const auto& row) { return std::hypot(row.acceleration_mps2, across(row)); }),
      kAccelerationWindow, 2, 0);
  const Values heading = signal(rows, [](const auto& row) { return row.heading_rad; });
  comfort.least_longitudinal_mps2 = *std::ranges::min_element(along);
  comfort.most_longitudinal_mps2 = *std::ranges::max_element(along);
  comfort.most_lateral_mps2 = largest(smooth(signal(rows, across), kAccelerationWindow, 2, 0));
  comfort.most_yaw_rate_radps = largest(smooth(heading, kTurnWindow, 2, 1));
  comfort.most_yaw_acceleration_radps2 = largest(smooth(heading, kTurnWindow, 3, 2));
  comfort.most_longitudinal_jerk_mps3 = largest(smooth(along, kJerkWindow, 2, 1));
  comfort.most_jerk_mps3 = largest(smooth(magnitude, kJerkWindow, 2, 1));
  return comfort;
}

bool Comfort::is_comfortable() const {
  return least_longitudinal_mps2 >= kLeastAcceleration_mps2 &&
         most_longitudinal_mps2 <= kMostAcceleration_mps2 &&
         most_lateral_mps2 <= kMostLateralAcceleration_mps2 &&
         most_yaw_acceleration_radps2 <= kMostYawAcceleration_radps2 &&
         most_yaw_rate_radps <= kMostYawRate_radps &&
         most_longitudinal_jerk_mps3 <= kMostLongitudinalJerk_mps3 &&
         most_jerk_mps3 <= kMostJerk_mps3;
}

}  // namespace roadbed::tools::simulation
