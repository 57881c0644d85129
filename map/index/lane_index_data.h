#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "roadbed/map/elements/lane.h"
#include "roadbed/map/storage/flat_array.h"
#include "roadbed/map/storage/lazy_list.h"

/// The records of LaneIndex, as they stand in memory and in a compiled map.
namespace roadbed::map::inline index::lane_index {

/// low x, low y, high x, high y [m]; rounded outwards. Of nothing: low is +∞, high is −∞.
struct Box {
  float low_x, low_y, high_x, high_y;
};

/// A lane's ring, which begins at the lane's start on its right border, and its centreline.
struct LaneRecord {
  std::uint64_t first_ring_point, first_centre_point;
  std::uint32_t ring_points, centre_points;
  std::uint32_t first_cell, cells;
};

/// A piece across a lane: ring points right_from … right_to and left_to … left_from, closed by two
/// chords that the neighbouring cells share, and a stretch of the centreline about as far along.
///
///     left_from ●────●────●  left_to
///               ┊         ┊
///              right_from ●──●  right_to
///
/// Since chords are shared, a point is inside the lane's ring if it is inside an odd number of its
/// cells, whatever the ring's shape.
struct Cell {
  Box ring, centre;
  std::uint32_t lane;
  std::uint32_t right_from, right_to, left_to, left_from;  ///< from the lane's first ring point
  std::uint32_t centre_from, centre_to;                    ///< from its first centreline point
  std::uint16_t lane_type;
  std::uint16_t
      ends;  ///< 1: its chord at the start is the ring's edge, 2: that at the end, 3: both
};

struct Point {
  double x, y;
};

/// Boxes of eight cells or nodes; places without one hold a box of nothing.
struct Node {
  static constexpr std::size_t kWidth = 8;
  std::array<float, kWidth> low_x, low_y, high_x, high_y;
};

/// Nodes stand level by level, the leaves first: box i of a leaf is that of cell `order[i]`.
struct Data {
  FlatArray<LaneRecord> lanes;
  FlatArray<Cell> cells;  ///< by lane and along it
  FlatArray<Point> ring_points, centre_points;
  FlatArray<double> centre_stations_m;
  FlatArray<Node> nodes;
  FlatArray<std::uint32_t> order;  ///< cells along a Hilbert curve through their boxes' middles
};

/// Every array with its name: `io(name, array...)`, for one or more indices side by side.
inline constexpr auto visit = [](auto& io, auto&... data) {
  io("index.lanes", data.lanes...);
  io("index.cells", data.cells...);
  io("index.ring", data.ring_points...);
  io("index.centre", data.centre_points...);
  io("index.stations", data.centre_stations_m...);
  io("index.nodes", data.nodes...);
  io("index.order", data.order...);
};

/// First node of each level, leaves first, and the count of all nodes at the end.
std::vector<std::uint64_t> level_starts(std::uint64_t cells);

/// Lanes without a polygon get no cells.
Data build(const LazyList<Lane>& lanes);

/// Compares arrays with those that build() makes of lanes, which come one by one, in order of id:
/// neither the lanes nor the arrays have to be in memory. Keeps a box per cell.
class Check {
 public:
  Check() = default;
  virtual ~Check() = default;
  Check(const Check&) = delete;
  Check& operator=(const Check&) = delete;

  virtual void add(const Lane& lane) = 0;

  /// Whether the arrays are those of the lanes added, which were all.
  virtual bool holds() = 0;
};

/// @param data  outlives the check.
std::unique_ptr<Check> make_check(const Data& data);

}  // namespace roadbed::map::index::lane_index
