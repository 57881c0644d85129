#pragma once

// Private to planning/audit.

#include <cstddef>
#include <optional>
#include <vector>

#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/audit/clearance_probe.h"

namespace roadbed::planning::inline audit {

/// Where a distance and what is asked for are nearer to each other than this, spans may be
/// undecided: it is the motion bound of the shortest ones, of 1 mm of motion.
inline constexpr double kLeastTold_m = 0.5e-3;

/// Where a drive is nearer to something than allowed, and where that cannot be told.
struct NearStretches {
  std::vector<Conflict> near;
  std::vector<Stretch> undecided;  ///< apart from `near`
};

/// Goes along a drive and halves every span until it is proven clear of `clearance_m`, shown to be
/// too near to within `tolerance_m` of motion, or too short to go on (1 mm of motion): undecided.
/// An overlap or touch is always too near. Drives of over 40 km get a coarser tolerance, a
/// millionth of their length.
class NearStretchSearch {
 public:
  /// @pre clearance_m is less than the field's horizon.
  NearStretchSearch(const ClearanceProbe& probe, double clearance_m, double tolerance_m);

  /// From where it stopped on up to a segment, without that one; it may go farther.
  void search(std::size_t to);

  /// Of what was gone along.
  NearStretches found() const;

 private:
  enum class Label { clear, near, undecided };

  /// Neighbouring spans of one label.
  struct Run {
    Label label;
    Stretch time;
    std::optional<Conflict> worst;  // of a near one
  };

  void label(std::size_t segment);
  bool is_far(double distance_m) const { return distance_m > 0.0 && distance_m >= clearance_m_; }
  bool settle(const Span& span);
  bool append(const Span& span, Label label, const std::optional<Conflict>& worst = std::nullopt);

  const ClearanceProbe& probe_;
  double clearance_m_, tolerance_m_;
  std::size_t next_ = 0;  // segment
  double spare_m_ = 0.0;  // of the segment that is being labelled, where it is clear as a whole
  std::vector<Run> runs_;
};

}  // namespace roadbed::planning::audit
