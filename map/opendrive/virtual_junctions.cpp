#include "roadbed/map/opendrive/element_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace roadbed::map::opendrive {
namespace {

// Sections this near to a station begin there.
constexpr double kSameStationM = 1e-6;
// A few bytes of link could copy a section of many lanes; no real network comes near.
constexpr std::size_t kMostCopies = 200'000;

std::size_t section_at(const RoadRecord& road, double s_m) {
  const auto after =
      std::upper_bound(road.sections.begin(), road.sections.end(), s_m + kSameStationM,
                       [](double s, const LaneSection& section) { return s < section.s_m; });
  return after == road.sections.begin()
             ? 0
             : static_cast<std::size_t>(after - road.sections.begin()) - 1;
}

// What begins at a station inside a section: the same lanes, each following itself.
LaneSection split_off(LaneSection& section, double s_m) {
  LaneSection second = section;
  second.s_m = s_m;
  for (auto& [id, lane] : second.lanes) {
    if (id != 0) lane.predecessors = {id};
  }
  for (auto& [id, lane] : section.lanes) {
    if (id != 0) lane.successors = {id};
  }
  return second;
}

// @param stations_m  in order, inside the road.
void split(RoadRecord& road, const std::vector<double>& stations_m) {
  std::vector<LaneSection> sections;
  auto station = stations_m.begin();
  for (std::size_t i = 0; i < road.sections.size(); ++i) {
    sections.push_back(std::move(road.sections[i]));
    const double end_m = i + 1 < road.sections.size() ? road.sections[i + 1].s_m : road.length_m;
    for (; station != stations_m.end() && *station < end_m - kSameStationM; ++station) {
      if (*station <= sections.back().s_m + kSameStationM) continue;
      LaneSection second = split_off(sections.back(), *station);
      sections.push_back(std::move(second));
    }
  }
  road.sections = std::move(sections);
  connect_sections(road.sections);
}

std::size_t most_lanes(const RoadRecord& road) {
  std::size_t most = 0;
  for (const LaneSection& section : road.sections) most = std::max(most, section.lanes.size());
  return most;
}

using Stations = std::map<std::string, std::vector<double>>;

void collect(const std::optional<RoadLink>& link, Stations& stations) {
  if (link && link->element_s_m) stations[link->element_id].push_back(*link->element_s_m);
}

Stations joined_stations(const Document& document) {
  Stations stations;
  for (const RoadRecord& road : document.roads) {
    collect(road.predecessor, stations);
    collect(road.successor, stations);
  }
  for (const JunctionRecord& junction : document.junctions) {
    for (const JunctionConnection& connection : junction.connections) {
      collect(connection.predecessor, stations);
      collect(connection.successor, stations);
    }
  }
  return stations;
}

}  // namespace

void split_at_virtual_links(Document& document) {
  const Stations stations = joined_stations(document);
  if (stations.empty()) return;
  std::size_t copied = 0;
  for (RoadRecord& road : document.roads) {
    const auto found = stations.find(road.id);
    if (found == stations.end()) continue;
    std::vector<double> inside;
    for (const double s_m : found->second) {
      if (s_m > kSameStationM && s_m < road.length_m - kSameStationM) inside.push_back(s_m);
    }
    std::sort(inside.begin(), inside.end());
    inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
    copied += inside.size() * most_lanes(road);
    if (copied > kMostCopies) {
      document.remarks.push_back({"import.virtual-junction", true, "road " + road.id, road.line,
                                  "is joined in between too often; it is not split there and "
                                  "those links are left out"});
      return;
    }
    const std::size_t before = road.sections.size();
    split(road, inside);
    if (road.sections.size() == before) continue;
    document.remarks.push_back(
        {"import.virtual-junction", false, "road " + road.id, road.line,
         fmt::format("other roads join it in between; its {} lane sections become {}", before,
                     road.sections.size())});
  }
}

std::optional<std::pair<std::size_t, std::size_t>> sections_meeting_at(const RoadRecord& road,
                                                                       double s_m) {
  if (road.sections.empty()) return {};
  const std::size_t index = section_at(road, s_m);
  if (index == 0 || std::abs(road.sections[index].s_m - s_m) > kSameStationM) return {};
  return std::pair{index - 1, index};
}

}  // namespace roadbed::map::opendrive
