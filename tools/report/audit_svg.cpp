#include "roadbed/tools/report/audit_pictures.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string_view>
#include <tuple>

#include "roadbed/map/drawing/svg.h"

namespace roadbed::tools::inline report {
namespace {

using Eigen::Vector2d;
using geometry::Ring;
using PictureBox = Eigen::AlignedBox2d;

constexpr double kAuditWidth_px = 900.0, kHeader_px = 34.0, kMargin_px = 20.0;
constexpr double kPanelHeight_px = 200.0, kPlotWidth_px = 560.0;
constexpr double kLeastAuditHeight_px = 110.0, kMostAuditHeight_px = 900.0,
                 kMostScale_px_per_m = 60.0;
constexpr std::size_t kMostFootprints = 400;

constexpr std::string_view kAuditStyle = R"(<style>
.ground{fill:#f4f4f1}.lane{fill:#dcdfe3;stroke:#c6cad0;stroke-width:.5}
.occupied{fill:#4b3f33}.body{fill:#2f9be0;fill-opacity:.16;stroke:#2f7fb8;stroke-width:.7;stroke-opacity:.8}
.standing{fill:#e69f00;fill-opacity:.35;stroke:#8a5f00;stroke-width:.7}.moving{fill:#d55e00;fill-opacity:.2;stroke:#d55e00;stroke-width:.7}
.unknown{fill:#9467bd;fill-opacity:.25;stroke:#7b4fa6;stroke-width:.7}
.conflict{fill:#d62728;fill-opacity:.28;stroke:#b01417;stroke-width:1}
.worst{fill:none;stroke:#b01417;stroke-width:2.2}.witness{fill:#ffd400;stroke:#b01417;stroke-width:1}
.axle{fill:none;stroke:#1b2029;stroke-width:1;stroke-dasharray:5 3}.rule{fill:none;stroke:#1b2029;stroke-width:1.4}
.head{fill:#fff}text{font:13px system-ui,-apple-system,"Segoe UI","DejaVu Sans",sans-serif;fill:#1b2029}
.plot{fill:#2f9be0;fill-opacity:.22;stroke:#2f7fb8;stroke-width:1.2}.least{fill:#b01417}.grid{fill:none;stroke:#d5d8dc;stroke-width:1}.small{font-size:11px}
.up-ground{fill:#f4f4f1}.up-lane{fill:#dcdfe3}.up-occupied{fill:#4b3f33}.up-other{fill:#2f9be0;fill-opacity:.2;stroke:#2f7fb8}.up-part{fill:#2f9be0;fill-opacity:.45;stroke:#1b2029;stroke-width:1.5}
.up-witness{fill:#ffd400;stroke:#b01417;stroke-width:1.5}.up-arrow,.up-rule{fill:none;stroke:#b01417;stroke-width:2}.up-label{font-size:17px;font-weight:600}.up-mid{text-anchor:middle}
.mid{text-anchor:middle}.over{paint-order:stroke;stroke:#fff;stroke-width:3px;stroke-linejoin:round}
</style>
)";

Ring ring_of(const map::Box2& box) {
  return geometry::box_ring(box.min_in_source, box.max_in_source);
}

std::string body_svg(const AuditPicture& picture, const map::PictureFrame& frame, double t_s) {
  std::string data;
  for (const geometry::BodyPart& part : picture.parts) {
    data += map::svg_ring(frame, part.outline_at(picture.drive.at(t_s).pose()));
  }
  return data;
}

map::PictureFrame look_at(const AuditPicture& picture) {
  PictureBox box;
  for (const auto& point : picture.drive.points()) {
    for (const geometry::BodyPart& part : picture.parts) {
      for (const Vector2d& corner : part.outline_at(point.pose())) box.extend(corner);
    }
  }
  const Vector2d around = Vector2d::Constant(std::max(6.0, 0.08 * box.sizes().maxCoeff()));
  box = PictureBox(box.min() - around, box.max() + around);
  const Vector2d size = box.sizes();
  double scale = std::min((kAuditWidth_px - 2.0 * kMargin_px) / size.x(), kMostScale_px_per_m);
  const double inner_px = std::clamp(scale * size.y(), kLeastAuditHeight_px, kMostAuditHeight_px);
  scale = std::min(scale, inner_px / size.y());
  const Vector2d middle_px(0.5 * kAuditWidth_px, kHeader_px + 0.5 * inner_px);
  return {.centre_in_plane = box.center(),
          .centre_px = middle_px,
          .px_per_m = scale,
          .size_px = {kAuditWidth_px, kHeader_px + inner_px}};
}

// Cells above one another, or in the same pixel, are drawn once.
std::string occupied_around_audit_svg(const AuditPicture& picture, const map::PictureFrame& frame) {
  const double step_m = 0.5 / frame.px_per_m;
  std::set<std::tuple<std::int64_t, std::int64_t, std::int64_t>> drawn;
  std::string data;
  for (const map::Box2& box : picture.occupied) {
    if (!frame.shows({box.min_in_source, box.max_in_source})) continue;
    const auto step = [&](double at_m) {
      return static_cast<std::int64_t>(std::llround(at_m / step_m));
    };
    const double side_m = box.max_in_source.x() - box.min_in_source.x();
    const auto place =
        std::tuple(step(box.min_in_source.x()), step(box.min_in_source.y()), step(side_m));
    if (drawn.insert(place).second) data += map::svg_ring(frame, ring_of(box));
  }
  return map::svg_path("occupied", data);
}

// Whoever stands, and who moves at every second of the drive.
std::string obstacles_around_audit_svg(const AuditPicture& picture,
                                       const map::PictureFrame& frame) {
  std::string standing, moving;
  const auto draw = [&](const planning::ObstacleInSource& obstacle, double t_s, std::string& data) {
    const auto corners = planning::rectangle_at(obstacle, t_s).corners();
    PictureBox box;
    for (const Vector2d& corner : corners) box.extend(corner);
    if (frame.shows(box)) data += map::svg_ring(frame, Ring(corners.begin(), corners.end()));
  };
  for (const planning::ObstacleInSource& obstacle : picture.moving) {
    if (obstacle.is_static()) {
      draw(obstacle, 0.0, standing);
      continue;
    }
    const double from_s = std::max(picture.drive.start_s(), obstacle.validity.from_s);
    const double to_s = std::min(picture.drive.end_s(), obstacle.validity.to_s);
    for (double t_s = from_s; t_s <= to_s; t_s += 1.0) draw(obstacle, t_s, moving);
  }
  return map::svg_path("standing", standing) + map::svg_path("moving", moving);
}

std::string audited_lanes_svg(const AuditPicture& picture, const map::PictureFrame& frame) {
  std::string data;
  for (const Ring& lane : picture.lanes) {
    PictureBox box;
    for (const Vector2d& point : lane) box.extend(point);
    if (frame.shows(box)) data += map::svg_ring(frame, lane);
  }
  return map::svg_path("lane", data);
}

std::string_view look_at_time(const planning::AuditReport& report, double t_s) {
  const auto covers = [t_s](const auto& stretch) {
    return stretch.from_s <= t_s && t_s <= stretch.to_s;
  };
  const auto any = [&](const auto& all) { return std::any_of(all.begin(), all.end(), covers); };
  if (any(report.conflicts)) return "conflict";
  return any(report.unknown) || any(report.undecided) ? "unknown" : "body";
}

// Footprints about as far apart as a quarter of the body.
std::vector<double> audited_footprint_times(const AuditPicture& picture) {
  const auto& rows = picture.drive.points();
  double way_m = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    way_m += (rows[i].pose().position() - rows[i - 1].pose().position()).norm();
  }
  const geometry::BodyPart& first = picture.parts.front();
  const double wanted = way_m / (0.25 * (first.length_m() + 2.0 * first.radius_m));
  const std::size_t count =
      std::clamp(static_cast<std::size_t>(wanted), std::size_t{2}, kMostFootprints);
  std::vector<double> times;
  const double start_s = rows.front().t_s, duration_s = rows.back().t_s - start_s;
  for (std::size_t i = 0; i <= count; ++i) {
    times.push_back(start_s + duration_s * static_cast<double>(i) / static_cast<double>(count));
  }
  return times;
}

std::string drive_svg(const AuditPicture& picture, const map::PictureFrame& frame) {
  std::string body, unknown, conflict;
  for (const double t_s : audited_footprint_times(picture)) {
    const std::string_view look = look_at_time(picture.report, t_s);
    std::string& data = look == "conflict" ? conflict : look == "unknown" ? unknown : body;
    data += body_svg(picture, frame, t_s);
  }
  Ring axle;
  for (const auto& point : picture.drive.points()) axle.push_back(point.pose().position());
  return map::svg_path("body", body) + map::svg_path("unknown", unknown) +
         map::svg_path("conflict", conflict) + map::svg_path("axle", map::svg_line(frame, axle));
}

std::string label_of(const planning::Conflict& conflict) {
  const double depth_m = conflict.deepest.overlap.depth_m;
  return depth_m > 0.0
             ? fmt::format("{:.2f} m deep at {:.2f} s", depth_m, conflict.deepest.at_s)
             : fmt::format("{:.2f} m at {:.2f} s", conflict.least_clearance_m, conflict.at.t_s);
}

std::string conflicts_svg(const AuditPicture& picture, const map::PictureFrame& frame) {
  std::string worst, witness, labels;
  for (const planning::Conflict& conflict : picture.report.conflicts) {
    worst += body_svg(picture, frame, conflict.at.t_s);
    witness += map::svg_ring(frame, ring_of(conflict.witness));
    labels += map::svg_text("over", frame.to_px(conflict.witness.max_in_source) + Vector2d(5, -5),
                            label_of(conflict));
  }
  if (picture.report.conflicts.empty() && picture.report.witness) {
    worst += body_svg(picture, frame, picture.report.least_clearance_at_s);
    witness += map::svg_ring(frame, ring_of(*picture.report.witness));
  }
  return map::svg_path("witness", witness) + map::svg_path("worst", worst) + labels;
}

std::string header_svg(const AuditPicture& picture, const map::PictureFrame& frame) {
  const planning::AuditReport& report = picture.report;
  const std::string text =
      fmt::format("{} · least {} {}{:.2f} m at {:.2f} s", to_string(report.verdict),
                  picture.is_of_surface ? "margin to the edge" : "clearance",
                  report.beyond_horizon ? "over " : "", report.least_clearance_m,
                  report.least_clearance_at_s) +
      (picture.is_of_surface ? ""
                             : fmt::format(" · unknown {:.0f} %", 100.0 * report.unknown_fraction));
  const double bar_m = map::round_length_m(160.0 / frame.px_per_m);
  const double end_px = kAuditWidth_px - kMargin_px, start_px = end_px - bar_m * frame.px_per_m;
  return fmt::format("<rect class=\"head\" width=\"{}\" height=\"{}\"/>\n", kAuditWidth_px,
                     kHeader_px) +
         map::svg_text("", {kMargin_px, 22.0}, text) +
         map::svg_text("mid", {0.5 * (start_px + end_px), 17.0}, fmt::format("{:g} m", bar_m)) +
         map::svg_path("rule", fmt::format("M{} 20v5H{}v-5", map::svg_number(start_px),
                                           map::svg_number(end_px)));
}

constexpr double kShownClearance_m = 5.0;

// A gap in the plot where there is more room than it shows.
std::string clearance_svg(const AuditPicture& picture, double top_px) {
  const planning::AuditReport& report = picture.report;
  if (report.profile.empty()) return {};
  const double start_s = picture.drive.start_s();
  const double duration_s = std::max(1e-9, picture.drive.end_s() - start_s);
  const double left_px = kMargin_px + 24.0, base_px = top_px + kPanelHeight_px - 26.0;
  const double high_px = kPanelHeight_px - 56.0, wide_px = kPlotWidth_px - left_px;
  const auto x_px = [&](double t_s) { return left_px + wide_px * (t_s - start_s) / duration_s; };
  const auto y_px = [&](double clearance_m) {
    return base_px - high_px * std::min(1.0, clearance_m / kShownClearance_m);
  };
  std::string grid, labels, curve;
  for (int metres = 0; metres <= 5; ++metres) {
    grid += fmt::format("M{} {}h{}", map::svg_number(left_px), map::svg_number(y_px(metres)),
                        map::svg_number(wide_px));
    labels += map::svg_text("small", {kMargin_px, y_px(metres) + 4.0}, fmt::format("{} m", metres));
  }
  curve = fmt::format("M{} {}", map::svg_number(left_px), map::svg_number(base_px));
  for (const planning::AuditReport::Sample& sample : report.profile) {
    curve += fmt::format("L{} {}", map::svg_number(x_px(sample.t_s)),
                         map::svg_number(y_px(sample.clearance_m)));
  }
  curve += fmt::format("V{}Z", map::svg_number(base_px));
  for (const double t_s : {start_s, picture.drive.end_s()}) {
    labels += map::svg_text("small mid", {x_px(t_s), base_px + 17.0}, fmt::format("{:.1f} s", t_s));
  }
  const double least_px = x_px(report.least_clearance_at_s);
  return map::svg_path("grid", grid) + map::svg_path("plot", curve) +
         fmt::format("<circle class=\"least\" cx=\"{}\" cy=\"{}\" r=\"4\"/>\n",
                     map::svg_number(least_px), map::svg_number(y_px(report.least_clearance_m))) +
         labels + map::svg_text("", {left_px, top_px + 18.0}, "Clearance along the drive");
}

std::string close_up_of(const AuditPicture& picture, double top_px) {
  const std::vector<ReportPicture> pictures =
      close_ups(picture.report,
                {picture.drive, picture.parts, [&](const map::Box2&) { return picture.occupied; },
                 picture.lanes, picture.moving});
  if (pictures.empty()) return {};
  return fmt::format("<g transform=\"translate({} {}) scale(.78)\">{}</g>\n",
                     map::svg_number(kPlotWidth_px + 2.0 * kMargin_px),
                     map::svg_number(top_px + 6.0), pictures.front().svg);
}

std::string panel_svg(const AuditPicture& picture, double top_px) {
  return fmt::format("<rect class=\"head\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
                     map::svg_number(top_px), kAuditWidth_px, kPanelHeight_px) +
         clearance_svg(picture, top_px) + close_up_of(picture, top_px);
}

}  // namespace

std::string audit_svg(const AuditPicture& picture) {
  const map::PictureFrame frame = look_at(picture);
  const std::string height = map::svg_number(frame.size_px.y() + kPanelHeight_px);
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
             "viewBox=\"0 0 {0} {1}\" role=\"img\">\n<title>Audit of a drive</title>\n{2}"
             "<rect class=\"ground\" width=\"{0}\" height=\"{1}\"/>\n",
             kAuditWidth_px, height, kAuditStyle) +
         audited_lanes_svg(picture, frame) + occupied_around_audit_svg(picture, frame) +
         obstacles_around_audit_svg(picture, frame) + drive_svg(picture, frame) +
         conflicts_svg(picture, frame) + header_svg(picture, frame) +
         panel_svg(picture, frame.size_px.y()) + "</svg>\n";
}

}  // namespace roadbed::tools::report
