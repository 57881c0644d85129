#include "roadbed/map/gis/write.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "roadbed/map/gis/layers.h"
#include "roadbed/map/gis/packed_tree.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/number_at.h"

namespace roadbed::map {
namespace {

using tests::number_at;

/// A table of FlatBuffers, read by the format's description.
struct Table {
  const std::string& bytes;
  std::size_t place;

  std::size_t field(int n) const {
    const std::size_t fields =
        place - static_cast<std::size_t>(number_at<std::int32_t>(bytes, place));
    const std::size_t offset = 4 + 2 * static_cast<std::size_t>(n);
    if (offset >= number_at<std::uint16_t>(bytes, fields)) return 0;
    const std::uint16_t inside = number_at<std::uint16_t>(bytes, fields + offset);
    return inside == 0 ? 0 : place + inside;
  }
  std::size_t vector(int n) const {
    const std::size_t where = field(n);
    return where + number_at<std::uint32_t>(bytes, where);
  }
  Table table(int n) const { return {bytes, vector(n)}; }
};

Table root(const std::string& bytes, std::size_t size_prefix) {
  return {bytes, size_prefix + 4 + number_at<std::uint32_t>(bytes, size_prefix + 4)};
}

Layer numbered_points(const std::vector<Eigen::Vector3d>& points) {
  Layer layer{"points", "point", ShapeKind::point, true, {{"number", ColumnKind::whole}}, {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    layer.features.push_back({{{{points[i]}}}, {static_cast<std::int64_t>(i)}});
  }
  return layer;
}

TEST(WriteFlatgeobuf, HoldsEachFeatureWithItsValues) {
  const Layer layer = numbered_points({{1, 2, 3}, {400, 5, 6}, {7, 800, 9}});
  const std::string bytes = write_flatgeobuf(layer, "");
  EXPECT_EQ(bytes.substr(0, 8), std::string("fgb\x03"
                                            "fgb\x00",
                                            8));
  const Table header = root(bytes, 8);
  EXPECT_EQ(number_at<std::uint64_t>(bytes, header.field(8)), 3u);
  EXPECT_EQ(number_at<std::uint8_t>(bytes, header.field(2)), 1u);
  EXPECT_EQ(header.field(10), 0u);                                             // no system
  std::size_t place = 12 + number_at<std::uint32_t>(bytes, 8) + (3 + 1) * 40;  // after the index
  std::set<std::int64_t> numbers;
  for (int i = 0; i < 3; ++i) {
    const Table feature = root(bytes, place);
    const std::size_t values = feature.vector(1);
    EXPECT_EQ(number_at<std::uint32_t>(bytes, values), 2u + 8u);
    EXPECT_EQ(number_at<std::uint16_t>(bytes, values + 4), 0u);
    const auto number = number_at<std::int64_t>(bytes, values + 6);
    const Table geometry = feature.table(0);
    const Eigen::Vector3d expected =
        layer.features[static_cast<std::size_t>(number)].shape[0][0][0];
    EXPECT_EQ(number_at<double>(bytes, geometry.vector(1) + 4), expected.x());
    EXPECT_EQ(number_at<double>(bytes, geometry.vector(1) + 12), expected.y());
    EXPECT_EQ(number_at<double>(bytes, geometry.vector(2) + 4), expected.z());
    numbers.insert(number);
    place += 4 + number_at<std::uint32_t>(bytes, place);
  }
  EXPECT_EQ(place, bytes.size());
  EXPECT_EQ(numbers, (std::set<std::int64_t>{0, 1, 2}));
}

TEST(WriteFlatgeobuf, OfAnEmptyLayerHasNoIndex) {
  const std::string bytes = write_flatgeobuf(numbered_points({}), "");
  EXPECT_EQ(bytes.size(), 12 + number_at<std::uint32_t>(bytes, 8));
  EXPECT_EQ(number_at<std::uint16_t>(bytes, root(bytes, 8).field(9)), 0u);
}

/// Offsets of the leaves that meet a box, found as a reader of the format does.
std::set<std::uint64_t> search(const std::string& tree, std::size_t leaves,
                               const Eigen::AlignedBox2d& asked) {
  const std::size_t nodes = tree.size() / 40;
  std::set<std::uint64_t> found;
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    const std::size_t first = open.back();
    open.pop_back();
    std::size_t end = first + 1;  // the level of `first` ends where its first child's begins
    if (first > 0) {
      std::size_t level_end = nodes, count = leaves;
      while (level_end - count > first) {
        level_end -= count;
        count = (count + 15) / 16;
      }
      end = std::min(first + 16, level_end);
    }
    for (std::size_t node = first; node < end; ++node) {
      const Eigen::AlignedBox2d box(Eigen::Vector2d(number_at<double>(tree, node * 40),
                                                    number_at<double>(tree, node * 40 + 8)),
                                    Eigen::Vector2d(number_at<double>(tree, node * 40 + 16),
                                                    number_at<double>(tree, node * 40 + 24)));
      if (!box.intersects(asked)) continue;
      const auto offset = number_at<std::uint64_t>(tree, node * 40 + 32);
      if (node >= nodes - leaves) {
        found.insert(offset);
      } else {
        open.push_back(offset);
      }
    }
  }
  return found;
}

TEST(PackedTree, FindsJustTheLeavesThatMeetABox) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> place(-100.0, 100.0), size(0.0, 20.0);
  const auto random_box = [&] {
    const Eigen::Vector2d low(place(random), place(random));
    return Eigen::AlignedBox2d(low, low + Eigen::Vector2d(size(random), size(random)));
  };
  for (const std::size_t count : {1U, 16U, 17U, 256U, 257U, 1000U}) {
    std::vector<PackedTreeLeaf> leaves;
    for (std::size_t i = 0; i < count; ++i) leaves.push_back({random_box(), i});
    const std::string tree = packed_tree(leaves);
    for (int i = 0; i < 20; ++i) {
      const Eigen::AlignedBox2d asked = random_box();
      std::set<std::uint64_t> expected;
      for (const PackedTreeLeaf& leaf : leaves) {
        if (leaf.box.intersects(asked)) expected.insert(leaf.offset);
      }
      EXPECT_EQ(search(tree, count, asked), expected) << count << " leaves";
    }
  }
}

}  // namespace
}  // namespace roadbed::map
