#include "roadbed/map/derived/crowded.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "roadbed/map/derived/conflicts.h"
#include "roadbed/map/derived/crossings.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"

namespace roadbed::map {
namespace {

// Lanelets of 100 m on each other, all of which turn.
RoadMap turns_on_each_other(int count) {
  std::string text = R"(<osm version="0.6">)";
  for (int i = 0; i < 4; ++i) {
    text += fmt::format(
        R"(<node id="{}" lat="0" lon="0"><tag k="local_x" v="{}"/><tag k="local_y" v="{}"/></node>)",
        i + 1, 100 * (i % 2), 3 * (i / 2));
  }
  for (int way = 0; way < 2; ++way) {
    text += fmt::format(
        R"(<way id="{}"><nd ref="{}"/><nd ref="{}"/><tag k="type" v="line_thin"/></way>)", way + 11,
        2 * way + 1, 2 * way + 2);
  }
  for (int i = 0; i < count; ++i) {
    text += fmt::format(
        R"(<relation id="{}"><member type="way" ref="12" role="left"/><member type="way" ref="11" )"
        R"(role="right"/><tag k="type" v="lanelet"/><tag k="subtype" v="road"/><tag )"
        R"(k="turn_direction" v="left"/></relation>)",
        i + 100);
  }
  return parse_map(text + "</osm>", "turns.osm");
}

template <typename Ask>
std::string refusal_of(const Ask& ask) {
  try {
    ask();
  } catch (const InputError& error) {
    return error.what();
  }
  return "answered";
}

TEST(Crowded, LanesOnEachOtherAreToldUpToALimit) {
  for (const auto& [count, answer] : {std::pair(20, "answered"), std::pair(1000, "map clip")}) {
    const RoadMap road_map = turns_on_each_other(count);
    const std::vector<bool> all(road_map.lanes().size(), true);
    EXPECT_THAT(refusal_of([&] { crossings_of_lanes(road_map, all); }), testing::HasSubstr(answer));
    EXPECT_THAT(refusal_of([&] { find_conflicts(road_map); }), testing::HasSubstr(answer));
  }
}

}  // namespace
}  // namespace roadbed::map
