#include "roadbed/tools/report/derived_dynamics.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace roadbed::tools::inline report {
namespace {

using Row = geometry::TrajectoryPoint;

constexpr double kHalfWindow_s = 0.5, kStands_mps = 0.5;

bool tells_dynamics(const Row& row) {
  return row.acceleration_mps2 != 0.0 || row.curvature_per_m != 0.0 || row.steering_rad != 0.0;
}

// The rows near one, with its neighbours at least.
std::span<const Row> window_around(const std::vector<Row>& rows, std::size_t i) {
  std::size_t first = i == 0 ? 0 : i - 1, last = std::min(i + 1, rows.size() - 1);
  while (first > 0 && rows[first - 1].t_s >= rows[i].t_s - kHalfWindow_s) --first;
  while (last + 1 < rows.size() && rows[last + 1].t_s <= rows[i].t_s + kHalfWindow_s) ++last;
  return std::span(rows).subspan(first, last - first + 1);
}

// A value over time as a straight line.
struct Line {
  double now, slope;
};

// The one that is nearest to the rows in the least squares.
Line line_through(std::span<const Row> rows, double now_s, double Row::*value) {
  const auto count = static_cast<double>(rows.size());
  double mean_t = 0.0, mean = 0.0;
  for (const Row& row : rows) {
    mean_t += (row.t_s - now_s) / count;
    mean += row.*value / count;
  }
  double with_value = 0.0, with_itself = 0.0;
  for (const Row& row : rows) {
    const double t = row.t_s - now_s - mean_t;
    with_value += t * (row.*value - mean);
    with_itself += t * t;
  }
  const double slope = with_itself > 0.0 ? with_value / with_itself : 0.0;
  return {.now = mean - slope * mean_t, .slope = slope};
}

}  // namespace

geometry::Trajectory with_dynamics(const geometry::Trajectory& drive, double wheelbase_m) {
  if (std::ranges::any_of(drive.points(), tells_dynamics)) return drive;
  std::vector<Row> rows = drive.points();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::span<const Row> near = window_around(drive.points(), i);
    const Line speed = line_through(near, rows[i].t_s, &Row::speed_mps);
    rows[i].acceleration_mps2 = speed.slope;
    if (std::abs(speed.now) < kStands_mps) continue;
    const double yaw_rate_radps = line_through(near, rows[i].t_s, &Row::heading_rad).slope;
    rows[i].curvature_per_m = yaw_rate_radps / speed.now;
    rows[i].steering_rad = std::atan(wheelbase_m * rows[i].curvature_per_m);
  }
  return geometry::Trajectory(std::move(rows));
}

}  // namespace roadbed::tools::report
