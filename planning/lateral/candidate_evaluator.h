#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/lateral/batch_cost_kernel.h"
#include "roadbed/planning/lateral/batch_sample.h"
#include "roadbed/planning/lateral/candidates.h"
#include "roadbed/planning/lateral/collision.h"
#include "roadbed/planning/lateral/plan_types.h"
#include "roadbed/planning/obstacles/road_border.h"

namespace roadbed::planning::inline lateral {

/// A batch at one station: d, and p′ = (along + i across) e^{iψ}, are linear in d_e, the first
/// number and the second times d_e; and what a stretch there adds to duration and length.
struct LinearPoint {
  double d_m[2], along[2], across[2];
  double seconds_before, metres_before;  ///< of the section that ends there, half of it
};

std::vector<LinearPoint> linear_points(const std::vector<Station>& stations,
                                       const QuinticFamily& family);

/// How long some candidates of a batch take, and how far they drive, to one of its stations.
struct PartialArcLengths {
  using Lanes = std::array<double, kSimdWidth>;
  Lanes duration_s{}, driven_m{};  ///< from the start, as drive_along() finds them
};

/// To the last of the points.
/// @param end_d_m  of the offsets, at most kSimdWidth.
PartialArcLengths partial_arc_lengths(std::span<const LinearPoint> points,
                                      std::span<const double> end_d_m);

/// A candidate, and on at d_e up to the length of the longest one.
struct CandidateDrive {
  std::vector<Station> stations;
  std::vector<geometry::TrajectoryPoint> points;  ///< at most one per station
};

/// The body on a candidate at one station.
struct CandidateBody {
  geometry::Rectangle body;
  double s_m = 0.0, l_m = 0.0;       ///< of the rear axle
  double t_s = 0.0, driven_m = 0.0;  ///< 0 if not asked for
  bool is_there = true;              ///< a drive ends where it would fold past its end
};

/// What all candidates of one planning cycle are judged against. Stations of a batch are made when
/// they are asked for, and kept.
class CandidateEvaluator {
 public:
  /// All of them are kept by reference.
  CandidateEvaluator(const PlanInput& input, const geometry::VehicleShape& vehicle,
                     const PlanOptions& options);
  CandidateEvaluator(const CandidateEvaluator&) = delete;
  CandidateEvaluator& operator=(const CandidateEvaluator&) = delete;

  /// Other safety margins from now on.
  void set_margins(const SafetyMargins& margins);

  const PlanInput& input() const { return input_; }
  const geometry::VehicleShape& vehicle() const { return vehicle_; }
  const PlanOptions& options() const { return options_; }
  const SafetyMargins& margins() const { return margins_; }
  const Grid& grid() const { return grid_; }
  const CycleContext& context() const { return context_; }
  const CollisionScene& scene() const { return scene_; }
  const CollisionChecker& collision() const { return collision_; }
  const RoadBorder& border() const { return border_; }

  /// What is wrong with the start, that none of the candidates can help; empty if nothing is.
  std::string fault_of_start() const;

  CostFrame frame(std::size_t batch) const;
  const QuinticFamily& family(std::size_t batch) const { return families_[batch]; }
  geometry::Quintic quintic(std::size_t index) const;

  /// Not kept.
  std::vector<Station> make_stations(std::size_t batch) const;
  const std::vector<Station>& stations(std::size_t batch);
  /// One per station.
  const std::vector<LinearPoint>& linear(std::size_t batch);
  /// Stations of the longest batch that are farther than this are part of the drives of a length.
  double past_end_from_m(double end_l_m) const;

  CandidateDrive drive(std::size_t index);

  /// How much farther than allowed a body sticks out of the corridor [m].
  double excess_m(const CandidateBody& at) const;
  /// The same of a point of a drive.
  double excess_m(const CandidateDrive& drive, std::size_t point) const;

  struct BodyQuestion {
    bool with_lengths = false;  ///< time and length from the start are asked for
    int parts = 1;              ///< that the way between two stations is divided into
  };
  /// The bodies of some offsets of a batch (at most kSimdWidth) at one of its stations, or past its
  /// end at one of the longest batch, or between two of them: at the place nearest to a length.
  /// None where that is not on a candidate's drive.
  std::vector<CandidateBody> bodies(std::size_t batch, std::span<const double> end_d_m, double l_m,
                                    const BodyQuestion& asked);

 private:
  double start_excess_m() const;
  std::vector<CandidateBody> bodies_at(std::size_t batch, std::size_t station,
                                       std::span<const double> end_d_m, bool with_lengths);
  std::vector<CandidateBody> bodies_past_end(std::size_t batch, std::size_t station,
                                             std::span<const double> end_d_m, bool with_lengths);

  const PlanInput& input_;
  const geometry::VehicleShape& vehicle_;
  const PlanOptions& options_;
  SafetyMargins margins_;
  Grid grid_;
  RoadBorder border_;
  CollisionScene scene_;
  CollisionChecker collision_;
  CycleContext context_;
  std::vector<QuinticFamily> families_;  // one per l_e
  // One list per l_e, empty until it is asked for.
  std::vector<std::vector<Station>> stations_;
  std::vector<std::vector<LinearPoint>> linear_;
};

}  // namespace roadbed::planning::lateral
