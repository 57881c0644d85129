#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "roadbed/geometry/index/hilbert.h"
#include "roadbed/map/index/lane_index_data.h"

namespace roadbed::map::inline index::lane_index {
namespace {

constexpr std::size_t kPointsPerCell = 16;  // of ring and centreline together: 8, 8, 8

constexpr float kNowhere = std::numeric_limits<float>::infinity();
constexpr Box kNothing{kNowhere, kNowhere, -kNowhere, -kNowhere};

float below(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded > value ? std::nextafter(rounded, -kNowhere) : rounded;
}

float above(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded < value ? std::nextafter(rounded, kNowhere) : rounded;
}

// Box around points [first, last].
template <typename Points>
void extend(Box& box, const Points& points, std::uint32_t first, std::uint32_t last) {
  Eigen::Vector2d low = points[first], high = low;
  for (std::uint32_t i = first + 1; i <= last; ++i) {
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  }
  box.low_x = std::min(box.low_x, below(low.x()));
  box.low_y = std::min(box.low_y, below(low.y()));
  box.high_x = std::max(box.high_x, above(high.x()));
  box.high_y = std::max(box.high_y, above(high.y()));
}

void extend(Box& box, const Box& other) {
  box.low_x = std::min(box.low_x, other.low_x);
  box.low_y = std::min(box.low_y, other.low_y);
  box.high_x = std::max(box.high_x, other.high_x);
  box.high_y = std::max(box.high_y, other.high_y);
}

// @param likely  looked at first: most rings are the two borders, one after the other.
std::size_t nearest_vertex(const geometry::Ring& ring, const Eigen::Vector2d& point,
                           std::size_t likely) {
  if (likely < ring.size() && ring[likely] == point) return likely;
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double squared = (ring[i] - point).squaredNorm();
    if (squared < least) {
      least = squared;
      nearest = i;
    }
  }
  return nearest;
}

// Indices that cut points [first, last] (or backwards) into `pieces` runs of equal length.
template <typename PointAt>
std::vector<std::uint32_t> cuts(std::size_t count, std::size_t pieces, const PointAt& at) {
  if (pieces == 1) return {0, static_cast<std::uint32_t>(count - 1)};
  std::vector<double> along_m(count, 0.0);
  for (std::size_t i = 1; i < count; ++i) along_m[i] = along_m[i - 1] + (at(i) - at(i - 1)).norm();
  std::vector<std::uint32_t> made;
  for (std::size_t piece = 0; piece <= pieces; ++piece) {
    const double fraction = static_cast<double>(piece) / static_cast<double>(pieces);
    const auto cut = std::lower_bound(along_m.begin(), along_m.end(), fraction * along_m.back());
    const auto at_cut = static_cast<std::size_t>(cut - along_m.begin());
    made.push_back(
        static_cast<std::uint32_t>(piece == pieces ? count - 1 : std::min(at_cut, count - 1)));
  }
  return made;
}

// Cells along a Hilbert curve through their boxes' middles.
std::vector<std::uint32_t> hilbert_order(const std::vector<Box>& boxes) {
  Box whole = kNothing;
  for (const Box& box : boxes) extend(whole, box);
  const auto scaled = [](float low, float high, float from, float to) {
    const float fraction = to > from ? (0.5F * (low + high) - from) / (to - from) : 0.0F;
    return static_cast<std::uint32_t>(std::min(std::max(0.0F, fraction), 1.0F) * 65535.0F);
  };
  std::vector<std::uint32_t> keys;
  keys.reserve(boxes.size());
  for (const Box& box : boxes) {
    keys.push_back(
        geometry::hilbert_index(scaled(box.low_x, box.high_x, whole.low_x, whole.high_x),
                                scaled(box.low_y, box.high_y, whole.low_y, whole.high_y)));
  }
  return geometry::order_of_keys(keys);
}

std::vector<Node> build_nodes(const std::vector<Box>& of_cells,
                              const std::vector<std::uint32_t>& order) {
  std::vector<Box> boxes;
  for (const std::uint32_t cell : order) boxes.push_back(of_cells[cell]);
  std::vector<Node> nodes;
  while (!boxes.empty()) {
    std::vector<Box> upper;
    for (std::size_t first = 0; first < boxes.size(); first += Node::kWidth) {
      Node& node = nodes.emplace_back();
      Box& around = upper.emplace_back(kNothing);
      for (std::size_t i = 0; i < Node::kWidth; ++i) {
        const Box box = first + i < boxes.size() ? boxes[first + i] : kNothing;
        node.low_x[i] = box.low_x;
        node.low_y[i] = box.low_y;
        node.high_x[i] = box.high_x;
        node.high_y[i] = box.high_y;
        extend(around, box);
      }
    }
    if (upper.size() == 1) break;
    boxes = std::move(upper);
  }
  return nodes;
}

void add_boxes(const std::vector<Cell>& cells, std::vector<Box>& boxes) {
  for (const Cell& cell : cells) boxes.push_back(cell.ring);
}

// What stands lane by lane in the index.
struct Arrays {
  std::vector<LaneRecord> lanes;
  std::vector<Cell> cells;
  std::vector<Point> ring_points, centre_points;
  std::vector<double> centre_stations_m;
};

class Builder {
 public:
  void add(const Lane& lane) {
    LaneRecord record{};
    record.first_ring_point = ring_points_before_ + arrays_.ring_points.size();
    record.first_centre_point = centre_points_before_ + arrays_.centre_points.size();
    record.first_cell = static_cast<std::uint32_t>(cells_before_ + arrays_.cells.size());
    if (lane.polygon.size() >= 3) {
      add_points(lane);
      add_cells(lane);
    }
    record.ring_points = static_cast<std::uint32_t>(
        ring_points_before_ + arrays_.ring_points.size() - record.first_ring_point);
    record.centre_points = static_cast<std::uint32_t>(
        centre_points_before_ + arrays_.centre_points.size() - record.first_centre_point);
    record.cells =
        static_cast<std::uint32_t>(cells_before_ + arrays_.cells.size() - record.first_cell);
    arrays_.lanes.push_back(record);
  }

  const Arrays& arrays() const { return arrays_; }

  // Of the lanes added since the last time; the next ones go on behind them.
  Arrays take() {
    cells_before_ += arrays_.cells.size();
    ring_points_before_ += arrays_.ring_points.size();
    centre_points_before_ += arrays_.centre_points.size();
    return std::exchange(arrays_, {});
  }

 private:
  void add_points(const Lane& lane) {
    ring_ = lane.polygon;
    const std::size_t start = nearest_vertex(ring_, lane.right.in_map.points().front(), 0);
    std::rotate(ring_.begin(), ring_.begin() + static_cast<std::ptrdiff_t>(start), ring_.end());
    for (const Eigen::Vector2d& p : ring_) arrays_.ring_points.push_back({p.x(), p.y()});
    for (const Eigen::Vector2d& p : lane.centre.in_map.points()) {
      arrays_.centre_points.push_back({p.x(), p.y()});
    }
    const auto& stations = lane.centre.in_map.stations_m();
    arrays_.centre_stations_m.insert(arrays_.centre_stations_m.end(), stations.begin(),
                                     stations.end());
  }

  void add_cells(const Lane& lane) {
    const auto& centre = lane.centre.in_map.points();
    const auto& right_border = lane.right.in_map.points();
    const std::size_t n = ring_.size();
    // The last vertex of the right border; at least one vertex stays for the left one.
    const std::size_t turn =
        std::min(nearest_vertex(ring_, right_border.back(), right_border.size() - 1), n - 2);
    const std::size_t pieces = 1 + std::max(n, 2 * centre.size()) / kPointsPerCell;
    const auto right = cuts(turn + 1, pieces, [&](std::size_t i) { return ring_[i]; });
    const auto left = cuts(n - 1 - turn, pieces, [&](std::size_t i) { return ring_[n - 1 - i]; });
    const auto along = cuts(centre.size(), pieces, [&](std::size_t i) { return centre[i]; });
    const auto last = static_cast<std::uint32_t>(n - 1);
    for (std::size_t i = 0; i < pieces; ++i) {
      const auto ends = static_cast<std::uint16_t>((i == 0 ? 1 : 0) + (i + 1 == pieces ? 2 : 0));
      Cell cell{.ring = kNothing,
                .centre = kNothing,
                .lane = lane.id.index,
                .right_from = right[i],
                .right_to = right[i + 1],
                .left_to = last - left[i + 1],
                .left_from = last - left[i],
                .centre_from = along[i],
                .centre_to = along[i + 1],
                .lane_type = static_cast<std::uint16_t>(lane.type),
                .ends = ends};
      extend(cell.ring, ring_, cell.right_from, cell.right_to);
      extend(cell.ring, ring_, cell.left_to, cell.left_from);
      extend(cell.centre, centre, cell.centre_from, cell.centre_to);
      arrays_.cells.push_back(cell);
    }
  }

  geometry::Ring ring_;  // of the lane that is being added
  Arrays arrays_;
  std::uint64_t cells_before_ = 0, ring_points_before_ = 0, centre_points_before_ = 0;
};

class Comparison : public Check {
 public:
  explicit Comparison(const Data& data) : data_(data) {}

  void add(const Lane& lane) override {
    constexpr std::size_t kPoints = 16 * 1024;
    builder_.add(lane);
    if (builder_.arrays().ring_points.size() > kPoints) compare();
  }

  bool holds() override {
    compare();
    const std::vector<std::uint32_t> order = hilbert_order(boxes_);
    go_on(data_.nodes, build_nodes(boxes_, order), nodes_);
    go_on(data_.order, order, order_);
    return same_ && lanes_ == data_.lanes.size() && cells_ == data_.cells.size() &&
           ring_points_ == data_.ring_points.size() &&
           centre_points_ == data_.centre_points.size() &&
           stations_ == data_.centre_stations_m.size() && nodes_ == data_.nodes.size() &&
           order_ == data_.order.size();
  }

 private:
  void compare() {
    const Arrays arrays = builder_.take();
    go_on(data_.lanes, arrays.lanes, lanes_);
    go_on(data_.cells, arrays.cells, cells_);
    go_on(data_.ring_points, arrays.ring_points, ring_points_);
    go_on(data_.centre_points, arrays.centre_points, centre_points_);
    go_on(data_.centre_stations_m, arrays.centre_stations_m, stations_);
    add_boxes(arrays.cells, boxes_);
  }

  // Compares the next items of an array.
  template <typename T>
  void go_on(const FlatArray<T>& array, const std::vector<T>& items, std::uint64_t& at) {
    same_ = same_ && items.size() <= array.size() - at &&
            (items.empty() || std::memcmp(array.span(at, items.size()), items.data(),
                                          items.size() * sizeof(T)) == 0);
    if (same_) at += items.size();
  }

  const Data& data_;
  Builder builder_;
  std::vector<Box> boxes_;  // of cells
  bool same_ = true;
  std::uint64_t lanes_ = 0, cells_ = 0, ring_points_ = 0, centre_points_ = 0, stations_ = 0,
                nodes_ = 0, order_ = 0;  // how far each has been compared
};

}  // namespace

std::vector<std::uint64_t> level_starts(std::uint64_t cells) {
  std::vector<std::uint64_t> starts{0};
  for (std::uint64_t width = cells; width > 0;) {
    width = (width + Node::kWidth - 1) / Node::kWidth;
    starts.push_back(starts.back() + width);
    if (width == 1) break;
  }
  return starts;
}

Data build(const LazyList<Lane>& lanes) {
  Builder builder;
  for (const Lane& lane : lanes) builder.add(lane);
  Arrays arrays = builder.take();
  std::vector<Box> boxes;
  add_boxes(arrays.cells, boxes);
  std::vector<std::uint32_t> order = hilbert_order(boxes);
  Data data;
  data.nodes = FlatArray<Node>(build_nodes(boxes, order));
  data.order = FlatArray<std::uint32_t>(std::move(order));
  data.lanes = FlatArray<LaneRecord>(std::move(arrays.lanes));
  data.cells = FlatArray<Cell>(std::move(arrays.cells));
  data.ring_points = FlatArray<Point>(std::move(arrays.ring_points));
  data.centre_points = FlatArray<Point>(std::move(arrays.centre_points));
  data.centre_stations_m = FlatArray<double>(std::move(arrays.centre_stations_m));
  return data;
}

std::unique_ptr<Check> make_check(const Data& data) { return std::make_unique<Comparison>(data); }

}  // namespace roadbed::map::index::lane_index
