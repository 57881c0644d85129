// Lines for a planner in; what each says is seen, or InputError out. Planning takes a thousand
// times as long as reading: answers are asked for of every 1024th input only, by its bytes.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/simulation/pilot_lines.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed;
  static const auto town =
      std::make_shared<map::RoadMap>(map::load_map(tests::data_folder() / "town.xodr"));
  const std::string text(reinterpret_cast<const char*>(data), size);
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    try {
      tools::parse_pilot_view(*town, line, "line");
    } catch (const map::InputError&) {
      continue;  // refused, as it should be
    }
  }
  if (std::accumulate(data, data + size, std::size_t{0}) % 1024 != 0) return 0;
  planning::Pilot pilot({.road_map = town, .goal = {*town->find_lane("3100/0/-2"), 30.0}});
  std::istringstream again(text);
  std::ostringstream out;
  tools::answer_lines(pilot, *town, again, out, {.tells_objects = true, .most_bytes = 400});
  return 0;
}
