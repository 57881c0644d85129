#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/obstacles/movers_on_line.h"
#include "roadbed/planning/obstacles/traffic.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/reference/speed_ceiling.h"
#include "roadbed/planning/route/route.h"
#include "roadbed/planning/task/driving_task.h"

namespace roadbed::planning::inline maneuvers {

/// A stretch of a reference line beside which the lane of oncoming traffic may be used:
/// the marking between may be crossed there.
struct OncomingLaneSegment {
  double from_s_m = 0.0, to_s_m = 0.0;
  double side = 1.0;        ///< of that lane: 1 left, −1 right
  double own_edge_m = 0.0;  ///< least distance from the line to that lane
  double limit_mps = 0.0;   ///< greatest speed that is allowed there
};

/// All of a route, by station; stretches of lanes that follow on one another are one. Where a lane
/// of the own direction lies between there is none. O(legs + length / 5 m).
std::vector<OncomingLaneSegment> oncoming_lane_segments(const map::RoadMap& road_map,
                                                        const Route& route,
                                                        const ReferenceLine& line);

/// Whether to overtake a slower vehicle through the lane of oncoming traffic.
///
///     s ▲                       ╲  oncoming, at worst: speeding up to the limit and a tenth
///       │              ╱ margin  ╲
///       │     back ╱●╱─ ─ ─ ─ ─ ─ ╲
///       │       ╱╱   ╱ lead
///       │   ╱●╱  ╱╱╱              ●  in the other lane, from the first to the second
///       └──────────────────────────▶ t
///
/// It is begun, past somebody who does not brake, if, accelerating as the cruise control does, the
/// vehicle is back in its lane, with
/// distance to the one overtaken and to whoever drives ahead of that one, before the nearest
/// oncoming vehicle is there at its worst; and if it can be given up, by braking and falling back
/// behind the one overtaken, until the front is beside that one's rear. Where nobody is seen to
/// come, somebody may be where the other lane is first hidden; to see past the one ahead the
/// vehicle drives at the edge of its lane. All of this is asked again in each cycle: what can no
/// longer be ended in time is given up while that is possible. Where the vehicle may not, or does
/// not want to, it keeps to its own lane as long as the one ahead moves or waits, as in a queue;
/// what stands for good is passed as the lateral planner chooses, but not before who is oncoming
/// and would be there, at its worst, before the vehicle is back.
class Overtaking {
 public:
  /// What the lateral planner is asked for.
  struct Decision {
    std::optional<double> keep_within_m = {};   ///< offsets towards the other lane, up to this one
    std::optional<double> pass_at_m = {};       ///< offset to overtake at
    std::optional<std::size_t> overtaken = {};  ///< obstacle that is being overtaken
    bool falls_back = false;                    ///< overtaking is given up: get behind it
    double gap_m = 0.0;                         ///< to its rear; less than 0 beside it
    double side = 1.0;                          ///< of the other lane: 1 left, −1 right
    bool looks_past = false;  ///< more of the other lane is seen from where `keep_within_m` ends
    /// Station to wait at, with room to pull out again, for who is oncoming; none: nobody is.
    std::optional<double> waits_at_s_m = {};
    std::string reason = {};  ///< why it is (not) overtaken; empty: nobody to overtake
  };

  Overtaking(const geometry::VehicleShape& vehicle, const DrivingTask& task,
             const SpeedCeiling& ceiling);

  Decision look(const ViewOnLine& view);

 private:
  struct State;
  struct Course;
  const MoverOnLine* nearest_ahead(const std::vector<MoverOnLine>& movers,
                                   const ViewOnLine& view) const;
  bool waits(const MoverOnLine& mover, double t_s) const;
  double pass_at_m(const MoverOnLine& lead, const OncomingLaneSegment& stretch) const;
  const OncomingLaneSegment* stretch_at(double s_m) const;
  std::optional<std::string> why_not(const State& from, const MoverOnLine& lead,
                                     const std::vector<MoverOnLine>& movers,
                                     const OncomingLaneSegment& stretch) const;
  std::optional<std::string> who_is_in_the_way(const Course& course, const MoverOnLine& lead,
                                               const std::vector<MoverOnLine>& movers,
                                               const OncomingLaneSegment& stretch) const;
  std::optional<Decision> waits_for_oncoming(const ViewOnLine& view,
                                             const std::vector<MoverOnLine>& movers) const;
  bool can_fall_back(const State& from, const MoverOnLine& lead,
                     const std::vector<MoverOnLine>& movers,
                     const OncomingLaneSegment& stretch) const;
  std::optional<State> past(State state, const MoverOnLine& lead) const;
  State back_from(const State& past) const;
  State beside_rear(State state, const MoverOnLine& lead) const;
  bool is_no_matter(const MoverOnLine& mover, const State& now, double pass_at_m) const;
  std::optional<MoverOnLine> hidden_oncoming(const ViewOnLine& view,
                                             const std::vector<MoverOnLine>& movers,
                                             const OncomingLaneSegment& stretch) const;
  double missing_m(const MoverOnLine& mover, double now_s_m, const State& past, const State& back,
                   double limit_mps) const;
  const MoverOnLine* lead_of(const std::vector<MoverOnLine>& movers, const ViewOnLine& view) const;
  bool has_ended(const ViewOnLine& view, const MoverOnLine& lead) const;
  State step(State state) const;

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  const SpeedCeiling& ceiling_;
  std::vector<OncomingLaneSegment> stretches_;
  std::optional<std::size_t> overtaken_;
  bool falls_back_ = false;
};

}  // namespace roadbed::planning::maneuvers
