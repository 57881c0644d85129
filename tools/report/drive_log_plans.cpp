#include <algorithm>
#include <limits>
#include <set>

#include "roadbed/geometry/curves/quintic.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/tools/report/drive_log.h"

namespace roadbed::tools::inline report {
namespace {

using map::ProtoWriter;

double or_nan(const std::optional<double>& value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

ProtoWriter hypothesis_proto(const planning::HypothesisOutcome& one) {
  ProtoWriter proto;
  proto.bytes(1, planning::to_string(one.maneuver))
      .number(2, or_nan(one.end_d_m))
      .number(3, or_nan(one.end_l_m))
      .number(4, or_nan(one.path_cost))
      .number(5, or_nan(one.drive_cost))
      .whole(6, one.is_driven ? 1 : 0)
      .bytes(7, map::visible_text(one.reason));
  return proto;
}

ProtoWriter candidates_proto(std::int64_t time_ns, const planning::LateralState& start,
                             const planning::CandidateGrid& grid) {
  ProtoWriter proto;
  proto.message(1, time_proto(time_ns))
      .number(2, start.s_m)
      .number(3, start.d_m)
      .number(4, start.d_slope)
      .number(5, start.d_curvature_per_m);
  for (const double end_d_m : grid.end_d_m) proto.number(6, end_d_m);
  for (const double end_l_m : grid.end_l_m) proto.number(7, end_l_m);
  proto.bytes(8, {reinterpret_cast<const char*>(grid.causes.data()), grid.causes.size()});
  for (int cause = 0; cause < planning::kRejections; ++cause) {
    proto.bytes(9, planning::to_string(static_cast<planning::Rejection>(cause)));
  }
  return proto;
}

// By cause, as on pages: Okabe and Ito's.
constexpr std::array<FoxgloveColor, planning::kRejections> kCauseColors{{{0.0, 0.62, 0.45},
                                                                         {0.54, 0.58, 0.64},
                                                                         {0.34, 0.71, 0.91},
                                                                         {0.0, 0.45, 0.70},
                                                                         {0.80, 0.47, 0.65},
                                                                         {0.84, 0.37, 0.0}}};
constexpr std::size_t kFeasible = static_cast<std::size_t>(planning::Rejection::none);
constexpr std::size_t kShownOffsets = 16;

// Which of a grid are drawn: of the shortest, the middle and the longest, 16 at most.
std::vector<std::size_t> shown_candidates(const planning::CandidateGrid& grid) {
  const std::size_t offsets = grid.end_d_m.size(), lengths = grid.end_l_m.size();
  const std::size_t stride = (offsets + kShownOffsets - 1) / kShownOffsets;
  std::vector<std::size_t> shown;
  for (const std::size_t length : std::set{std::size_t{0}, lengths / 2, lengths - 1}) {
    for (std::size_t i = 0; i < offsets; i += stride) shown.push_back(length * offsets + i);
  }
  return shown;
}

LineInSource candidate_path(const geometry::Polyline& line, const planning::LateralState& start,
                            double end_d_m, double end_l_m) {
  constexpr int pieces = 12;
  const geometry::Quintic d_m({start.d_m, start.d_slope, start.d_curvature_per_m}, {end_d_m},
                              end_l_m);
  LineInSource path;
  for (int i = 0; i <= pieces; ++i) {
    const double l_m = end_l_m * i / pieces;
    path.push_back(line.pose_at(start.s_m + l_m) * Eigen::Vector2d(0.0, d_m.at(l_m)[0]));
  }
  return path;
}

}  // namespace

void DriveLog::add_plans() {
  for (const DriveCycle& cycle : input_.drive.cycles) {
    const std::int64_t time_ns = at_ns(cycle.t_s);
    if (!cycle.path.empty()) {
      add("/plan", "foxglove.PosesInFrame", time_ns,
          poses_along(time_ns, kSceneFrame, in_scene(cycle.path, 0.05)));
    }
    add_considered(cycle, time_ns);
  }
}

void DriveLog::add_considered(const DriveCycle& cycle, std::int64_t time_ns) {
  if (!cycle.hypotheses.empty()) {
    ProtoWriter all;
    all.message(1, time_proto(time_ns));
    for (const auto& one : cycle.hypotheses) all.message(2, hypothesis_proto(one));
    add("/plan/hypotheses", "roadbed.Hypotheses", time_ns, all.bytes());
  }
  if (cycle.grid) {
    add("/plan/candidates", "roadbed.Candidates", time_ns,
        candidates_proto(time_ns, cycle.start, *cycle.grid).bytes());
    add_candidate_lines(cycle, time_ns);
  }
}

void DriveLog::add_candidate_lines(const DriveCycle& cycle, std::int64_t time_ns) {
  const planning::CandidateGrid& grid = *cycle.grid;
  const std::size_t number = line_at(input_.drive, cycle.t_s);
  if (grid.causes.empty() || number >= input_.scene.references.size()) return;
  const geometry::Polyline line(input_.scene.references[number]);
  std::vector<SceneEntity> by_cause;
  for (std::size_t cause = 0; cause < kCauseColors.size(); ++cause) {
    const auto name = planning::to_string(static_cast<planning::Rejection>(cause));
    by_cause.emplace_back(time_ns, kSceneFrame,
                          cause == kFeasible ? "feasible" : std::string(name));
    by_cause.back().word("candidates",
                         std::to_string(std::ranges::count(grid.causes, std::uint8_t(cause))));
  }
  for (const std::size_t i : shown_candidates(grid)) {
    const std::size_t cause = grid.causes[i], offsets = grid.end_d_m.size();
    const LineInSource path =
        candidate_path(line, cycle.start, grid.end_d_m[i % offsets], grid.end_l_m[i / offsets]);
    by_cause[cause].line(in_scene(path, 0.04), cause == kFeasible ? 0.06 : 0.03,
                         kCauseColors[cause]);
  }
  add("/plan/candidate_lines", "foxglove.SceneUpdate", time_ns,
      scene_update(time_ns, by_cause, true));
}

}  // namespace roadbed::tools::report
