#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <optional>

#include "roadbed/map/opendrive/rules/cubic.h"
#include "roadbed/map/opendrive/rules/lane_links.h"
#include "roadbed/map/opendrive/rules/records.h"

namespace roadbed::map::opendrive::rules {
namespace {

Cubics elevation(const RoadSource& road) {
  return holding(road.record.elevation.listed, road.record.length_m);
}

Cubics superelevation(const RoadSource& road) {
  return holding(road.record.superelevation.listed, road.record.length_m);
}

Cubics lane_offset(const RoadSource& road) {
  return holding(road.record.lane_offset.listed, road.record.length_m);
}

struct Quantity {
  const char *name, *unit;
};

/// A step of a profile's value from one record to the next.
void add_step(validation::Report& report, const Source& source, const RoadSource& road,
              const CubicElement& before, double length_m, const CubicElement& after,
              double max_step, const Quantity& what) {
  const double step = after.record.a - value_at(before.record, length_m);
  if (std::abs(step) <= max_step) return;
  add_record(report, source, road, after, after.record.s_m,
             fmt::format("{} steps by {:.3f} {} at s {:.3f} m; make the records meet", what.name,
                         step, what.unit, after.record.s_m));
}

void find_steps(const Source& source, const RoadSource& road, const Cubics& records,
                double max_step, const Quantity& what, validation::Report& report) {
  for_each_record(records, road.record.length_m,
                  [&](const CubicElement& before, double length_m, const CubicElement* after) {
                    if (after == nullptr) return;
                    add_step(report, source, road, before, length_m, *after, max_step, what);
                  });
}

void elevation_steps(const Source& source, const validation::ValidateOptions& options,
                     validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    find_steps(source, road, elevation(road), options.max_step_m, {"elevation", "m"}, report);
  }
}

void superelevation_steps(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  constexpr double kMaxStep = 0.01;  // [rad], 5 cm at 5 m from the middle
  for (const RoadSource& road : source.roads) {
    find_steps(source, road, superelevation(road), kMaxStep, {"superelevation", "rad"}, report);
  }
}

/// The section that begins there; null for the first one, or if there is none.
const LaneSection* section_from(const RoadSource& road, double s_m) {
  constexpr double kSame_m = 0.01;
  const auto& sections = road.record.sections;
  if (sections.empty()) return nullptr;
  const auto found = std::find_if(
      sections.begin() + 1, sections.end(),
      [&](const LaneSection& section) { return std::abs(section.s_m - s_m) < kSame_m; });
  return found == sections.end() ? nullptr : &*found;
}

/// How far the inner border of a lane is from the lane offset, to the left; none if a width between
/// them is missing.
std::optional<double> inner_m(LaneEnd at) {
  const int sign = at.lane->id > 0 ? 1 : -1, last = std::abs(at.lane->id);
  double sum_m = 0.0;
  for (int i = 1; i < last; ++i) {
    at.lane = at.section->find(sign * i);
    const std::optional<double> width = at.lane ? at.width_m() : std::nullopt;
    if (!width) return {};
    sum_m += sign * *width;
  }
  return sum_m;
}

/// By how much the inner border of the innermost lane of a side that goes on from one section to
/// the next moves against the lane offset; none if no lane goes on.
std::optional<double> move_m(const RoadSource& road, const LaneSection& after, int sign) {
  const LaneSection& before = *std::prev(&after);
  for (int id = sign; const LaneRecord* lane = before.find(id); id += sign) {
    if (lane->successors.empty()) continue;
    const LaneRecord* next = after.find(lane->successors.front());
    if (next == nullptr || next->id == 0) continue;
    const auto from = inner_m({&road, &before, lane, ContactPoint::end});
    const auto to = inner_m({&road, &after, next, ContactPoint::start});
    if (from && to) return *to - *from;
  }
  return {};
}

/// Whether the lanes make up for a step of the lane offset where a section begins, as they do where
/// they are numbered from another line on.
bool is_made_up_for(const RoadSource& road, const LaneSection& after, double step_m,
                    double most_m) {
  const auto left = move_m(road, after, 1), right = move_m(road, after, -1);
  const auto fits = [&](const std::optional<double>& move) {
    return !move || std::abs(step_m + *move) <= most_m;
  };
  return fits(left) && fits(right);
}

void lane_offset_steps(const Source& source, const validation::ValidateOptions& options,
                       validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for_each_record(lane_offset(road), road.record.length_m,
                    [&](const CubicElement& before, double length_m, const CubicElement* after) {
                      if (after == nullptr) return;
                      const double step_m = after->record.a - value_at(before.record, length_m);
                      if (std::abs(step_m) <= options.max_step_m) return;
                      const LaneSection* section = section_from(road, after->record.s_m);
                      if (section && is_made_up_for(road, *section, step_m, options.max_step_m)) {
                        return;
                      }
                      add_step(report, source, road, before, length_m, *after, options.max_step_m,
                               {"lane offset", "m"});
                    });
  }
}

void slope_jumps(const Source& source, const validation::ValidateOptions& options,
                 validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for_each_record(elevation(road), road.record.length_m,
                    [&](const CubicElement& before, double length_m, const CubicElement* after) {
                      if (after == nullptr) return;
                      const double jump = after->record.b - slope_at(before.record, length_m);
                      if (std::abs(jump) <= options.max_slope_jump) return;
                      add_record(
                          report, source, road, *after, after->record.s_m,
                          fmt::format("the road's slope jumps by {:.1f} % at s {:.3f} m; round the "
                                      "elevation off",
                                      100.0 * jump, after->record.s_m));
                    });
  }
}

void steep_roads(const Source& source, const validation::ValidateOptions& options,
                 validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for_each_record(elevation(road), road.record.length_m,
                    [&](const CubicElement& record, double length_m, const CubicElement*) {
                      const LeastValue steepest = greatest_slope(record.record, length_m);
                      if (steepest.value <= options.max_slope || length_m == 0.0) return;
                      add_record(
                          report, source, road, record, record.record.s_m + steepest.ds_m,
                          fmt::format("the road's slope reaches {:.0f} % at s {:.2f} m, more than "
                                      "a car climbs; correct the elevation",
                                      100.0 * steepest.value, record.record.s_m + steepest.ds_m));
                    });
  }
}

void steep_crossfalls(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  constexpr double kSteepest = 0.35;  // [rad]; roads stay below 0.1, test tracks go beyond 0.5
  for (const RoadSource& road : source.roads) {
    for (const CubicElement& record : superelevation(road)) {
      if (std::abs(record.record.a) <= kSteepest) continue;
      add_record(
          report, source, road, record, record.record.s_m,
          fmt::format("superelevation is {:.2f} rad at s {:.2f} m; check whether it is meant in "
                      "degrees",
                      record.record.a, record.record.s_m));
      break;
    }
  }
}

/// Elevations of real roads, from the Dead Sea's shore to the highest passes [m].
bool is_on_earth(double elevation_m) { return elevation_m > -450.0 && elevation_m < 6000.0; }

void elevation_outliers(const Source& source, const validation::ValidateOptions&,
                        validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const CubicElement& record : elevation(road)) {
      if (is_on_earth(record.record.a)) continue;
      add_record(report, source, road, record, record.record.s_m,
                 fmt::format("elevation is {:.1f} m at s {:.2f} m, where no road is; correct it",
                             record.record.a, record.record.s_m));
      break;
    }
  }
}

constexpr std::array<SourceRule, 7> kProfileRules = {{
    {{"elevation.step",
      {},
      validation::Severity::warning,
      "the elevation of a road steps by more than --max-step"},
     elevation_steps},
    {{"elevation.slope-jump",
      {},
      validation::Severity::warning,
      "the slope of a road jumps by more than --max-slope-jump"},
     slope_jumps},
    {{"elevation.steep", {}, validation::Severity::warning, "a road is steeper than --max-slope"},
     steep_roads},
    {{"elevation.outlier",
      {},
      validation::Severity::warning,
      "a road is below -450 m or above 6000 m, where no road is"},
     elevation_outliers},
    {{"superelevation.step",
      {},
      validation::Severity::warning,
      "the superelevation of a road steps by more than 0.01 rad"},
     superelevation_steps},
    {{"superelevation.steep",
      {},
      validation::Severity::info,
      "superelevation is more than 0.35 rad"},
     steep_crossfalls},
    {{"lane-offset.step",
      {},
      validation::Severity::warning,
      "the lane offset of a road steps by more than --max-step, which its lanes do not make up "
      "for"},
     lane_offset_steps},
}};

}  // namespace

std::span<const SourceRule> profile_rules() { return kProfileRules; }

}  // namespace roadbed::map::opendrive::rules
