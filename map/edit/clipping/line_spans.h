#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "roadbed/map/edit/clipping/region.h"

namespace roadbed::map::inline edit::inline clipping {

/// A part of a line of N points: from one place to another, each the index of a point and the
/// fraction of the way to the next: 0 ≤ from < to ≤ N − 1.
struct LineSpan {
  double from = 0.0, to = 0.0;
  bool operator==(const LineSpan&) const = default;
};

/// The parts of a line that are inside a region, in order. A part that ends within 1 µm of a point
/// of the line ends there; parts of no length are none.
std::vector<LineSpan> spans_inside(std::span<const Eigen::Vector2d> line, const Region& region);

/// The same of a line that runs the other way.
std::vector<LineSpan> reversed(const std::vector<LineSpan>& spans, std::size_t points);

/// Whether parts of two lines correspond: there are as many, and they begin and end at the lines'
/// own ends together.
bool correspond(const std::vector<LineSpan>& a, std::size_t points_a,
                const std::vector<LineSpan>& b, std::size_t points_b);

/// Whether it is the whole line.
inline bool is_whole(const std::vector<LineSpan>& spans, std::size_t points) {
  return spans.size() == 1 && spans[0].from <= 0.0 &&
         spans[0].to >= static_cast<double>(points - 1);
}

}  // namespace roadbed::map::edit::clipping
