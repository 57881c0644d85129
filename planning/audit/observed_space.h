#pragma once

// Private to planning/audit: whether an audit looked at anything where a vehicle drives.

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/audit/clearance_probe.h"

namespace roadbed::planning::inline audit {

/// Goes along a drive from measured column to measured column: one is looked for near the body and
/// counts as long as the body cannot have gone farther than `kObservedWithin_m` from it. A time at
/// which there is none is unobserved; that is told to 2 cm of motion, or a hundred-thousandth of
/// the drive's, whichever is more, and never in favour of the drive.
class ObservedSearch {
 public:
  /// @param probe  of the part on its drive. What is given has to outlive it.
  /// @param part   of the vehicle, without a margin.
  ObservedSearch(const map::ClearanceField& field, const ClearanceProbe& probe,
                 const geometry::BodyPart& part);

  /// From where it stopped on up to a segment, without that one; it may go farther.
  void search(std::size_t to);

  /// Of what was gone along, in order of time.
  std::vector<ObservedTime> take_observed() { return std::move(observed_); }
  const std::vector<Stretch>& unobserved() const { return unobserved_; }

 private:
  static constexpr double kLeastBeyond_m = 0.5, kMostBeyond_m = 20.0;

  void observe(double until_m, const map::Box2& column);
  void pass_unobserved(double until_m);
  double time_moved_s(double moved_m) const;

  const map::ClearanceField& field_;
  const ClearanceProbe& probe_;
  const geometry::BodyPart& part_;
  double step_m_;
  double at_m_ = 0.0;                // of motion
  double beyond_m_ = kMostBeyond_m;  // how much farther than has to be a column is looked for
  std::vector<ObservedTime> observed_;
  std::vector<Stretch> unobserved_;
};

/// Why nothing was measured near a part of a vehicle during a stretch of its drive, and what to do:
/// frames that are apart, other heights, or a place that no sensor saw. It is told to users.
std::string why_unobserved(const map::OccupancySource& occupancy,
                           const geometry::Trajectory& drive_in_source, const Stretch& stretch,
                           const geometry::BodyPart& part, const map::HeightBand& band);

}  // namespace roadbed::planning::audit
