// Lines for a planner in, an answer for each out, whatever they are.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <sstream>
#include <string>

#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/simulation/pilot_lines.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed;
  static const auto town =
      std::make_shared<map::RoadMap>(map::load_map(tests::data_folder() / "town.xodr"));
  planning::Pilot pilot({.road_map = town, .goal = {*town->find_lane("6/0/-1"), 100.0}});
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  std::ostringstream out;
  tools::answer_lines(pilot, *town, in, out, {.most_bytes = 100'000});
  return 0;
}
