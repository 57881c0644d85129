#include "roadbed/tools/report/comfort.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "roadbed/tools/simulation/metrics.h"

namespace roadbed::tools::inline report {
namespace {

using Row = geometry::TrajectoryPoint;

template <typename Value>
ReportCheck comfort_check(const geometry::Trajectory& drive, const char* name, Value value,
                          double bound, const char* unit) {
  Worst worst{-std::numeric_limits<double>::infinity(), 0.0};
  for (const Row& row : drive.points()) {
    if (value(row) > worst.value) worst = {value(row), row.t_s};
  }
  return at_most(name, worst, bound, unit, "comfort, nuPlan");
}

}  // namespace

ReportCheck at_most(std::string name, const Worst& worst, double bound, std::string unit,
                    std::string bound_from) {
  return {.name = std::move(name),
          .value = worst.value,
          .unit = std::move(unit),
          .bound = fmt::format("≤ {}", bound),
          .passed = worst.value <= bound,
          // Where nothing is exceeded at any time, no moment is worth a visit.
          .at_s = worst.value > 0.0 ? std::optional(worst.at_s) : std::nullopt,
          .bound_from = std::move(bound_from)};
}

std::vector<ReportCheck> comfort_checks(const geometry::Trajectory& drive) {
  return {comfort_check(
              drive, "strongest acceleration", [](const Row& p) { return p.acceleration_mps2; },
              kMostAcceleration_mps2, "m/s²"),
          comfort_check(
              drive, "strongest braking", [](const Row& p) { return -p.acceleration_mps2; },
              -kLeastAcceleration_mps2, "m/s²"),
          comfort_check(
              drive, "largest lateral acceleration",
              [](const Row& p) { return std::abs(p.speed_mps * p.speed_mps * p.curvature_per_m); },
              kMostLateralAcceleration_mps2, "m/s²"),
          comfort_check(
              drive, "largest yaw rate",
              [](const Row& p) { return std::abs(p.speed_mps * p.curvature_per_m); },
              kMostYawRate_radps, "rad/s")};
}

}  // namespace roadbed::tools::report
