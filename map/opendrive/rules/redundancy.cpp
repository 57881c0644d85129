// What a file says twice: it can be left out without changing the road.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/opendrive/rules/cubic.h"
#include "roadbed/map/opendrive/rules/source.h"
#include "roadbed/map/opendrive/values.h"

namespace roadbed::map::opendrive::rules {
namespace {

constexpr double kNothing = 1e-6;  // [m], [rad] a difference that no road has

/// Whether the record says over its length what the one before it would, too: cubics that agree at
/// four stations are the same.
bool goes_on(const geometry::CubicRecord& before, const geometry::CubicRecord& record,
             double length_m) {
  for (const double fraction : {0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0}) {
    const double ds_m = fraction * length_m;
    const double old = value_at(before, record.s_m - before.s_m + ds_m);
    if (!(std::abs(value_at(record, ds_m) - old) <= kNothing)) return false;
  }
  return true;
}

/// Whether the record could be left out: where it holds it goes on as the one before it, or it says
/// the same again at one station.
bool is_redundant(const geometry::CubicRecord& before, const geometry::CubicRecord& record,
                  double length_m) {
  if (length_m > 0.0) return goes_on(before, record, length_m);
  constexpr double kAny_m = 1.0;
  return record.s_m - before.s_m <= kRoundingM && goes_on(before, record, kAny_m);
}

/// A profile, called what, and where its last record ends.
struct Records {
  const Profile& profile;
  const char* name;
  double to_s_m;
};

void find_redundant(const Source& source, const RoadSource& road, const Records& where,
                    const std::string& element, validation::Report& report) {
  const std::vector<CubicElement> records = whole(where.profile.listed);
  for (std::size_t i = 1; i < records.size(); ++i) {
    const geometry::CubicRecord& record = records[i].record;
    const double end_m = i + 1 < records.size() ? records[i + 1].record.s_m : where.to_s_m;
    if (!is_redundant(records[i - 1].record, record, end_m - record.s_m)) continue;
    validation::Finding& finding =
        add_at(report, source, road, records[i].node,
               fmt::format("<{}> at s {:.3f} m only says how the one before it goes on; remove it",
                           where.name, record.s_m));
    finding.element = element;
    finding.in_map = road.place_at(record.s_m);
  }
}

void redundant_records(const Source& source, const validation::ValidateOptions&,
                       validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    const auto find = [&](const Profile& profile, const char* name) {
      find_redundant(source, road, {profile, name, road.record.length_m}, road.element(), report);
    };
    find(road.record.elevation, "elevation");
    find(road.record.superelevation, "superelevation");
    find(road.record.lane_offset, "laneOffset");
    for (const LaneSection& section : road.record.sections) {
      for (const LaneRecord& lane : section.listed()) {
        const std::string element = lane_element(road, section, lane.id);
        const double end_s_m = road.end_s_m(section);
        find_redundant(source, road, {lane.width, "width", end_s_m}, element, report);
        find_redundant(source, road, {lane.border, "border", end_s_m}, element, report);
      }
    }
  }
}

bool is_line(const CurveSource& piece) {
  return piece.start && piece.end && piece.record.node.child("line");
}

/// Whether the second line begins where the first ends, in its direction.
bool goes_straight_on(const CurveSource& before, const CurveSource& piece) {
  const double gap_m = (piece.start->pose.position() - before.end->pose.position()).norm();
  const double turn =
      geometry::wrap_angle(piece.start->pose.heading_rad - before.end->pose.heading_rad);
  return gap_m <= 1e-3 && std::abs(turn) <= kNothing;
}

void redundant_lines(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (std::size_t i = 1; i < road.geometry.size(); ++i) {
      const CurveSource &before = road.geometry[i - 1], &piece = road.geometry[i];
      if (!is_line(before) || !is_line(piece) || !goes_straight_on(before, piece)) continue;
      validation::Finding& finding = add_at(
          report, source, road, piece.record.node,
          fmt::format(
              "the line at s {:.3f} m goes on straight from the one before it; make them one",
              piece.record.s_m));
      finding.in_map = piece.start->pose.position();
    }
  }
}

/// That a connecting road has one connection only was asked for by revision 1.7 alone: the others
/// let one with lanes in both directions have two.
void repeated_connecting_roads(const Source& source, const validation::ValidateOptions&,
                               validation::Report& report) {
  if (source.document.version != "1.7") return;
  std::map<std::string_view, const JunctionConnection*> first;
  for (const JunctionRecord& junction : source.document.junctions) {
    for (const JunctionConnection& connection : junction.connections) {
      if (connection.direct || connection.connecting_road.empty()) continue;
      const auto [known, is_new] = first.emplace(connection.connecting_road, &connection);
      if (is_new) continue;
      const RoadSource* found = source.find_road(connection.connecting_road);
      report
          .add(fmt::format("junction {}", junction.id), found ? found->place() : std::nullopt,
               fmt::format("connection {} leads over road {}, as connection {} does already; put "
                           "their laneLinks into one",
                           connection.node.attribute("id").value(), connection.connecting_road,
                           known->second->node.attribute("id").value()))
          .line = connection.line;
    }
  }
}

constexpr std::array<SourceRule, 3> kRules = {{
    {{"profile.redundant", "asam.net:xodr:1.7.0:performance.avoid_redundant_info",
      validation::Severity::info,
      "a record of elevation, superelevation, lane offset, width or border changes nothing"},
     redundant_records},
    {{"curve.redundant", "asam.net:xodr:1.7.0:performance.avoid_redundant_info",
      validation::Severity::info, "two lines of the reference line are one"},
     redundant_lines},
    {{"junction.repeated-road", "asam.net:xodr:1.7.0:junctions.connection.one_connection_element",
      validation::Severity::warning,
      "two connections of a revision 1.7 file lead over one connecting road"},
     repeated_connecting_roads},
}};

}  // namespace

std::span<const SourceRule> redundancy_rules() { return kRules; }

}  // namespace roadbed::map::opendrive::rules
