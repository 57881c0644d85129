#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/geometry/trajectory.h"
#include "roadbed/geometry/vehicle_shape.h"
#include "roadbed/map/occupancy/clearance_field.h"

namespace roadbed::planning {

enum class UnknownPolicy { free, occupied, report };
enum class Verdict { clear, conflict, unknown, undecided };
std::string_view name(Verdict verdict);

struct AuditOptions {
  double clearance_m = 0.0;  ///< less than this is a conflict
  double inflate_m = 0.0;    ///< localisation margin added around the vehicle
  UnknownPolicy unknown = UnknownPolicy::report;
  double tolerance_m = 0.02;  ///< bound on the error of the least clearance
};

/// A stretch of time in which the vehicle is too near to something.
struct Conflict {
  double from_s = 0.0, to_s = 0.0;
  double least_clearance_m = 0.0;
  geometry::TrajectoryPoint at;  ///< state at the least clearance
  map::Box2 witness;             ///< the occupied cell
};

struct AuditReport {
  Verdict verdict = Verdict::undecided;
  double least_clearance_m =
      0.0;  ///< within tolerance_m of the true one, never above it + tolerance
  double least_clearance_at_s = 0.0;
  bool beyond_horizon = false;  ///< nothing within the field's horizon: a lower bound only
  double unknown_share = 0.0;   ///< of the swept poses' area
  std::vector<Conflict> conflicts;
  struct Sample {
    double t_s, clearance_m;
  };
  std::vector<Sample> profile;  ///< proven lower bounds along the drive
};

/// Whether a drive keeps clear of occupied space, at every time between its rows too: x, y and the
/// unwrapped heading are linear between rows, and a motion bound covers every point of the body.
AuditReport audit(const map::ClearanceField& field, const geometry::Trajectory& drive_in_source,
                  const geometry::VehicleShape& vehicle, const AuditOptions& options = {});

}  // namespace roadbed::planning
