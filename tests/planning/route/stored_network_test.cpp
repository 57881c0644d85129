#include "roadbed/planning/route/route_network.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "roadbed/map/compiled/compiled_map.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tests/support/lane_grid.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::planning {
namespace {

TEST(StoredNetwork, IsReadAsItWasWritten) {
  const auto town = map::load_map(tests::data_folder() / "town.xodr");
  for (const RouteNetwork& network : {tests::lane_grid(3, 2), make_route_network(town)}) {
    const std::string bytes = write_route_network(network);
    std::size_t on_map = 0;
    for (std::uint32_t i = 0; i < network.lanes.size(); ++i)
      on_map += network.is_reversed(i) ? 0 : 1;
    const auto read = read_route_network(bytes, on_map);
    ASSERT_TRUE(read);
    EXPECT_EQ(write_route_network(*read), bytes);
    EXPECT_EQ(read->successors.items, network.successors.items);
    EXPECT_EQ(read->left_windows.items, network.left_windows.items);
    for (std::size_t i = 0; i < network.lanes.size(); ++i) {
      EXPECT_EQ(read->lanes[i].length_m, network.lanes[i].length_m);
      EXPECT_EQ(read->lanes[i].end_in_map, network.lanes[i].end_in_map);
      EXPECT_EQ(read->lanes[i].turn, network.lanes[i].turn);
      EXPECT_EQ(read->lanes[i].users, network.lanes[i].users);
    }
  }
}

TEST(StoredNetwork, OfACompiledMapGivesTheRoutesOfItsSource) {
  const auto town = map::load_map(tests::data_folder() / "town.xodr");
  const auto compiled = map::read_compiled_map(
      map::write_compiled_map(town, write_route_network(make_route_network(town))), "town.rbm");
  Router from_source(town), from_compiled(compiled);
  std::mt19937 random(20261121);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    const auto any_lane = [&] {
      return map::LaneId{static_cast<std::uint32_t>(random() % town.lanes().size())};
    };
    const map::LanePlace from{any_lane(), 0.0, 0.0}, to{any_lane(), 1.0, 0.0};
    if (town.lane(to.lane).length_m() < to.s_m) continue;
    const RouteAnswer one = from_source.find(from, to), other = from_compiled.find(from, to);
    ASSERT_EQ(one.reason, other.reason);
    if (!one.route) continue;
    ++found;
    EXPECT_EQ(one.route->cost_s, other.route->cost_s);
    ASSERT_EQ(one.route->legs.size(), other.route->legs.size());
    for (std::size_t j = 0; j < one.route->legs.size(); ++j) {
      EXPECT_EQ(one.route->legs[j].lane, other.route->legs[j].lane);
      EXPECT_EQ(one.route->legs[j].to_s_m, other.route->legs[j].to_s_m);
    }
  }
  EXPECT_GT(found, 10);
}

TEST(StoredNetwork, OfAnotherVersionOrNoneIsMadeAnew) {
  std::string bytes = write_route_network(tests::lane_grid(2, 2));
  ++bytes.front();
  EXPECT_FALSE(read_route_network(bytes, tests::lane_grid(2, 2).lanes.size()));
  EXPECT_FALSE(read_route_network("", 7));
}

TEST(StoredNetwork, ThatIsDamagedIsRefused) {
  const RouteNetwork network = tests::lane_grid(2, 1);
  const std::string bytes = write_route_network(network);
  const std::size_t lanes = network.lanes.size();
  EXPECT_THROW(read_route_network(bytes, lanes + 1), std::invalid_argument);
  EXPECT_THROW(read_route_network(bytes + "x", lanes), std::invalid_argument);
  for (std::size_t size = 1; size < bytes.size(); size += 37) {
    EXPECT_THROW(read_route_network(bytes.substr(0, size), lanes), std::invalid_argument) << size;
  }
  RouteNetwork wild = network;
  wild.successors.items.front() = static_cast<std::uint32_t>(lanes);
  EXPECT_THROW(read_route_network(write_route_network(wild), lanes), std::invalid_argument);
  wild = network;
  wild.lanes.front().left = static_cast<std::uint32_t>(lanes);
  EXPECT_THROW(read_route_network(write_route_network(wild), lanes), std::invalid_argument);
  wild = network;
  wild.speeds.first[1] = 1000;
  EXPECT_THROW(read_route_network(write_route_network(wild), lanes), std::invalid_argument);
}

TEST(StoredNetwork, ThatIsDamagedInACompiledMapSaysWhichFile) {
  const auto made = tests::straight_two_lane_road().build();
  std::string bytes = write_route_network(make_route_network(made));
  bytes.pop_back();
  const auto compiled = map::read_compiled_map(map::write_compiled_map(made, bytes), "made.rbm");
  try {
    Router router(compiled);
    FAIL() << "a damaged network was taken";
  } catch (const map::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("made.rbm"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace roadbed::planning
