#include "roadbed/map/occupancy/octree/occupancy_merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/occupancy/octree/tiled_occupancy.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;
using Place = std::array<long, 3>;      // of a cell of the finest size, from the source's 0
using Cells = std::map<Place, double>;  // its log-odds
using Combine = double (*)(double, double);

constexpr double kCell_m = 0.25;

/// Leaves of several sizes around the middle of OctoMap's range, with all kinds of log-odds.
octomap::OcTree random_tree(std::mt19937& random, int cells, int least = 32740,
                            int greatest = 32795) {
  octomap::OcTree tree(kCell_m);
  std::uniform_int_distribution<int> place(least, greatest), block(0, 3);
  std::uniform_real_distribution<float> value(-1.9f, 3.4f);
  const auto key = [](int x, int y, int z) {
    return octomap::OcTreeKey(static_cast<octomap::key_type>(x), static_cast<octomap::key_type>(y),
                              static_cast<octomap::key_type>(z));
  };
  for (int i = 0; i < cells; ++i) {
    tree.setNodeValue(key(place(random), place(random), place(random)), value(random), true);
  }
  const int from = 32768 - 16 * block(random);
  const float most = tree.getClampingThresMaxLog();
  for (int i = 0; i < 16 * 16 * 16; ++i) {
    tree.setNodeValue(key(from + i % 16, 32768 + i / 16 % 16, 32752 + i / 256), most, true);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  return tree;
}

/// As a file whose origin is that many cells from the source's.
OccupancyMap moved(const octomap::OcTree& tree, const Place& origin, bool as_log_odds) {
  std::ostringstream out;
  as_log_odds ? tree.write(out) : tree.writeBinaryConst(out);
  std::string bytes = out.str();
  std::ostringstream line;
  line << "\n# roadbed origin";
  for (const long cells : origin) line << ' ' << kCell_m * static_cast<double>(cells);
  bytes.insert(bytes.find('\n'), line.str());
  return OccupancyMap::parse(bytes, "a.ot");
}

void add(Cells& cells, const Place& place, double value, Combine combine) {
  const auto [found, is_new] = cells.try_emplace(place, value);
  if (!is_new) found->second = combine(found->second, value);
}

void add(Cells& cells, const octomap::OcTree& tree, const Place& origin, bool as_log_odds,
         Combine combine) {
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    const long side = std::lround(leaf.getSize() / kCell_m);
    const auto first = [&](double middle_m) {
      return std::lround((middle_m - 0.5 * leaf.getSize()) / kCell_m);
    };
    double value = static_cast<double>(leaf->getLogOdds());
    if (!as_log_odds) {
      value = static_cast<double>(tree.isNodeOccupied(*leaf) ? tree.getClampingThresMaxLog()
                                                             : tree.getClampingThresMinLog());
    }
    for (long i = 0; i < side * side * side; ++i) {
      add(cells,
          {origin[0] + first(leaf.getX()) + i % side,
           origin[1] + first(leaf.getY()) + i / side % side,
           origin[2] + first(leaf.getZ()) + i / side / side},
          value, combine);
    }
  }
}

/// What an octree's leaves say of the cells of the finest size.
Cells cells_of(const OccupancySource& occupancy) {
  Cells cells;
  for (const OccupancyCell& leaf : occupancy.cells()) {
    const long side = std::lround(leaf.size_m / kCell_m);
    Place first{};
    for (int axis = 0; axis < 3; ++axis) {
      first[static_cast<std::size_t>(axis)] =
          std::lround((leaf.centre_in_source[axis] - 0.5 * leaf.size_m) / kCell_m);
    }
    for (long i = 0; i < side * side * side; ++i) {
      const Place place{first[0] + i % side, first[1] + i / side % side,
                        first[2] + i / side / side};
      EXPECT_TRUE(cells.emplace(place, static_cast<double>(leaf.log_odds)).second);
    }
  }
  return cells;
}

void expect_equal(const Cells& found, const Cells& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (auto a = found.begin(), b = expected.begin(); a != found.end(); ++a, ++b) {
    ASSERT_EQ(a->first, b->first);
    ASSERT_NEAR(a->second, b->second, 1e-6);
  }
}

double sum(double a, double b) { return a + b; }
double larger(double a, double b) { return std::max(a, b); }

OccupancyMap read(const OccupancyMap::File& file) { return OccupancyMap::parse(file.bytes, "a"); }

class OccupancyMergeTest : public testing::Test {
 protected:
  OccupancyMergeTest()
      : folder_(std::filesystem::path(testing::TempDir()) /
                (std::string("merge_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~OccupancyMergeTest() override { std::filesystem::remove_all(folder_); }

  /// Written as tiles, and opened.
  std::unique_ptr<TiledOccupancy> tiled(const OccupancyMerge& merge, std::int64_t side_cells,
                                        const std::string& name) const {
    std::filesystem::create_directories(folder_ / name);
    const auto write = [&](const std::string& file, std::string_view bytes) {
      std::ofstream(folder_ / name / file, std::ios::binary) << bytes;
    };
    write("index.json", write_tiles_index(merge.tiles(side_cells, write)));
    return std::make_unique<TiledOccupancy>(folder_ / name);
  }

  std::filesystem::path folder_;
};

TEST_F(OccupancyMergeTest, SaysOfEveryCellWhatItsSourcesSayTogether) {
  std::mt19937 random(20261126);
  for (const Place& shift : {Place{0, 0, 0}, Place{64, -128, 0}, Place{5, -3, 1}}) {
    for (const bool as_log_odds : {true, false}) {
      const octomap::OcTree a = random_tree(random, 4000), b = random_tree(random, 4000);
      const OccupancyMap first = moved(a, {7, 0, -2}, as_log_odds),
                         second = moved(b, shift, as_log_odds);
      for (const bool sticky : {true, false}) {
        Cells expected;
        add(expected, a, {7, 0, -2}, as_log_odds, sticky ? larger : sum);
        add(expected, b, shift, as_log_odds, sticky ? larger : sum);
        for (auto& [place, value] : expected) {
          value = std::clamp(value, static_cast<double>(a.getClampingThresMinLog()),
                             static_cast<double>(a.getClampingThresMaxLog()));
        }
        const OccupancyMerge merge({{&first, "a"}, {&second, "b"}}, {.sticky_hits = sticky});
        expect_equal(cells_of(read(merge.ot())), expected);
        for (auto& [place, value] : expected) {
          value = static_cast<double>(value >= 0.0 ? a.getClampingThresMaxLog()
                                                   : a.getClampingThresMinLog());
        }
        expect_equal(cells_of(read(merge.bt())), expected);
        expect_equal(cells_of(*tiled(merge, 64, "t" + std::to_string(sticky))), expected);
      }
    }
  }
}

TEST_F(OccupancyMergeTest, OfOneIsItsFileAsBuildWritesIt) {
  std::mt19937 random(3);
  const OccupancyMap whole = moved(random_tree(random, 3000), {0, 0, 0}, true);
  const OccupancyMerge merge({{&whole, "a"}});
  EXPECT_EQ(merge.bt().bytes, whole.to_bt());
  EXPECT_EQ(merge.ot().bytes, whole.to_ot());
}

TEST_F(OccupancyMergeTest, OfACubeOfMoreLeavesThanAreReadAtOnceIsItsFile) {
  std::mt19937 random(5);
  const OccupancyMap whole = moved(random_tree(random, 300'000, 32768, 32847), {0, 0, 0}, true);
  ASSERT_GT(whole.node_count(), 200'000u);
  const OccupancyMerge merge({{&whole, "a"}, {&whole, "b"}});
  EXPECT_EQ(merge.bt().bytes, whole.to_bt());
  EXPECT_EQ(merge.ot().bytes, whole.to_ot());
}

TEST_F(OccupancyMergeTest, PartsThatMeetArePutTogetherToTheWhole) {
  std::mt19937 random(4);
  const OccupancyMap whole = moved(random_tree(random, 4000), {0, 0, 0}, true);
  const double far_m = 1e3;
  std::vector<OccupancyMap> parts;
  for (const auto& [from, to] : {std::pair{-far_m, 1.2}, {1.2, far_m}}) {
    parts.push_back(read(
        OccupancyMerge({{&whole, "a"}}, {.part = {{{from, -far_m, -far_m}, {to, far_m, far_m}}}})
            .ot()));
    EXPECT_LT(parts.back().node_count(), whole.node_count());
  }
  EXPECT_EQ(OccupancyMerge({{&parts[1], "a"}, {&parts[0], "b"}}).ot().bytes, whole.to_ot());
}

TEST_F(OccupancyMergeTest, APartHasTheCellsWhoseMiddleLiesInIt) {
  std::mt19937 random(5);
  constexpr Place kOrigin{1, 2, 3};
  for (int round = 0; round < 8; ++round) {
    const octomap::OcTree tree = random_tree(random, 4000);
    const OccupancyMap whole = moved(tree, kOrigin, true);
    constexpr double radius_m = 4.4;
    const Eigen::Vector2d centre(-0.3, 1.1);
    OccupancyPart part{{{-radius_m - 0.3, -9.0, -3.4}, {9.0, 9.0, 1.9}}};
    part.in_plan = [&](const Eigen::Vector2d& middle, double around_m) {
      const double from_m = (middle - centre).norm();
      if (from_m + around_m <= radius_m) return Stays::all;
      return from_m - around_m > radius_m ? Stays::nothing : Stays::part;
    };
    Cells all, expected;
    add(all, tree, kOrigin, true, larger);
    for (const auto& [place, value] : all) {
      const auto middle_m = [&](std::size_t axis) {
        return kCell_m * (static_cast<double>(place[axis]) + 0.5);
      };
      const Eigen::Vector2d middle(middle_m(0), middle_m(1));
      if ((middle - centre).norm() > radius_m || middle_m(2) < -3.4 || middle_m(2) > 1.9) continue;
      expected.emplace(place, value);
    }
    const OccupancyMerge merge({{&whole, "a"}}, {.part = part});
    expect_equal(cells_of(read(merge.ot())), expected);
    const auto tiles = tiled(merge, 64, "t" + std::to_string(round));
    EXPECT_EQ(cells_of(*tiles).size(), expected.size());
  }
}

TEST_F(OccupancyMergeTest, OfTilesReadsEachOnceAndIsTheOctreeOfThemAll) {
  std::mt19937 random(6);
  const OccupancyMap whole = moved(random_tree(random, 4000), {0, 0, 0}, false);
  const auto small = tiled(OccupancyMerge({{&whole, "a"}}), 64, "small");
  ASSERT_GE(small->index().tiles.size(), 4u);
  const OccupancyMerge merge({{small.get(), "small"}});
  EXPECT_EQ(merge.bt().bytes, whole.to_bt());
  EXPECT_EQ(small->tiles_read(), small->index().tiles.size());
  const auto again = tiled(OccupancyMerge({{small.get(), "a"}, {&whole, "b"}}), 64, "again");
  EXPECT_EQ(write_tiles_index(again->index()), write_tiles_index(small->index()));
}

TEST_F(OccupancyMergeTest, IsOneOctreeWhereverItLiesIfItsRangeAllows) {
  std::mt19937 random(7);
  const octomap::OcTree tree = random_tree(random, 50);
  const OccupancyMap near = moved(tree, {0, 0, 0}, false), far = moved(tree, {60'000, 0, 0}, false);
  const OccupancyMap both = read(OccupancyMerge({{&near, "near"}, {&far, "far"}}).bt());
  EXPECT_NE(both.origin_in_source(), near.origin_in_source());
  Cells expected;
  add(expected, tree, {0, 0, 0}, false, larger);
  add(expected, tree, {60'000, 0, 0}, false, larger);
  expect_equal(cells_of(both), expected);

  const OccupancyMap farther = moved(tree, {70'000, 0, 0}, false);
  const OccupancyMerge wide({{&near, "near.bt"}, {&farther, "far"}});
  try {
    wide.bt();
    FAIL() << "was not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("near.bt"));
    EXPECT_THAT(error.what(), HasSubstr("write tiles"));
  }
  EXPECT_EQ(cells_of(*tiled(wide, 64, "wide")).size(), expected.size());
}

TEST_F(OccupancyMergeTest, IsRefusedOfCellsThatAreNotTheSame) {
  const octomap::OcTree coarse(0.5), fine(kCell_m);
  const auto refusal = [](const OccupancyMap& a, const OccupancyMap& b) -> std::string {
    return tests::refusal_of([&] { OccupancyMerge({{&a, "a.bt"}, {&b, "b.bt"}}); });
  };
  const auto with = [](const std::string& line, double cell_m) {
    return OccupancyMap::parse("# Octomap OcTree binary file\n" + line + "id OcTree\nsize 0\nres " +
                                   std::to_string(cell_m) + "\ndata\n",
                               "x");
  };
  const OccupancyMap plain = with("", 0.25);
  EXPECT_THAT(refusal(plain, with("", 0.5)), HasSubstr("b.bt: cells of 0.5 m"));
  EXPECT_THAT(refusal(plain, with("# roadbed origin 0 0 0 EPSG:25832\n", 0.25)),
              HasSubstr("b.bt: the coordinate system \"EPSG:25832\""));
  EXPECT_THAT(refusal(plain, with("# roadbed origin 0.1 0 0\n", 0.25)),
              HasSubstr("one that is whole cells away"));
  EXPECT_EQ(refusal(plain, with("# roadbed origin 500 -0.25 0\n", 0.25)), "accepted");
  EXPECT_EQ(OccupancyMerge({{&plain, "a"}, {&plain, "b"}}).bt().nodes, 0u);
}

TEST_F(OccupancyMergeTest, SaysWhatWasTakenAwayOfAnyOfThem) {
  const auto seen = [](const std::string& line) {
    return OccupancyMap::parse(
        "# Octomap OcTree binary file\n" + line + "id OcTree\nsize 0\nres 0.25\ndata\n", "x");
  };
  const OccupancyMap none = seen(""), five = seen("# roadbed seen-through 5 removed 7\n"),
                     three = seen("# roadbed seen-through 3 removed 10\n");
  EXPECT_EQ(OccupancyMerge({{&none, "a"}}).bt().seen_through, std::nullopt);
  EXPECT_EQ(OccupancyMerge({{&none, "a"}, {&five, "b"}, {&three, "c"}}).bt().seen_through,
            (SeeThroughRemoval{3, 17}));
}

}  // namespace
}  // namespace roadbed::map
