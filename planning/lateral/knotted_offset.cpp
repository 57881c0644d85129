#include "roadbed/planning/lateral/knotted_offset.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace roadbed::planning::inline lateral {
namespace {

geometry::BoundaryState end_of(const LateralState& knot) {
  return {knot.d_m, knot.d_slope, knot.d_curvature_per_m};
}

}  // namespace

KnottedOffset::KnottedOffset(std::vector<LateralState> knots) : knots_(std::move(knots)) {
  if (knots_.size() < 2) {
    throw std::invalid_argument(
        fmt::format("KnottedOffset: needs at least 2 knots, got {}", knots_.size()));
  }
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const double length_m = knots_[i].s_m - knots_[i - 1].s_m;
    if (!(length_m > 0.0)) {
      throw std::invalid_argument(
          fmt::format("KnottedOffset: stations must ascend, {} m follows {} m", knots_[i].s_m,
                      knots_[i - 1].s_m));
    }
    pieces_.emplace_back(end_of(knots_[i - 1]), end_of(knots_[i]), length_m);
  }
}

LateralState KnottedOffset::at(double s_m) const {
  if (s_m < knots_.front().s_m) return {.s_m = s_m, .d_m = knots_.front().d_m};
  if (s_m > knots_.back().s_m) return {.s_m = s_m, .d_m = knots_.back().d_m};
  const auto after = std::ranges::upper_bound(knots_, s_m, {}, &LateralState::s_m);
  const auto i = std::min(static_cast<std::size_t>(after - knots_.begin()), pieces_.size()) - 1;
  const auto d = pieces_[i].at(s_m - knots_[i].s_m);
  return {.s_m = s_m, .d_m = d[0], .d_slope = d[1], .d_curvature_per_m = d[2]};
}

}  // namespace roadbed::planning::lateral
