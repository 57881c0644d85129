#include "roadbed/tools/audit/audited_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace roadbed::tools::inline audit {
namespace {

using planning::GroundRule;

void take_excursion(const planning::Excursion& out, planning::AuditReport& whole) {
  planning::Conflict& conflict = whole.conflicts.emplace_back();
  conflict.from_s = out.from_s;
  conflict.to_s = out.to_s;
  conflict.least_clearance_m = out.least_margin_m;
  conflict.at = out.at;
  const Eigen::Vector2d& witness = out.depth_m > 0.0 ? out.point_in_source : out.edge_in_source;
  conflict.witness = {witness, witness};
  conflict.part = out.part;
}

std::optional<double> height_in(const std::string& text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

std::string ground_rule_fault(const std::string& text) {
  if (text == "map" || text == "measured") return {};
  constexpr double farthest_m = 1e5;
  const auto height_m = height_in(text);
  const bool is_height = height_m && std::abs(*height_m) <= farthest_m;
  return is_height ? "" : "is neither a height nor map nor measured";
}

planning::GroundRule ground_rule(const std::string& text, const map::RoadMap* road_map) {
  using Kind = GroundRule::Kind;
  if (const auto level_m = height_in(text)) return {.kind = Kind::level, .level_m = *level_m};
  if (text == "measured") return {.kind = Kind::measured};
  if (road_map == nullptr) return {};
  return {.kind = Kind::map, .road_map = road_map};
}

std::string ground_note(const planning::GroundUnder& ground,
                        const planning::AuditQuestion& question, double cell_m) {
  if (question.ground.kind == GroundRule::Kind::level) return {};
  const bool is_map = question.ground.kind == GroundRule::Kind::map;
  const double low_m = ground.surface ? ground.surface->lowest_m() : ground.level_m;
  const double high_m = ground.surface ? ground.surface->highest_m() : ground.level_m;
  const std::string note =
      fmt::format("note: heights are above the {}, z {:.2f} m to {:.2f} m along the drive\n",
                  is_map ? "map's road" : "measured ground", low_m, high_m);
  const double underside_m =
      std::ranges::min(question.parts, {}, &geometry::BodyPart::from_height_m).from_height_m -
      ground.margin_m;
  // With cells as high as the vehicle's underside the ground itself reaches into the band.
  const bool is_exact = !ground.surface && ground.margin_m == 0.0;
  if (is_exact || underside_m > cell_m) return note;
  return note + fmt::format(
                    "note: cells of {} m: the ground's own reach up to where heights begin, "
                    "{:.3g} m; raise --from-height, or build finer cells\n",
                    cell_m, underside_m);
}

void AuditedDrive::take(DriveOfFile read) {
  drive = std::move(read.drive);
  notes = std::move(read.notes);
  for (const DriveGap& gap : read.gaps) {
    between_poses.push_back(
        {std::max(gap.from_s, drive.start_s()), std::min(gap.to_s, drive.end_s())});
  }
}

std::string_view AuditedDrive::outcome() const {
  using planning::Verdict;
  if (!fault.empty()) return "unusable";
  const Verdict of_occupancy = has_occupancy ? audit.report.verdict : Verdict::clear;
  const Verdict of_road = road ? road->verdict() : Verdict::clear;
  const Verdict of_poses = between_poses.empty() ? Verdict::clear : Verdict::unknown;
  for (const Verdict grave : {Verdict::conflict, Verdict::unknown, Verdict::undecided}) {
    if (of_occupancy == grave || of_road == grave || of_poses == grave) {
      return planning::to_string(grave);
    }
  }
  return planning::to_string(Verdict::clear);
}

planning::AuditReport AuditedDrive::whole() const {
  planning::AuditReport whole = audit.report;
  if (!road) return whole;
  const planning::SurfaceReport& surface = road->surface;
  if (!has_occupancy) {
    whole.verdict = surface.verdict;
    whole.least_clearance_m = surface.least_margin_m;
    whole.proven_clearance_m = surface.proven_margin_m;
    whole.least_clearance_at_s = surface.least_margin_at_s;
    whole.beyond_horizon = surface.beyond_horizon;
    whole.part = surface.part;
    if (!surface.beyond_horizon) whole.witness = {surface.edge_in_source, surface.edge_in_source};
  }
  for (const planning::Excursion& out : surface.conflicts) take_excursion(out, whole);
  std::ranges::stable_sort(whole.conflicts, {}, &planning::Conflict::from_s);
  whole.undecided.insert(whole.undecided.end(), surface.undecided.begin(), surface.undecided.end());
  whole.undecided = planning::joined(std::move(whole.undecided));
  whole.verdict = planning::verdict_of(whole);
  return whole;
}

void finish_audit(const AuditDemand& demand, AuditedDrive& audited) {
  if (!audited.between_poses.empty()) {
    planning::leave_unknown(audited.between_poses, audited.audit);
  }
  if (demand.road != nullptr) {
    audited.road = audit_road(audited.drive, demand.question.inflated_parts(), *demand.road,
                              demand.question.certifies);
  }
}

void audit_one(const AuditDemand& demand, AuditedDrive& audited,
               const std::function<void(const planning::GroundUnder&)>& on_ground) {
  audited.has_occupancy = demand.occupancy != nullptr;
  if (demand.occupancy != nullptr) {
    audited.audit =
        planning::audit_drive(*demand.occupancy, audited.drive, demand.question, on_ground);
  }
  finish_audit(demand, audited);
}

}  // namespace roadbed::tools::audit
