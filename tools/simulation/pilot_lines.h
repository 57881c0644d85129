#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/pilot/pilot.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline simulation {

// The planner as a process: what outside_planner.h asks, from the other side. A line of JSON comes
// in, a line goes out; keys are in README.md. Coordinates are the source's.

/// What one line says is seen.
/// @param name  stands for the line in messages.
/// @throws InputError with its place, also where a light is not in the map.
planning::PilotView parse_pilot_view(const map::RoadMap& road_map, std::string_view line,
                                     const std::string& name);

/// The answer to it, on one line.
/// @param pilot  whose objects are told, too; none: they are not.
std::string pilot_answer_line(const map::RoadMap& road_map, double t_s,
                              const planning::PilotAnswer& answer,
                              const planning::Pilot* pilot = nullptr);

/// The answer to a line that cannot be used: what is wrong with it; the last trajectory holds.
std::string pilot_refusal_line(const std::string& fault);

struct PilotLineOptions {
  bool tells_objects = false;           ///< what is believed of them, in each answer
  std::size_t most_bytes = 16'000'000;  ///< of a line
};

/// Answers line by line until there is none.
/// @returns lines that could not be used.
std::size_t answer_lines(planning::Pilot& pilot, const map::RoadMap& road_map, std::istream& in,
                         std::ostream& out, const PilotLineOptions& options = {});

}  // namespace roadbed::tools::simulation
