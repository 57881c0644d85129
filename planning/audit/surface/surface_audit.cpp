#include "roadbed/planning/audit/surface/surface_audit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "roadbed/planning/audit/least_clearance.h"
#include "roadbed/planning/audit/near_stretches.h"
#include "roadbed/planning/audit/proven_cover.h"
#include "roadbed/planning/audit/surface/edge_probe.h"
#include "roadbed/planning/audit/surface/farthest_off.h"

namespace roadbed::planning::inline audit {
namespace {

using Edge = geometry::RegionEdges::Nearest;
using geometry::BodyPart;

constexpr double kTolerance_m = 0.02;
constexpr std::size_t kSegmentsTogether = 1024, kSeeds = 8;

void check(const geometry::Trajectory& drive, double margin_m) {
  if (drive.empty()) throw std::invalid_argument("audit: the drive needs at least 1 point, got 0");
  if (margin_m >= 0.0 && margin_m <= 0.5 * kSurfaceHorizon_m) return;
  throw std::invalid_argument(fmt::format("audit: the margin is out of range, got {} m", margin_m));
}

/// How far a body is off the surface at a time.
struct FarthestOut : FarthestOff {
  geometry::TrajectoryPoint at = {};
};

/// One part of a vehicle on a surface.
class PartOnSurface {
 public:
  PartOnSurface(const RoadSurface& surface, const geometry::Trajectory& drive, const BodyPart& part,
                double margin_m, bool is_only)
      : surface_(surface),
        part_(part),
        margin_m_(margin_m),
        is_only_(is_only),
        probe_(surface.edges, drive, part, kSurfaceHorizon_m),
        on_either_side_(surface.edges, drive, part, kSurfaceHorizon_m, EdgeSide::either) {}

  /// Takes what it finds into a report.
  void audit(const map::RoadMap* road_map, SurfaceReport& report) {
    const LeastClearance least = least_of_all();
    const double proven_m = std::max(0.0, least.proven_m - surface_.off_by_m);
    if (least.found_m < report.least_margin_m) {
      take_least(least.at, least.found_m, report);
      report.beyond_horizon = !least.witness;
    }
    report.proven_margin_m = std::min(report.proven_margin_m, proven_m);
    if (proven_m < margin_m_ + kLeastTold_m) collect(road_map, report);
  }

  const EdgeProbe& probe() const { return probe_; }

 private:
  /// Where no edge meets the body anywhere, it is on the surface all along if it is at the start.
  LeastClearance least_of_all() const {
    const LeastClearance either = least_of(on_either_side_);
    if (either.proven_m == 0.0) return least_of(probe_);
    const Edge at_start = probe_.edge_near(part_.core_at(probe_.state_at(0, 0.0).pose()));
    if (at_start.is_inside) return either;
    LeastClearance off = either;
    off.found_m = off.proven_m = 0.0;
    off.at = probe_.state_at(0, 0.0);
    return off;
  }

  static LeastClearance least_of(const EdgeProbe& probe) {
    LeastClearanceSearch search(probe, kTolerance_m);
    const std::size_t segments = probe.segments();
    for (std::size_t i = 0; i < segments; i += 1 + segments / kSeeds) search.seed(i);
    for (std::size_t from = 0; from < segments; from += kSegmentsTogether) {
      search.search(from, std::min(from + kSegmentsTogether, segments));
    }
    return search.found();
  }

  void take_least(const geometry::TrajectoryPoint& at, double margin_m,
                  SurfaceReport& report) const {
    const Edge edge = probe_.edge_near(part_.core_at(at.pose()));
    report.least_margin_m = margin_m;
    report.least_margin_at_s = at.t_s;
    report.edge_in_source = edge.on_edge;
    report.part = side_of(at, margin_m > 0.0 ? edge.on_edge : farthest(at, kPointsApart_m).point);
  }

  /// A stretch is looked at more closely than the whole: its least margin may be less.
  void collect(const map::RoadMap* road_map, SurfaceReport& report) const {
    NearStretchSearch search(probe_, margin_m_ + surface_.off_by_m, kTolerance_m);
    search.search(probe_.segments());
    const NearStretches found = search.found();
    report.undecided.insert(report.undecided.end(), found.undecided.begin(), found.undecided.end());
    for (const Conflict& near : found.near) {
      if (near.least_clearance_m < report.least_margin_m) {
        take_least(near.at, near.least_clearance_m, report);
      }
      // Over the margin, but by less than closing seams may have moved the edge.
      if (near.least_clearance_m > 0.0 && near.least_clearance_m >= margin_m_) {
        report.undecided.push_back({near.from_s, near.to_s});
      } else {
        report.conflicts.push_back(excursion(near, found.near.size(), road_map));
      }
    }
  }

  Excursion excursion(const Conflict& near, std::size_t count, const map::RoadMap* road_map) const {
    Excursion out{.from_s = near.from_s,
                  .to_s = near.to_s,
                  .from = probe_.state_at_time(near.from_s),
                  .at = near.at,
                  .least_margin_m = near.least_clearance_m};
    const bool is_off = near.least_clearance_m == 0.0;
    const FarthestOut far = is_off ? farthest_of(near, count) : FarthestOut{};
    if (far.depth_m > 0.0) {
      out.at = far.at;
      out.depth_m = far.depth_m;
      out.point_in_source = far.point;
      out.edge_in_source = far.edge;
    } else {
      const Edge edge = probe_.edge_near(part_.core_at(near.at.pose()));
      out.point_in_source = edge.on_shape;
      out.edge_in_source = edge.on_edge;
    }
    out.part = side_of(out.at, is_off ? out.point_in_source : out.edge_in_source);
    const Eigen::Vector2d place =
        far.depth_m > 0.0 ? out.point_in_source : place_beside(out.edge_in_source);
    out.onto =
        what_is_beside(road_map, surface_.edges, place, out.edge_in_source, out.at.heading_rad);
    return out;
  }

  // A place off the surface near a point of its edge.
  Eigen::Vector2d place_beside(const Eigen::Vector2d& edge) const {
    for (const double far_m : {0.01, 0.05}) {
      for (int i = 0; i < 8; ++i) {
        const double turn_rad = 0.25 * std::numbers::pi * i;
        const Eigen::Vector2d place =
            edge + far_m * Eigen::Vector2d(std::cos(turn_rad), std::sin(turn_rad));
        if (!surface_.edges.contains(place)) return place;
      }
    }
    return edge;
  }

  // Where nothing is found between points far apart, as at a small hole, they are taken nearer.
  FarthestOut farthest_of(const Conflict& near, std::size_t count) const {
    constexpr double most = 100.0, most_in_all = 2000.0;
    const double each = std::clamp(most_in_all / static_cast<double>(count), 2.0, most);
    const FarthestOut far = farthest_of(near, each, kPointsApart_m);
    return far.depth_m > 0.0 ? far : farthest_of(near, std::min(each, 25.0), 0.2 * kPointsApart_m);
  }

  FarthestOut farthest_of(const Conflict& near, double most_moments, double apart_m) const {
    const double from_m = probe_.moved_at_m(near.from_s), to_m = probe_.moved_at_m(near.to_s);
    const double moments =
        std::clamp(std::ceil((to_m - from_m) / kMomentsApart_m) + 1.0, 2.0, most_moments);
    FarthestOut best = farthest(near.at, apart_m);
    for (double i = 0.0; i < moments; ++i) {
      const auto [segment, fraction] =
          probe_.place_moved(from_m + i / (moments - 1.0) * (to_m - from_m));
      const FarthestOut next = farthest(probe_.state_at(segment, fraction), apart_m);
      if (next.depth_m > best.depth_m) best = next;
    }
    return best;
  }

  FarthestOut farthest(const geometry::TrajectoryPoint& at, double apart_m) const {
    return {farthest_off(surface_.edges, part_, at.pose(), apart_m), at};
  }

  std::string side_of(const geometry::TrajectoryPoint& at, const Eigen::Vector2d& towards) const {
    if (part_.is_circle()) return part_.name;
    // A point of the body itself: from a little outside of it.
    geometry::Rectangle core = part_.core_at(at.pose());
    constexpr double shrunk_m = 1e-4;
    core.half_length_m -= std::min(shrunk_m, 0.5 * core.half_length_m);
    core.half_width_m -= std::min(shrunk_m, 0.5 * core.half_width_m);
    const std::string side(geometry::side_towards({.centre = towards}, core));
    return is_only_ ? side : part_.name + ", " + side;
  }

  static constexpr double kMomentsApart_m = 0.05, kPointsApart_m = 0.25;

  const RoadSurface& surface_;
  BodyPart part_;
  double margin_m_;
  bool is_only_;
  EdgeProbe probe_, on_either_side_;
};

std::vector<Stretch> times_of(const std::vector<Excursion>& excursions) {
  std::vector<Stretch> times;
  for (const Excursion& out : excursions) times.push_back({out.from_s, out.to_s});
  return times;
}

}  // namespace

SurfaceReport audit_surface(const RoadSurface& surface, const geometry::Trajectory& drive,
                            std::span<const BodyPart> parts, double margin_m,
                            const map::RoadMap* road_map) {
  check(drive, margin_m);
  SurfaceReport report;
  report.least_margin_m = report.proven_margin_m = kSurfaceHorizon_m;
  report.least_margin_at_s = drive.start_s();
  report.beyond_horizon = true;
  report.off_by_m = surface.off_by_m;
  for (const BodyPart& part : parts) {
    PartOnSurface(surface, drive, part, margin_m, parts.size() == 1).audit(road_map, report);
  }
  std::ranges::stable_sort(report.conflicts, {}, &Excursion::from_s);
  report.undecided = joined(std::move(report.undecided));
  report.verdict = !report.conflicts.empty()  ? Verdict::conflict
                   : report.undecided.empty() ? Verdict::clear
                                              : Verdict::undecided;
  return report;
}

std::vector<SurfaceCertificate> certify_surface(const RoadSurface& surface,
                                                const geometry::Trajectory& drive,
                                                std::span<const BodyPart> parts, double margin_m,
                                                const SurfaceReport& report) {
  const std::vector<Stretch> off = joined(times_of(report.conflicts));
  std::vector<Stretch> left_out = off;
  left_out.insert(left_out.end(), report.undecided.begin(), report.undecided.end());
  std::ranges::stable_sort(left_out, {}, &Stretch::from_s);
  // A tenth of the least margin is left to spare, so that spans are few.
  const double goal_m = std::max(margin_m, 0.9 * report.proven_margin_m) + surface.off_by_m;
  std::vector<SurfaceCertificate> certificates;
  for (const BodyPart& part : parts) {
    const EdgeProbe probe(surface.edges, drive, part, kSurfaceHorizon_m);
    ProvenCover cover = proven_cover(probe, goal_m, left_out);
    for (ProvenSpan& span : cover.proven) span.at_least_m -= surface.off_by_m;
    SurfaceCertificate& one = certificates.emplace_back();
    one.part = part;
    one.from_edge = std::move(cover.proven);
    one.off = off;
    one.undecided = report.undecided;
    one.undecided.insert(one.undecided.end(), cover.left.begin(), cover.left.end());
    one.undecided = joined(std::move(one.undecided));
  }
  return certificates;
}

std::vector<JudgedStretch> judged_stretches(const SurfaceReport& report, double start_s,
                                            double end_s) {
  AuditReport judged;
  judged.verdict = report.verdict;
  judged.undecided = report.undecided;
  for (const Excursion& out : report.conflicts) {
    Conflict& conflict = judged.conflicts.emplace_back();
    conflict.from_s = out.from_s;
    conflict.to_s = out.to_s;
  }
  return judged_stretches(judged, start_s, end_s);
}

}  // namespace roadbed::planning::audit
