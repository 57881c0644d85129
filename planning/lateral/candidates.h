#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "roadbed/geometry/curves/frenet.h"
#include "roadbed/geometry/curves/quintic.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/motion/vehicle_shape.h"
#include "roadbed/planning/lateral/cost_terms.h"
#include "roadbed/planning/lateral/planned_speed.h"
#include "roadbed/planning/reference/reference_line.h"

namespace roadbed::planning::inline lateral {

/// Where a candidate starts, in the frame of the reference line (paper eq. 13–15 at l = 0).
struct LateralState {
  double s_m = 0.0;
  double d_m = 0.0;
  double d_slope = 0.0;            ///< dd/ds
  double d_curvature_per_m = 0.0;  ///< d²d/ds²
};

/// Why a candidate was not taken.
enum class Rejection {
  none,              ///< feasible, only dearer
  off_road,          ///< leaves the corridor
  beyond_curvature,  ///< 1 − κ d is not safely positive, or the vehicle cannot steer it
  lateral_acceleration,
  steering_rate,  ///< the wheels cannot be turned that fast at that speed
  collision,
};
inline constexpr int kRejections = 6;
std::string_view to_string(Rejection rejection);

/// A quintic d(l) over [0, l_e] ahead of the start (paper eq. 13–22).
struct Candidate {
  double end_d_m = 0.0;
  double end_l_m = 0.0;
  CostTerms terms{};
  double cost = 0.0;
  Rejection rejection = Rejection::none;
};

/// Whether of two candidates whose costs differ by rounding only (kEqualCost) the first is to be
/// taken: smaller |d_e|, then longer l_e, then the left one.
bool is_preferred(const Candidate& a, const Candidate& b);

/// Where the end states lie: multiples of the steps inside the ranges.
struct GridRange {
  double d_step_m, min_d_m, max_d_m;
  double l_step_m, min_l_m, max_l_m;
};

/// All end states (d_e, l_e) of one cycle. Candidates of one length l_e are a
/// batch; they differ in their end offset d_e.
/// Built from integers, so that neither rounding nor an end of a range loses a candidate.
class Grid {
 public:
  /// @throws std::invalid_argument if a range or step is not usable, or holds no multiple.
  explicit Grid(const GridRange& range);

  std::size_t offset_count() const { return end_d_m_.size(); }
  std::size_t length_count() const { return end_l_m_.size(); }
  std::size_t size() const { return offset_count() * length_count(); }
  const std::vector<double>& end_d_m() const { return end_d_m_; }  ///< ascending
  const std::vector<double>& end_l_m() const { return end_l_m_; }  ///< ascending
  double max_l_m() const { return end_l_m_.back(); }

  /// Candidates are numbered with d_e fastest.
  double end_d_m(std::size_t index) const { return end_d_m_[index % offset_count()]; }
  double end_l_m(std::size_t index) const { return end_l_m_[index / offset_count()]; }  ///< too

 private:
  std::vector<double> end_d_m_, end_l_m_;
};

/// What all candidates share at one station.
struct Station {
  double l_m = 0.0;  ///< ahead of the start
  ReferencePoint line;
  PlannedSpeed::State speed{};
  std::optional<double> previous_d_m;   ///< of the last plan; none: there is none
  double min_d_m = 0.0, max_d_m = 0.0;  ///< that keep the rear axle's full width in the corridor
};

/// Least 1 − κ d of a candidate: nearer to the centre of curvature it is folded, and the closed
/// forms lose their digits.
inline constexpr double kLeastUnfolded = 0.05;
/// Slack of limits, so that a candidate on a limit is not lost to rounding.
inline constexpr double kLimitSlack = 1e-9;

/// Limits of one cycle.
struct DrivingLimits {
  double max_curvature_per_m = 0.0;  ///< of the steering
  double max_lateral_acceleration_mps2 = 0.0;
  double max_steering_rate_radps = kNoLimit;
  double wheelbase_m = 1.0;  ///< for the steering rate

  static constexpr double kNoLimit = 1e100;
};

/// What the vehicle can drive: tan(max_steering) / wheelbase, and the given acceleration. The
/// steering rate stays without a limit.
DrivingLimits driving_limits(const geometry::VehicleShape& vehicle,
                             double max_lateral_acceleration_mps2);

/// What all stations of a cycle are made from.
struct CycleContext {
  const LineView& line;
  LateralState start;
  PlannedSpeed speed;
  const std::function<double(double)>& previous_d_m;  ///< by s; may be empty
  double half_width_m = 0.0;                          ///< of the vehicle, with the border margin
  double start_excess_m = 0.0;                        ///< how far the start is outside the corridor
  double recovery_m = 0.0;  ///< length over which that is allowed to shrink to nothing
};

/// How far outside the corridor a candidate may be `l_m` ahead, 0 if its start is inside.
double allowed_excess_m(const CycleContext& context, double l_m);

/// Values of d that keep the rear axle's full width in the corridor, as far as the start allows.
struct OffsetRange {
  double min_d_m, max_d_m;
};
OffsetRange offsets_on_road(const CycleContext& context, double l_m);

Station station_at(const CycleContext& context, double l_m);

/// `count` stations, equally spaced over [0, end_l_m].
std::vector<Station> stations_over(const CycleContext& context, double end_l_m, int count);

/// The two quintics that make all candidates of one length: d = at_zero + d_e · per_unit.
struct QuinticFamily {
  QuinticFamily(const LateralState& start, double end_l_m);  ///< of one length
  geometry::Quintic at_zero, per_unit;
  geometry::Quintic member(double end_d_m) const;  ///< that ends there
};

/// κ … κ⁗ of a reference point.
geometry::CurvatureDerivatives curvatures(const ReferencePoint& point);

/// A candidate at every station; empty if it is folded somewhere.
std::vector<CostPoint> cost_points(const std::vector<Station>& stations,
                                   const geometry::Quintic& quintic);

/// First cause, in the order of Rejection, to reject a candidate without looking at obstacles or
/// at the corners of the body; `points` as cost_points() gives them.
Rejection judge(const std::vector<Station>& stations, const geometry::Quintic& quintic,
                const std::vector<CostPoint>& points, const DrivingLimits& limits);

/// The drive along a candidate over the stations, from time `start_t_s`. Past the quintic's end
/// d stays; the drive ends early where that would fold. Empty if the candidate itself is folded.
std::vector<geometry::TrajectoryPoint> drive_along(const std::vector<Station>& stations,
                                                   const geometry::Quintic& quintic,
                                                   double start_t_s, double wheelbase_m);

/// Mean speed between two stations, exact for a constant acceleration; a standing vehicle creeps.
double mean_speed_mps(const Station& from, const Station& to);

}  // namespace roadbed::planning::lateral
