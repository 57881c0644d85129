#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/body_part.h"
#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/planning/audit/audit_report.h"
#include "roadbed/planning/audit/proven_span.h"
#include "roadbed/planning/audit/surface/beside_surface.h"
#include "roadbed/planning/audit/surface/road_surface.h"

namespace roadbed::planning::inline audit {

/// A stretch of time in which some of the vehicle is off the surface, or nearer to its edge than
/// the margin.
struct Excursion {
  double from_s = 0.0, to_s = 0.0;
  geometry::TrajectoryPoint from;  ///< state where it begins
  geometry::TrajectoryPoint at;    ///< where it is farthest out, or nearest to the edge
  double least_margin_m = 0.0;     ///< from the edge then; 0: some of it is off
  /// How far the farthest point of the body is off the surface: of its corners and points 0.25 m
  /// apart (0.05 m, if that finds none), at moments 0.05 m of motion apart, a hundred at most. 0:
  /// none is; `kSurfaceHorizon_m`: so far or farther.
  double depth_m = 0.0;
  std::string part = {};                  ///< of the vehicle that is farthest out, or nearest
  Eigen::Vector2d point_in_source{0, 0};  ///< its point there
  Eigen::Vector2d edge_in_source{0, 0};   ///< the surface's edge that is nearest to it
  BesideSurface onto = {};                ///< what is at the point
};

/// Whether a vehicle stays on a surface.
struct SurfaceReport {
  Verdict verdict = Verdict::undecided;  ///< clear, conflict or undecided
  /// Distance of the whole body to the edge at `least_margin_at_s`, 0 where it is off; no time of
  /// the drive has less than `proven_margin_m`, by the map as it stands, before seams were closed.
  double least_margin_m = 0.0, proven_margin_m = 0.0;
  double least_margin_at_s = 0.0;
  bool beyond_horizon = false;  ///< nowhere within `kSurfaceHorizon_m` of the edge
  std::string part = {};        ///< of the vehicle that is nearest then
  Eigen::Vector2d edge_in_source{0, 0};
  double off_by_m = 0.0;  ///< of the surface: RoadSurface
  std::vector<Excursion> conflicts;
  std::vector<Stretch> undecided;  ///< nearer to the margin than the proof can tell
};

/// Whether the whole of a body, each part of it, stays on a surface with a margin, at every time
/// between the samples too: the body moves as `audit_clearance` says, and its distance to the
/// surface's edge is bounded the same way. A `clear` is a proof.
/// @param parts     with the margin around the vehicle.
/// @param road_map  of what lies beside the surface; null: nobody knows.
/// @throws std::invalid_argument if the drive is empty, or the margin is negative, not finite or
///         over half of `kSurfaceHorizon_m`.
SurfaceReport audit_surface(const RoadSurface& surface, const geometry::Trajectory& drive_in_source,
                            std::span<const geometry::BodyPart> parts, double margin_m,
                            const map::RoadMap* road_map = nullptr);

/// What another program needs to convince itself that a part stays on a surface: at the middle of
/// a span the edge is so far away that the body cannot come nearer to it than `at_least_m` while it
/// moves through the span. What the spans leave out is in the stretches.
struct SurfaceCertificate {
  geometry::BodyPart part;            ///< of the vehicle, with the margin around it
  std::vector<ProvenSpan> from_edge;  ///< in order of time; at least the margin, by the map's edges
  std::vector<Stretch> off, undecided;
};

/// A certificate for each part.
/// @pre `report` is what `audit_surface` says of the same.
std::vector<SurfaceCertificate> certify_surface(const RoadSurface& surface,
                                                const geometry::Trajectory& drive_in_source,
                                                std::span<const geometry::BodyPart> parts,
                                                double margin_m, const SurfaceReport& report);

/// The whole drive, stretch by stretch, as `judged_stretches` of an audit.
std::vector<JudgedStretch> judged_stretches(const SurfaceReport& report, double start_s,
                                            double end_s);

}  // namespace roadbed::planning::audit
