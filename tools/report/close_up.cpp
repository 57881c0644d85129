#include "roadbed/tools/report/audit_pictures.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "roadbed/map/drawing/svg.h"
#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::tools::inline report {
namespace {

using Eigen::Vector2d;
using geometry::BodyPart;
using geometry::Ring;

constexpr double kPictureWidth_px = 360.0, kPictureHeight_px = 240.0, kScale_px_per_m = 56.0;
constexpr std::size_t kMostPictures = 24;

/// A place at which a part is near to a thing.
struct Meeting {
  geometry::TrajectoryPoint at;
  double clearance_m;
  map::Box2 witness;
  std::string obstacle, part;
};

std::vector<Meeting> meetings(const planning::AuditReport& report,
                              const geometry::Trajectory& drive) {
  std::vector<Meeting> all;
  for (const planning::Conflict& conflict : report.conflicts) {
    if (all.size() == kMostPictures) break;
    all.push_back({conflict.at, conflict.least_clearance_m, conflict.witness, conflict.obstacle,
                   conflict.part});
  }
  if (all.empty() && report.witness) {
    all.push_back({drive.at(report.least_clearance_at_s), report.least_clearance_m, *report.witness,
                   report.obstacle, report.part});
  }
  return all;
}

Ring body_outline(const planning::ObstacleInSource& moving, double t_s) {
  const auto corners = planning::rectangle_at(moving, t_s).corners();
  return {corners.begin(), corners.end()};
}

Ring thing_touched(const Meeting& meeting, const CloseUpScene& scene) {
  for (const planning::ObstacleInSource& moving : scene.moving) {
    if (!meeting.obstacle.empty() && moving.id == meeting.obstacle) {
      return body_outline(moving, meeting.at.t_s);
    }
  }
  return geometry::box_ring(meeting.witness.min_in_source, meeting.witness.max_in_source);
}

// A part's name comes first where there are several.
const BodyPart& part_of(const Meeting& meeting, const CloseUpScene& scene) {
  const auto named = std::ranges::find_if(scene.parts, [&](const BodyPart& part) {
    return meeting.part == part.name || meeting.part.starts_with(part.name + ",");
  });
  return named == scene.parts.end() ? scene.parts.front() : *named;
}

Vector2d nearest_on_edge(const Vector2d& point, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double fraction = along.squaredNorm() > 0.0
                              ? std::clamp((point - a).dot(along) / along.squaredNorm(), 0.0, 1.0)
                              : 0.0;
  return a + fraction * along;
}

/// A point of each of two rings, such that no two are nearer to each other.
std::pair<Vector2d, Vector2d> nearest_points(const Ring& a, const Ring& b) {
  std::pair<Vector2d, Vector2d> nearest{a.front(), b.front()};
  double least_m = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vector2d& on_a, const Vector2d& on_b) {
    const double away_m = (on_a - on_b).norm();
    if (away_m >= least_m) return;
    least_m = away_m;
    nearest = {on_a, on_b};
  };
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) {
      consider(a[i], nearest_on_edge(a[i], b[k], b[(k + 1) % b.size()]));
      consider(nearest_on_edge(b[k], a[i], a[(i + 1) % a.size()]), b[k]);
    }
  }
  return nearest;
}

Eigen::AlignedBox2d box_around(const Ring& ring) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& point : ring) box.extend(point);
  return box;
}

std::string rings_svg(std::string_view look, const map::PictureFrame& frame,
                      const std::vector<Ring>& rings) {
  std::string data;
  for (const Ring& ring : rings) {
    if (frame.shows(box_around(ring))) data += map::svg_ring(frame, ring);
  }
  return map::svg_path(look, data);
}

std::vector<Ring> rings_of(const std::vector<map::Box2>& boxes) {
  std::vector<Ring> rings;
  for (const map::Box2& box : boxes) {
    rings.push_back(geometry::box_ring(box.min_in_source, box.max_in_source));
  }
  return rings;
}

map::Box2 shown_by(const map::PictureFrame& frame) {
  const Vector2d half_m = 0.5 * frame.size_px / frame.px_per_m;
  return {frame.centre_in_plane - half_m, frame.centre_in_plane + half_m};
}

// A line with a head at both ends, or a ring where the two overlap.
std::string arrow_svg(const map::PictureFrame& frame, const Vector2d& from, const Vector2d& to) {
  const Vector2d a = frame.to_px(from), b = frame.to_px(to);
  const double length_px = (b - a).norm();
  constexpr double shortest_px = 1.0, head_px = 7.0;
  if (length_px < shortest_px) return {};
  const Vector2d along = (b - a) / length_px, across(-along.y(), along.x());
  const auto line = [](const Vector2d& p, const Vector2d& q) {
    return fmt::format("M{} {}L{} {}", map::svg_number(p.x()), map::svg_number(p.y()),
                       map::svg_number(q.x()), map::svg_number(q.y()));
  };
  const double head = std::min(head_px, 0.45 * length_px);
  std::string data = line(a, b);
  for (const double side : {-0.5, 0.5}) {
    data += line(a, a + head * (along + side * across));
    data += line(b, b - head * (along - side * across));
  }
  return map::svg_path("up-arrow", data);
}

std::string scale_svg() {
  const double end_px = kPictureWidth_px - 12.0, start_px = end_px - kScale_px_per_m;
  const double y_px = kPictureHeight_px - 12.0;
  return map::svg_path("up-rule",
                       fmt::format("M{0} {2}v4H{1}v-4", map::svg_number(start_px),
                                   map::svg_number(end_px), map::svg_number(y_px - 4.0))) +
         map::svg_text("up-mid", {0.5 * (start_px + end_px), y_px - 7.0}, "1 m");
}

std::string picture(const Meeting& meeting, const CloseUpScene& scene) {
  const geometry::Pose2 pose = meeting.at.pose();
  const BodyPart& part = part_of(meeting, scene);
  const Ring near_part = part.outline_at(pose), thing = thing_touched(meeting, scene);
  const auto [on_part, on_thing] = nearest_points(near_part, thing);
  const map::PictureFrame frame{.centre_in_plane = 0.5 * (on_part + on_thing),
                                .centre_px = {0.5 * kPictureWidth_px, 0.5 * kPictureHeight_px},
                                .px_per_m = kScale_px_per_m,
                                .size_px = {kPictureWidth_px, kPictureHeight_px}};
  std::vector<Ring> others;
  for (const BodyPart& other : scene.parts) {
    if (&other != &part) others.push_back(other.outline_at(pose));
  }
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
      "height=\"{1}\" role=\"img\"><title>{2:.2f} s: {3:.3f} m</title>\n"
      "<rect class=\"up-ground\" width=\"{0}\" height=\"{1}\"/>\n",
      kPictureWidth_px, kPictureHeight_px, meeting.at.t_s, meeting.clearance_m);
  svg += rings_svg("up-lane", frame, scene.lanes) +
         rings_svg("up-occupied", frame, rings_of(scene.occupied_in(shown_by(frame))));
  svg += rings_svg("up-other", frame, others) + rings_svg("up-part", frame, {near_part});
  svg += rings_svg("up-witness", frame, {thing});
  if (meeting.clearance_m > 0.0) svg += arrow_svg(frame, on_part, on_thing);
  svg += map::svg_text("up-label", {12.0, 22.0},
                       meeting.clearance_m > 0.0 ? fmt::format("{:.3f} m", meeting.clearance_m)
                                                 : std::string("overlap"));
  return svg + scale_svg() + "</svg>";
}

std::string caption(const Meeting& meeting) {
  return fmt::format("{}: {:.3f} m from {}", meeting.part, meeting.clearance_m,
                     meeting.obstacle.empty() ? "occupied space" : "obstacle " + meeting.obstacle);
}

}  // namespace

std::vector<ReportPicture> close_ups(const planning::AuditReport& report,
                                     const CloseUpScene& scene) {
  std::vector<ReportPicture> pictures;
  for (const Meeting& meeting : meetings(report, scene.drive)) {
    pictures.push_back(
        {.t_s = meeting.at.t_s, .text = caption(meeting), .svg = picture(meeting, scene)});
  }
  return pictures;
}

}  // namespace roadbed::tools::report
