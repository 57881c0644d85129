#include <limits>

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
  }
}

}  // namespace roadbed::tools::report
