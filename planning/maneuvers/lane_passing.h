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

/// A lane of the own direction beside a reference line, on the side on which one passes.
struct PassingLane {
  double from_s_m = 0.0, to_s_m = 0.0;  ///< of the line, where the lane is beside it
  double offset_m = 0.0;                ///< of its middle from the line, positive to the left
  /// Of the line: where the marking may be crossed to get there, and to come back.
  std::vector<map::StationRange> change_windows = {}, return_windows = {};
};

/// All along a route, by station; lanes that follow on one another are one. One passes on the left,
/// unless most lanes of the map that have oncoming traffic beside them have it on the right.
/// O(lanes + legs · length / 5 m).
std::vector<PassingLane> passing_lanes(const map::RoadMap& road_map, const Route& route,
                                       const ReferenceLine& line);

/// The same on a side: 1 left, −1 right.
std::vector<PassingLane> lanes_beside(const map::RoadMap& road_map, const Route& route,
                                      const ReferenceLine& line, double side);

/// Whether to pass slower traffic in the next lane of the own direction, and when to come back.
///
///     ───────────────────────────────────────────────────────
///              ╭── offset ───────────────────╮      ▭▶ behind: has to brake little at most
///     ─ ─ ─ ─ ╱ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ╲─ ─ ─ ─ ─ ─ ─
///      ▭▶────╯          ▭▶ ▭▶ slower           ╰────▶
///     ───────────────────────────────────────────────────────
///
/// It is begun if at least 4 s are gained up to the goal, at the speeds of now; if there is room to
/// pass all who drive closely together, and to come back before the lane or the route ends; and if
/// the next lane has a gap: who drives ahead there is not closed up to, who comes up behind need
/// not brake harder than 2 m/s². While the own lane has not been left yet it is given up when the
/// gap closes. Afterwards the vehicle comes back as soon as there is a gap, and nobody else to
/// pass. Where nothing is gained any more, or the room ahead is used up, it falls back: slower than
/// who is beside until there is a gap, and to a stop before the lane ends at the latest.
class LanePassing {
 public:
  struct Decision {
    std::optional<double> offset_m = {};  ///< of the lane to drive in; none: that of the route
    /// Offsets that keep to the route's lane, towards the passing lane: while somebody drives
    /// ahead.
    std::optional<double> keep_within_m = {};
    /// The same towards a lane of the own direction on the other side, in which nobody is passed.
    std::optional<double> keep_within_on_wrong_side_m = {};
    double side = 1.0;                       ///< on which one passes: 1 left, −1 right
    std::optional<std::size_t> passed = {};  ///< obstacle that is passed
    double lane_end_s_m = 1e9;               ///< of the lane that is driven in: not to be passed
    std::optional<double> most_mps = {};     ///< to fall back with
    std::string reason = {};  ///< why somebody is (not) passed; empty: there is nobody
  };

  LanePassing(const geometry::VehicleShape& vehicle, const DrivingTask& task,
              const SpeedCeiling& ceiling);

  Decision look(const ViewOnLine& view);

 private:
  struct Scene;
  bool closes_lane(const Scene& scene, const MoverOnLine& standing) const;
  const MoverOnLine* lead_of(const Scene& scene) const;
  double gap_m(const Scene& scene, const MoverOnLine& lead) const;
  double gained_s(const Scene& scene, const MoverOnLine& lead) const;
  std::optional<std::string> why_not(const Scene& scene, const MoverOnLine& lead) const;
  std::optional<std::string> why_no_room(const Scene& scene, const MoverOnLine& lead) const;
  std::optional<std::string> why_no_gap(const Scene& scene, double d_m,
                                        std::optional<double> gain_over_mps = {}) const;
  std::optional<double> falls_back_mps(const Scene& scene) const;
  bool may_cross(const Scene& scene, const std::vector<map::StationRange>& windows) const;
  double soon_m(const Scene& scene, const MoverOnLine& lead) const;
  bool may_return(const Scene& scene) const;
  bool has_left_lane(const Scene& scene) const;

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  const SpeedCeiling& ceiling_;
  double side_;  ///< on which one passes
  std::vector<PassingLane> lanes_, lanes_on_wrong_side_;
  std::optional<std::size_t> passed_;
};

}  // namespace roadbed::planning::maneuvers
