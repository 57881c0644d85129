#pragma once

#include <optional>
#include <string>

#include "roadbed/planning/behaviour/detour.h"
#include "roadbed/planning/maneuvers/merging.h"

namespace roadbed::planning::inline behaviour {

/// Whether the vehicle drives on along its own lane, by another route, where nobody leaves a gap
/// for the lane change that its route needs.
///
///        ▭▶   ▭▶  ▭▶   ▭▶   ▭▶   ▭▶  ▭▶      no gap to merge into
///     ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─ ─
///          ▭▶ ─────────────────╎─────────▶   another route, instead of waiting at ╎
///
/// Asked for when the vehicle would have to brake, once a change. The other route is taken if it
/// takes no more than 30 s longer, or where more than 60 km/h are allowed, so that nobody expects
/// somebody to wait there. Else the vehicle waits; whenever it has stood for 60 s,
/// as long as lights are red, it asks again, and takes what there is.
class MissedLaneChange {
 public:
  struct View {
    double t_s;
    const VehicleState& measured;
    const std::optional<Merging::NoGap>& no_gap;
    double limit_mps;  ///< that the map gives here
  };

  struct Decision {
    std::string reason;  ///< which way is taken
    Detour detour;
  };

  MissedLaneChange(const geometry::VehicleShape& vehicle, const DrivingOptions& driving,
                   const DrivingTask& task)
      : vehicle_(vehicle), driving_(driving), task_(task) {}

  /// To be asked once a cycle. None: the vehicle drives or waits on.
  std::optional<Decision> look(const View& view);

 private:
  bool has_waited(const View& view);
  DetourAnswer ask(const View& view) const;

  const geometry::VehicleShape& vehicle_;
  DrivingOptions driving_;
  const DrivingTask& task_;
  std::optional<std::size_t> asked_leg_;  ///< the change that was asked for
  std::optional<double> waits_since_s_;   ///< standing
};

}  // namespace roadbed::planning::behaviour
