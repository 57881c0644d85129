#include "roadbed/tools/audit/audited_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <optional>

#include "roadbed/tools/cli/in_threads.h"

namespace roadbed::tools::inline audit {
namespace {

using planning::GroundRule;

AuditedDrive audit_one(const map::OccupancySource& occupancy, const AuditSubject& subject,
                       const planning::AuditQuestion& question) {
  AuditedDrive audited{.name = subject.name};
  try {
    audited.drive = subject.drive();
    audited.audit = planning::audit_drive(occupancy, audited.drive, question);
  } catch (const std::exception& error) {
    audited.fault = error.what();
  }
  return audited;
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

std::vector<AuditedDrive> audit_all(const map::OccupancySource& occupancy,
                                    const std::vector<AuditSubject>& subjects,
                                    const planning::AuditQuestion& question, int threads,
                                    const std::function<void()>& done_one) {
  std::vector<AuditedDrive> audited(subjects.size());
  planning::AuditQuestion shared = question;
  shared.drives_at_once =
      std::clamp<std::size_t>(subjects.size(), 1, static_cast<std::size_t>(std::max(1, threads)));
  in_threads(subjects.size(), threads, [&](std::size_t i) {
    audited[i] = audit_one(occupancy, subjects[i], shared);
    done_one();
  });
  return audited;
}

}  // namespace roadbed::tools::audit
