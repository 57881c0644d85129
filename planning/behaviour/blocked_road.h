#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/planning/behaviour/detour.h"
#include "roadbed/planning/obstacles/traffic.h"

namespace roadbed::planning::inline behaviour {

/// Whether the road is blocked for the vehicle, and what it does then.
///
///                        queue: nobody in it has moved for 10 s
///               ┌─────────────────────────────────┐
///      ▭▶ 5 m   ▭  ≤ 15 m   ▭  ≤ 15 m   ▬▬▬▬▬▬▬        ¦ no red light, no line to wait at
///       \ another route, if it can still be joined
///
/// Blocked is the road when the vehicle has stood for 10 s behind somebody who stands, and of those
/// who stand before that one, each within 15 m of the next, nobody has moved either. Whoever moves
/// on, a light on the route that is not green up to 30 m before the first of them, and a rule that
/// the vehicle itself waits for begin the wait anew; where the first of them may itself wait at a
/// sign or to turn, and in a jam of three or more who may drive on, it is 60 s. Then another route
/// is asked for, once; the obstacles that are passed over stay known (`DrivingTask::blockers`) as
/// long as they stand.
class BlockedRoad {
 public:
  struct View {
    double t_s;
    const VehicleState& measured;
    Traffic traffic;
    std::optional<std::size_t> ahead;  ///< obstacle for which the vehicle stands
    bool waits_for_rule;               ///< a light, a sign, or those who have the right of way
  };

  struct Decision {
    std::string reason;            ///< who blocks, and which way round there is, or why none
    bool is_news;                  ///< it was asked for in this cycle
    std::optional<Detour> detour;  ///< to be taken; only in that cycle
    std::vector<std::size_t> blockers = {};  ///< who has not moved, and may be passed: no jam
  };

  BlockedRoad(const geometry::VehicleShape& vehicle, const DrivingOptions& driving,
              const DrivingTask& task)
      : vehicle_(vehicle), driving_(driving), task_(task) {}

  /// To be asked once a cycle. None: the road is not blocked, or not for long enough.
  std::optional<Decision> look(const View& view);

 private:
  std::vector<std::size_t> queue_ahead(const View& view, double& front_s_m) const;
  bool has_moved_on(const View& view) const;
  bool stands_at_light(const View& view, double queue_front_s_m) const;
  bool is_jam(const View& view) const;
  double patience_s(const View& view, double queue_front_s_m) const;
  DetourAnswer ask(const View& view) const;
  std::string describe(const View& view, const DetourAnswer& answer) const;

  const geometry::VehicleShape& vehicle_;
  DrivingOptions driving_;
  const DrivingTask& task_;
  std::vector<std::size_t> queue_;  ///< of the last look, the nearest first
  double since_s_ = 0.0;            ///< nobody in it has moved
  std::string reason_;              ///< of what was asked; empty: not asked yet
};

}  // namespace roadbed::planning::behaviour
