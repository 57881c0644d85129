#include "roadbed/map/edit/elevation/height_network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map {
namespace {

TEST(HeightNetwork, IsLinearBetweenAndConstantBeyond) {
  HeightNetwork line(5);
  const double lengths_m[] = {1.0, 3.0, 4.0, 2.0};
  for (std::size_t i = 0; i < 4; ++i) line.connect(i, i + 1, lengths_m[i]);
  const auto filled = line.filled({std::nullopt, 10.0, std::nullopt, 24.0, std::nullopt});
  EXPECT_NEAR(*filled[0], 10.0, 1e-12);
  EXPECT_NEAR(*filled[2], 16.0, 1e-12);
  EXPECT_NEAR(*filled[4], 24.0, 1e-12);
  EXPECT_EQ(*filled[3], 24.0);
}

TEST(HeightNetwork, KnowsNothingOfWhatNoLineReaches) {
  HeightNetwork lines(4);
  lines.connect(0, 1, 1.0);
  lines.connect(2, 3, 1.0);
  const auto filled = lines.filled({1.0, std::nullopt, std::nullopt, std::nullopt});
  EXPECT_NEAR(*filled[1], 1.0, 1e-12);
  EXPECT_FALSE(filled[2]);
  EXPECT_FALSE(filled[3]);
}

TEST(HeightNetwork, RefusesPlacesThatAreAllConnectedWithEachOther) {
  const auto connected = [](std::size_t places, std::size_t reach) {
    HeightNetwork network(places);
    for (std::size_t a = 0; a < places; ++a) {
      for (std::size_t b = a + 1; b < std::min(places, a + reach); ++b) network.connect(a, b, 1.0);
    }
    std::vector<std::optional<double>> known(places);
    known[0] = 7.0;
    return network.filled(known).back().value();
  };
  EXPECT_NEAR(connected(50'000, 3), 7.0, 1e-6);
  EXPECT_NEAR(connected(300, 300), 7.0, 1e-9);
  EXPECT_THROW(connected(1'200, 1'200), InputError);
}

// No other value anywhere leaves less of Σ (zᵢ − zⱼ)² / length.
TEST(HeightNetwork, LeavesTheLeast) {
  std::mt19937 random(8);
  std::uniform_int_distribution<std::size_t> place(0, 29);
  std::uniform_real_distribution<double> length(0.5, 5.0), height(-3.0, 3.0);
  HeightNetwork network(30);
  std::vector<std::tuple<std::size_t, std::size_t, double>> lines;
  const auto connect = [&](std::size_t a, std::size_t b) {
    if (a == b) return;
    lines.emplace_back(a, b, length(random));
    network.connect(a, b, std::get<2>(lines.back()));
  };
  for (std::size_t i = 1; i < 30; ++i) connect(i - 1, i);
  for (int i = 0; i < 30; ++i) connect(place(random), place(random));
  std::vector<std::optional<double>> known(30);
  for (const std::size_t i : {2u, 11u, 27u}) known[i] = height(random);
  const auto filled = network.filled(known);
  const auto energy = [&](std::size_t changed, double by) {
    double sum = 0.0;
    const auto z = [&](std::size_t i) { return *filled[i] + (i == changed ? by : 0.0); };
    for (const auto& [a, b, m] : lines) sum += (z(a) - z(b)) * (z(a) - z(b)) / m;
    return sum;
  };
  for (std::size_t i = 0; i < 30; ++i) {
    if (known[i]) continue;
    EXPECT_GT(energy(i, 1e-3), energy(i, 0.0));
    EXPECT_GT(energy(i, -1e-3), energy(i, 0.0));
  }
}

}  // namespace
}  // namespace roadbed::map
