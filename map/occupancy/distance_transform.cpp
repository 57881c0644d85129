#include "roadbed/map/occupancy/distance_transform.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace roadbed::map {
namespace {

constexpr std::size_t kLongestSide = 65536;
constexpr float kFar = std::numeric_limits<float>::infinity();

// Distance within the column, in whole cells: down, then up. Rows are kept together in memory.
std::vector<float> distances_in_columns(const std::vector<std::uint8_t>& set, std::size_t width,
                                        std::size_t height) {
  std::vector<float> distance(set.size());
  for (std::size_t i = 0; i < set.size(); ++i) {
    const float above = i < width ? kFar : distance[i - width];
    distance[i] = set[i] != 0 ? 0.0f : above + 1.0f;
  }
  for (std::size_t i = width * (height - 1); i-- > 0;) {
    distance[i] = std::min(distance[i], distance[i + width] + 1.0f);
  }
  return distance;
}

float rounded_down_root(std::int64_t square) {
  const double root = std::sqrt(static_cast<double>(square));
  const float near = static_cast<float>(root);
  return static_cast<double>(near) > root ? std::nextafter(near, 0.0f) : near;
}

/// The lower envelope of the parabolas (x − i)² + g(i)² over one row.
class Envelope {
 public:
  explicit Envelope(std::size_t width) : from_(width), vertex_(width), square_(width) {}

  void transform(float* row, std::size_t width) {
    count_ = 0;
    for (std::size_t i = 0; i < width; ++i) {
      if (row[i] != kFar) add(static_cast<std::int64_t>(i), row[i], width);
    }
    if (count_ == 0) return;  // the row is all infinite already
    std::size_t k = 0;
    for (std::size_t x = 0; x < width; ++x) {
      const auto place = static_cast<std::int64_t>(x);
      while (k + 1 < count_ && from_[k + 1] <= place) ++k;
      row[x] = rounded_down_root(value(k, place));
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
  if (width > kLongestSide || height > kLongestSide || set.size() != width * height) {
    throw std::invalid_argument("distances_to_set: grid of another size, or too large");
  }
  if (set.empty()) return {};
  std::vector<float> distance = distances_in_columns(set, width, height);
  Envelope envelope(width);
  for (std::size_t y = 0; y < height; ++y) envelope.transform(&distance[y * width], width);
  return distance;
}

}  // namespace roadbed::map
