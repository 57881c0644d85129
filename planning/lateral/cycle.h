#pragma once

#include <span>
#include <vector>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/planning/lateral/collision.h"
#include "roadbed/planning/lateral/lane_ways.h"
#include "roadbed/planning/lateral/plan.h"
#include "roadbed/planning/lateral/row_station.h"
#include "roadbed/planning/obstacles/road_border.h"

namespace roadbed::planning::inline lateral {

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

/// What all candidates of one planning cycle are judged against. Stations of a row are made when
/// they are asked for, and kept.
class Cycle {
 public:
  /// All of them are kept by reference.
  Cycle(const PlanInput& input, const geometry::VehicleShape& vehicle, const PlanOptions& options);
  Cycle(const Cycle&) = delete;
  Cycle& operator=(const Cycle&) = delete;

  /// Another room from now on.
  void set_room(const Room& room);

  const PlanInput& input() const { return input_; }
  const geometry::VehicleShape& vehicle() const { return vehicle_; }
  const PlanOptions& options() const { return options_; }
  const Room& room() const { return room_; }
  const Grid& grid() const { return grid_; }
  const Course& course() const { return course_; }
  const CollisionScene& scene() const { return scene_; }
  const CollisionChecker& collision() const { return collision_; }

  CostFrame frame(std::size_t row) const;
  const QuinticFamily& family(std::size_t row) const { return families_[row]; }
  geometry::Quintic quintic(std::size_t index) const;

  /// Not kept.
  std::vector<Station> make_stations(std::size_t row) const;
  const std::vector<Station>& stations(std::size_t row);

  CandidateDrive drive(std::size_t index);

  /// How much farther than allowed a body sticks out of the corridor [m].
  double excess_m(const CandidateBody& at) const;
  /// The same of a point of a drive.
  double excess_m(const CandidateDrive& drive, std::size_t point) const;

  /// The bodies of some lanes of a row (at most kLanesPerBlock) at one of its stations, or past its
  /// end at one of the longest row: at the one nearest to a length. None where that is no point of
  /// a candidate's drive.
  /// @param with_way  time and length from the start are asked for.
  std::vector<CandidateBody> bodies(std::size_t row, std::span<const double> end_d_m, double l_m,
                                    bool with_way);

 private:
  double start_excess_m() const;
  std::vector<CandidateBody> bodies_at(std::size_t row, std::size_t station,
                                       std::span<const double> end_d_m, bool with_way);
  std::vector<CandidateBody> bodies_past_end(std::size_t row, std::span<const double> end_d_m,
                                             double l_m, bool with_way);
  double past_end_from_m(double end_l_m) const;
  const std::vector<LinearPoint>& linear(std::size_t row);

  const PlanInput& input_;
  const geometry::VehicleShape& vehicle_;
  const PlanOptions& options_;
  Room room_;
  Grid grid_;
  RoadBorder border_;
  CollisionScene scene_;
  CollisionChecker collision_;
  Course course_;
  std::vector<QuinticFamily> families_;  // one per l_e
  // One list per l_e, empty until it is asked for.
  std::vector<std::vector<Station>> stations_;
  std::vector<std::vector<LinearPoint>> linear_;
};

}  // namespace roadbed::planning::lateral
