#include "roadbed/planning/behaviour/cruise_forecast.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "roadbed/planning/reference/speed_ceiling.h"
#include "roadbed/planning/speed/safe_way_on.h"
#include "roadbed/planning/speed/speed_controller.h"

namespace roadbed::planning::inline behaviour {
namespace {

constexpr double kAnswersIn_s = 0.5;  // to a speed that is missing or too much
constexpr int kSpeedSteps = 3;        // over which the speed of others is taken

class Forecast {
 public:
  Forecast(const CruiseForecastQuestion& question, const DecisionOptions& options)
      : q_(question), options_(options), ignored_(question.no_matter) {
    for (const StInterval& part : q_.occupancy.at(0)) {
      if (holds(part, 0.0)) ignore(part.obstacle);
    }
  }

  CruiseForecast run() {
    CruiseForecast forecast{.drive = {.is_free = true, .cost = 0.0, .plan = {}}, .met = {}};
    SpeedSearchAnswer& drive = forecast.drive;
    SpeedState at{.t_s = 0.0,
                  .ahead_m = 0.0,
                  .speed_mps = q_.speed_mps,
                  .acceleration_mps2 = q_.acceleration_mps2};
    drive.plan.push_back(at);
    const int steps = static_cast<int>(q_.occupancy.times()) - 1;
    for (int k = 0; k < steps; ++k) {
      at = after(at, wanted_mps(at, k));
      drive.plan.push_back(at);
      forecast.met = who_is_met(k + 1, at.ahead_m);
      drive.is_free = !forecast.met;
      if (!drive.is_free) break;
      drive.free_until_s = at.t_s;
    }
    if (drive.is_free) {
      constexpr double kNoEnd_m = std::numeric_limits<double>::infinity();  // it stops by its law
      forecast.met = who_bars_way_on(at, q_.occupancy, kNoEnd_m, who_is_no_lead());
      drive.is_free = !forecast.met;
    }
    return forecast;
  }

 private:
  static bool holds(const StInterval& part, double ahead_m) {
    return ahead_m > part.from_m && ahead_m < part.to_m;
  }

  void ignore(std::size_t obstacle) {
    if (obstacle < ignored_.size()) ignored_[obstacle] = true;
  }

  bool is_ignored(const StInterval& part) const {
    return part.obstacle < ignored_.size() && ignored_[part.obstacle];
  }

  bool crosses(const StInterval& part) const {
    return part.obstacle < q_.crosses.size() && q_.crosses[part.obstacle];
  }

  std::vector<bool> who_is_no_lead() const {
    std::vector<bool> none = ignored_;
    none.resize(std::max(ignored_.size(), q_.crosses.size()));
    for (std::size_t i = 0; i < q_.crosses.size(); ++i) none[i] = none[i] || q_.crosses[i];
    return none;
  }

  std::optional<std::size_t> who_is_met(int step, double ahead_m) const {
    for (const StInterval& part : q_.occupancy.at(step)) {
      if (!is_ignored(part) && holds(part, ahead_m)) return part.obstacle;
    }
    return std::nullopt;
  }

  std::optional<double> rear_m(std::size_t obstacle, int step) const {
    for (const StInterval& part : q_.occupancy.at(step)) {
      if (part.obstacle == obstacle) return part.from_m;
    }
    return std::nullopt;
  }

  /// None: it will have left at once.
  std::optional<Lead> lead_of(const StInterval& part, int step, double ahead_m) const {
    const auto soon_m = rear_m(part.obstacle, step + kSpeedSteps);
    const auto later_m = rear_m(part.obstacle, step + 2 * kSpeedSteps);
    if (!soon_m) return std::nullopt;
    constexpr double kOver_s = kSpeedSteps * StGraph::kStep_s;
    const double speed_mps = (*soon_m - part.from_m) / kOver_s;
    const double then_mps = later_m ? (*later_m - *soon_m) / kOver_s : speed_mps;
    return Lead{.obstacle = part.obstacle,
                .gap_m = part.from_m - ahead_m,
                .speed_mps = speed_mps,
                .acceleration_mps2 = (then_mps - speed_mps) / kOver_s};
  }

  double wanted_mps(const SpeedState& at, int step) const {
    double wanted = std::min(q_.profile.wanted_mps[q_.profile.before(at.ahead_m)],
                             stopping_mps(q_.stop_m - at.ahead_m));
    wanted = std::min(
        wanted, speed_before_walkers(q_.walkers, at.ahead_m, options_.deceleration_mps2).speed_mps);
    if (q_.most_mps) wanted = std::min(wanted, *q_.most_mps);
    for (const StInterval& part : q_.occupancy.at(step)) {
      if (is_ignored(part) || crosses(part) || part.from_m < at.ahead_m) continue;
      const std::optional<Lead> lead = lead_of(part, step, at.ahead_m);
      if (!lead) continue;
      wanted = std::min({wanted, approach_speed(*lead, {}, options_).speed_mps, kept_mps(*lead)});
    }
    return wanted;
  }

  /// As the cruise control keeps its gap.
  double kept_mps(const Lead& lead) const {
    const double lead_mps = std::max(0.0, lead.speed_mps);
    const double kept_m = options_.standstill_gap_m + options_.headway_s * lead_mps;
    return std::max(0.0, lead_mps + (lead.gap_m - kept_m) / options_.closing_s);
  }

  double stopping_mps(double distance_m) const {
    return stopping_speed(distance_m, options_.deceleration_mps2).speed_mps;
  }

  SpeedState after(const SpeedState& at, double wanted_mps) const {
    constexpr double kStep_s = StGraph::kStep_s;
    const double command = std::clamp((wanted_mps - at.speed_mps) / kAnswersIn_s,
                                      -kMostCommand_mps2, options_.acceleration_mps2);
    SpeedState next = at;
    next.t_s += kStep_s;
    next.command_mps2 = command;
    next.acceleration_mps2 += (command - at.acceleration_mps2) * kStep_s / kActuatorLag_s;
    next.speed_mps = std::max(0.0, at.speed_mps + next.acceleration_mps2 * kStep_s);
    next.ahead_m += 0.5 * (at.speed_mps + next.speed_mps) * kStep_s;
    return next;
  }

  const CruiseForecastQuestion& q_;
  const DecisionOptions& options_;
  std::vector<bool> ignored_;
};

}  // namespace

CruiseForecast forecast_cruise(const CruiseForecastQuestion& question,
                               const DecisionOptions& options) {
  return Forecast(question, options).run();
}

}  // namespace roadbed::planning::behaviour
