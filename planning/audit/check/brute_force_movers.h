#pragma once

// Private to planning/audit: obstacles that move, for the check of certificates. It shares nothing
// with the audit, so that a fault there is not a fault here.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "roadbed/planning/audit/check/brute_force_obstacles.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::planning::inline audit {

/// Rectangles that move, linear between their samples, at rest before the first and after the last.
class BruteForceMovers {
 public:
  explicit BruteForceMovers(std::span<const ObstacleInSource> obstacles);

  bool empty() const { return movers_.empty(); }

  /// Exact distance of one from a body; none if there is no such obstacle then.
  std::optional<double> distance_m(const std::string& id, double t_s,
                                   const BodyOutline::Place& body) const;

  /// A part of a drive that begins and ends at the given times.
  struct Time {
    double from_s, to_s, drive_from_s, drive_to_s;
  };

  /// Whether all obstacles that are there at some time of a span are, at its middle, farther from
  /// the body than `least_m` and what they may move until either end of it.
  bool keep_away(const BodyOutline::Place& body, const Time& time, double least_m) const;

 private:
  struct Sample {
    double t_s, x_m, y_m, heading_rad;
  };
  struct Mover {
    std::string id;
    double from_s, to_s, half_length_m, half_width_m;
    std::vector<Sample> samples;

    std::size_t segment_at(double t_s) const;
    BodyOutline::Corners at(double t_s) const;
    double way_m(double start_s, double end_s) const;
    bool is_there(const Time& time) const;
  };

  std::vector<Mover> movers_;
};

}  // namespace roadbed::planning::audit
