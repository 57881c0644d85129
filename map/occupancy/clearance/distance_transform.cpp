#include "roadbed/map/occupancy/clearance/distance_transform.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace roadbed::map::inline occupancy::inline clearance {
namespace {

constexpr std::size_t kLongestSide = 65536;
constexpr float kFar = std::numeric_limits<float>::infinity();

// Distance within the column, in whole cells, for the rows of the window: down, then up.
std::vector<float> distances_in_columns(const std::vector<std::uint8_t>& set, std::size_t width,
                                        std::size_t height, const CellWindow& window) {
  std::vector<float> distance(width * (window.to_y - window.from_y));
  std::vector<float> run(width, kFar);
  const auto pass = [&](std::size_t y, auto&& keep) {
    const std::uint8_t* cells = &set[y * width];
    for (std::size_t x = 0; x < width; ++x) run[x] = cells[x] != 0 ? 0.0f : run[x] + 1.0f;
    if (y < window.from_y || y >= window.to_y) return;
    float* row = &distance[(y - window.from_y) * width];
    for (std::size_t x = 0; x < width; ++x) row[x] = keep(row[x], run[x]);
  };
  for (std::size_t y = 0; y < window.to_y; ++y) {
    pass(y, [](float, float down) { return down; });
  }
  std::fill(run.begin(), run.end(), kFar);
  for (std::size_t y = height; y-- > window.from_y;) {
    pass(y, [](float down, float up) { return std::min(down, up); });
  }
  return distance;
}

// Without a branch, so that loops over it vectorise: the float below is the one before in its bits.
float rounded_down_root(double square) {
  const double root = std::sqrt(square);
  const auto near = static_cast<float>(root);
  const auto bits = std::bit_cast<std::int32_t>(near);
  return std::bit_cast<float>(bits - (static_cast<double>(near) > root ? 1 : 0));
}

// Roots of (x − vertex)² + square for whole x; squares of whole numbers below 2^26 are exact.
void write_roots(std::size_t from, std::size_t to, std::int64_t vertex, std::int64_t square,
                 float* out) {
  const auto first = static_cast<double>(static_cast<std::int64_t>(from) - vertex);
  const auto added = static_cast<double>(square);
  const auto count = static_cast<std::int32_t>(to - from);
  for (std::int32_t i = 0; i < count; ++i) {
    const double along = first + static_cast<double>(i);
    out[i] = rounded_down_root(along * along + added);
  }
}

/// The lower envelope of the parabolas (x − i)² + g(i)² over one row.
class Envelope {
 public:
  explicit Envelope(std::size_t width) : from_(width), vertex_(width), square_(width) {}

  // To `out` go the distances from place `from` on, up to `to`.
  void transform(const float* row, std::size_t width, std::size_t from, std::size_t to,
                 float* out) {
    count_ = 0;
    for (std::size_t i = 0; i < width; ++i) {
      if (row[i] != kFar) add(static_cast<std::int64_t>(i), row[i], width);
    }
    if (count_ == 0) {
      std::fill(out, out + (to - from), kFar);
      return;
    }
    for (std::size_t k = 0; k < count_; ++k) {
      const std::size_t first = std::max(from, static_cast<std::size_t>(from_[k]));
      const std::size_t last =
          k + 1 < count_ ? std::min(to, static_cast<std::size_t>(from_[k + 1])) : to;
      if (first < last) write_roots(first, last, vertex_[k], square_[k], out + (first - from));
    }
  }

 private:
  std::int64_t value(std::size_t k, std::int64_t x) const {
    return (x - vertex_[k]) * (x - vertex_[k]) + square_[k];
  }

  void add(std::int64_t i, float in_column, std::size_t width) {
    const auto g = static_cast<std::int64_t>(in_column);
    // Earlier parabolas that the new one undercuts where they begin are nowhere lowest.
    while (count_ > 0 &&
           value(count_ - 1, from_[count_ - 1]) > square(from_[count_ - 1] - i) + g * g) {
      --count_;
    }
    std::int64_t from = 0;
    if (count_ > 0) {
      const std::int64_t u = vertex_[count_ - 1];
      const std::int64_t apart = i * i - u * u + g * g - square_[count_ - 1];
      const std::int64_t twice = 2 * (i - u);
      // First whole place where the new one is lower; the division rounds down.
      from = (apart >= 0 ? apart / twice : -((-apart + twice - 1) / twice)) + 1;
      if (from >= static_cast<std::int64_t>(width)) return;
    }
    from_[count_] = from;
    vertex_[count_] = i;
    square_[count_] = g * g;
    ++count_;
  }

  static std::int64_t square(std::int64_t x) { return x * x; }

  std::vector<std::int64_t> from_, vertex_, square_;
  std::size_t count_ = 0;
};

}  // namespace

std::vector<float> distances_to_set(const std::vector<std::uint8_t>& set, std::size_t width,
                                    std::size_t height) {
  return distances_to_set(set, width, height, {0, 0, width, height});
}

std::vector<float> distances_to_set(const std::vector<std::uint8_t>& set, std::size_t width,
                                    std::size_t height, const CellWindow& window) {
  if (width > kLongestSide || height > kLongestSide || set.size() != width * height) {
    throw std::invalid_argument("distances_to_set: grid of another size, or too large");
  }
  if (window.from_x > window.to_x || window.to_x > width || window.from_y > window.to_y ||
      window.to_y > height) {
    throw std::invalid_argument("distances_to_set: window beyond the grid");
  }
  const std::size_t columns = window.to_x - window.from_x, rows = window.to_y - window.from_y;
  std::vector<float> distance(columns * rows);
  if (distance.empty()) return distance;
  const std::vector<float> in_columns = distances_in_columns(set, width, height, window);
  Envelope envelope(width);
  for (std::size_t y = 0; y < rows; ++y) {
    envelope.transform(&in_columns[y * width], width, window.from_x, window.to_x,
                       &distance[y * columns]);
  }
  return distance;
}

}  // namespace roadbed::map::occupancy::clearance
