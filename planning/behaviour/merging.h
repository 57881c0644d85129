#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/planning/behaviour/driving_task.h"
#include "roadbed/planning/behaviour/merge_gap.h"
#include "roadbed/planning/behaviour/right_of_way.h"
#include "roadbed/planning/obstacles/movers_on_line.h"

namespace roadbed::planning::inline behaviour {

/// Where a route changes to the next lane of its direction.
struct MergePlace {
  double hold_s_m = 0.0;    ///< of the line: here the front waits without being in anybody's way
  double enter_s_m = 0.0;   ///< of the line: beyond it the front is in the way of the next lane
  double out_s_m = 0.0;     ///< of the line: the vehicle drives in the next lane
  geometry::Polyline lane;  ///< middle of the next lane, from where it can be looked at
  double enter_m = 0.0;     ///< station of that, beside enter_s_m
};

/// All changes of a route, by station. The next lane is followed back over its straightest
/// predecessors for 250 m. O(legs · points of the lanes).
std::vector<MergePlace> merge_places(const map::RoadMap& road_map, const Route& route,
                                     const ReferenceLine& line);

/// Whose gap to merge into where the route changes lanes, and how fast to drive up to there.
///
///      ─────────────────────────────────────────────────
///        ▭▶ behind        ·(gap)·     ▭▶ ahead
///      ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─╱─ ─ ─ ─ ─ ─ ─ ─ ─ ─
///        ▭▶ ──── speed adapted ────╱ enter
///      ────────────────────────hold─────────────────────
///
/// The gap is chosen from 150 m before the place on and kept as long as it can be had. Where there
/// is none the vehicle waits before the next lane, and goes when one comes.
class Merging {
 public:
  struct Decision {
    std::optional<StopConstraint> halt = {};  ///< no gap so far
    std::optional<double> most_mps = {};      ///< up to the place, to come into the gap
    std::vector<bool> comes_behind = {};      ///< per obstacle: it will follow; empty: nobody
    /// Obstacle in whose lane the vehicle has come: it is fallen back from gently.
    std::optional<std::size_t> merged_behind = {};
    std::string reason = {};  ///< whose gap; empty: there is nobody

    bool is_near() const { return halt || !comes_behind.empty(); }
  };

  Merging(const geometry::VehicleShape& vehicle, const DrivingTask& task,
          const SpeedCeiling& ceiling);

  Decision look(const ViewOnLine& view);

 private:
  const MergePlace* next_place(double s_m);
  std::vector<MergeMover> movers(const MergePlace& place, const ViewOnLine& view) const;
  Decision entering(const MergePlace& place, const std::vector<MergeMover>& movers,
                    const ViewOnLine& view) const;
  Decision approaching(const MergeGap& gap, const std::vector<MergeMover>& movers,
                       const ViewOnLine& view) const;
  Decision waiting(const MergePlace& place, const MergeGap& gap, const ViewOnLine& view) const;
  bool is_in(const MergePlace& place, const ViewOnLine& view) const;
  std::string name_of(std::size_t obstacle) const;

  const geometry::VehicleShape& vehicle_;
  const DrivingTask& task_;
  const SpeedCeiling& ceiling_;
  std::vector<MergePlace> places_;
  std::size_t next_ = 0;                      ///< the first place that is not behind
  std::optional<MergeGap> taken_;             ///< of the last look
  std::optional<std::size_t> merged_behind_;  ///< at the last place
  bool has_entered_ = false;                  ///< the next place
};

}  // namespace roadbed::planning::behaviour
