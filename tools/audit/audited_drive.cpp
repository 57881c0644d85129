#include "roadbed/tools/audit/audited_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/ground/drive_ground.h"
#include "roadbed/tools/cli/in_threads.h"

namespace roadbed::tools::inline audit {
namespace {

AuditedDrive audit_one(const map::OccupancySource& occupancy, const AuditSubject& subject,
                       const AuditQuestion& question) {
  AuditedDrive audited{.name = subject.name};
  try {
    audited.drive = subject.drive();
    audited.ground = ground_under(occupancy, audited.drive, question.ground);
    audited.report =
        planning::audit_vehicle(surroundings(occupancy, audited.drive, audited.ground, question),
                                audited.drive, question.options, question.moving)
            .whole;
  } catch (const std::exception& error) {
    audited.fault = error.what();
  }
  return audited;
}

// A map and a cloud whose heights are apart cannot be meant for each other.
void check_heights(const map::OccupancySource& occupancy, const map::Ground& ground) {
  constexpr double near_m = 5.0;
  const std::optional<map::Box3> bounds = occupancy.bounds();
  if (!bounds) return;
  const double least_m = bounds->min_in_source.z(), most_m = bounds->max_in_source.z();
  if (ground.highest_m() > least_m - near_m && ground.lowest_m() < most_m + near_m) return;
  throw map::InputError(
      {.file = "ground",
       .place = {},
       .element = {},
       .found = fmt::format("the map's roads lie at z {:.1f} m to {:.1f} m", ground.lowest_m(),
                            ground.highest_m()),
       .needed = fmt::format("the occupancy's {:.1f} m to {:.1f} m", least_m, most_m),
       .remedy = "bring both into one frame, or give --ground Z"});
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

GroundRule ground_rule(const std::string& text, const map::RoadMap* road_map) {
  using Kind = GroundRule::Kind;
  if (const auto level_m = height_in(text)) return {.kind = Kind::level, .level_m = *level_m};
  if (text == "measured") return {.kind = Kind::measured};
  if (road_map == nullptr) return {};
  return {.kind = Kind::map, .road_map = road_map};
}

planning::GroundUnder ground_under(const map::OccupancySource& occupancy,
                                   const geometry::Trajectory& drive, const GroundRule& rule) {
  if (rule.kind == GroundRule::Kind::level) return {.level_m = rule.level_m};
  const bool is_map = rule.kind == GroundRule::Kind::map;
  auto ground = std::make_shared<const map::Ground>(
      is_map ? map::road_under(*rule.road_map, drive)
             : map::measured_under(occupancy, drive, rule.body));
  if (is_map) check_heights(occupancy, *ground);
  planning::GroundUnder under{.level_m = ground->lowest_m()};
  if (!is_map) under.margin_m = map::measured_ground_margin_m(occupancy.resolution_m());
  if (!ground->is_level()) under.surface = std::move(ground);
  return under;
}

std::string ground_note(const planning::GroundUnder& ground, const AuditQuestion& question,
                        double cell_m) {
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

map::BodyReach reach_of(const AuditQuestion& question) {
  map::BodyReach reach;
  for (const geometry::BodyPart& part : question.parts) {
    const double grown_m = part.radius_m + question.options.inflate_m;
    reach.rear_m = std::min(reach.rear_m, part.rear_m - grown_m);
    reach.front_m = std::max(reach.front_m, part.front_m + grown_m);
  }
  return reach;
}

planning::VehicleSurroundings surroundings(const map::OccupancySource& occupancy,
                                           const geometry::Trajectory& drive,
                                           const planning::GroundUnder& ground,
                                           const AuditQuestion& question) {
  map::FieldRegion region = planning::audited_region(drive, question.parts, question.options);
  region.most_cells /= question.drives_at_once;
  return {occupancy, ground, question.parts, region};
}

map::HeightBand AuditQuestion::heights(const planning::GroundUnder& under) const {
  map::HeightBand all{parts.front().from_height_m, parts.front().to_height_m};
  for (const geometry::BodyPart& part : parts) {
    all = {std::min(all.from_m, part.from_height_m), std::max(all.to_m, part.to_height_m)};
  }
  return under.band(all.from_m, all.to_m);
}

geometry::VehicleShape inflated_shape(const AuditQuestion& question) {
  geometry::VehicleShape grown = question.shape;
  grown.length_m += 2.0 * question.options.inflate_m;
  grown.width_m += 2.0 * question.options.inflate_m;
  grown.rear_overhang_m += question.options.inflate_m;
  return grown;
}

std::vector<geometry::BodyPart> inflated_parts(const AuditQuestion& question) {
  std::vector<geometry::BodyPart> parts;
  for (const geometry::BodyPart& part : question.parts) {
    parts.push_back(geometry::inflated(part, question.options.inflate_m));
  }
  return parts;
}

std::vector<AuditedDrive> audit_all(const map::OccupancySource& occupancy,
                                    const std::vector<AuditSubject>& subjects,
                                    const AuditQuestion& question, int threads,
                                    const std::function<void()>& done_one) {
  std::vector<AuditedDrive> audited(subjects.size());
  AuditQuestion shared = question;
  shared.drives_at_once =
      std::clamp<std::size_t>(subjects.size(), 1, static_cast<std::size_t>(std::max(1, threads)));
  in_threads(subjects.size(), threads, [&](std::size_t i) {
    audited[i] = audit_one(occupancy, subjects[i], shared);
    done_one();
  });
  return audited;
}

}  // namespace roadbed::tools
