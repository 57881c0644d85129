#pragma once

#include <vector>

#include "roadbed/planning/lateral/candidate_evaluator.h"
#include "roadbed/planning/lateral/maneuver_completion.h"

namespace roadbed::planning::inline lateral {

/// The drives of a batch: at its own stations, and at those of the longest batch past its end.
struct BatchDrives {
  std::vector<const Station*> stations;
  std::vector<LinearPoint> points;        ///< one per station
  std::vector<Eigen::Vector2d> tangents;  ///< of the line, one per station
};
BatchDrives drives_of(CandidateEvaluator& evaluator, std::size_t batch);

/// A part of some drives: no body is anywhere else meanwhile.
struct FanSection {
  std::size_t first, last;  ///< points
  geometry::Rectangle cover;
  double from_t_s, to_t_s;
};

/// Points of drives to look at, and how many of them in one section.
struct FanPoints {
  std::size_t first, last, per_section;
};

/// All drives of a batch whose end offsets are between two, section by section.
///
///     d ▲       ┌─────┬─────┬─── to_d_m        Positions are linear in d_e, directions keep within
///       │  ┌────┤╱────┼─────┼───              the angle between the outer ones, and durations are
///     ──●──┤────┤─────┼─────┼───              convex: the outer two drives bound all of them.
///       └──┴────┴─────┴─────┴──▶ l
///
/// @param look_at  the fewer points in a section, the nearer its cover.
std::vector<FanSection> fan_sections(const CandidateEvaluator& evaluator, const BatchDrives& drives,
                                     const OffsetRange& ends, const FanPoints& look_at);

/// Length driven per length of the line, at least [0.05, 1]; as far as candidates reach.
double least_stretch(CandidateEvaluator& evaluator, const OffsetRange& ends);

/// The stretches of the line from the start to a length ahead of it, for some ends of the grid.
std::vector<LineStretch> stretches_ahead(CandidateEvaluator& evaluator, double length_m,
                                         const OffsetRange& ends);

}  // namespace roadbed::planning::lateral
