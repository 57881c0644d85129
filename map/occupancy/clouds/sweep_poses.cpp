#include "roadbed/map/occupancy/clouds/sweep_poses.h"

#include <cmath>
#include <utility>

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

using Placing = Eigen::Matrix<double, 3, 4>;

constexpr double kKnot_ns = 1e6;
constexpr std::size_t kKnots =
    2 * static_cast<std::size_t>(SweepPoses::kFarthest_ns / kKnot_ns) + 2;

struct Span {
  std::size_t from, to;
};

// Appends points from poses on a line: `from` at fraction 0, a step farther at 1.
void append(const PointRun& points, const Span& span, const Placing& from, const Placing& step,
            const PointRun::Values& fractions, PlacedRun& placed) {
  const std::size_t count = span.to - span.from;
  const double *x = &points.at[0][span.from], *y = &points.at[1][span.from],
               *z = &points.at[2][span.from], *fraction = &fractions[span.from];
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto row = static_cast<std::size_t>(axis);
    double *at = &placed.at[row][placed.count], *sensor = &placed.sensor[row][placed.count];
    const double from_x = from(axis, 0), from_y = from(axis, 1), from_z = from(axis, 2),
                 from_at = from(axis, 3);
    const double step_x = step(axis, 0), step_y = step(axis, 1), step_z = step(axis, 2),
                 step_at = step(axis, 3);
    for (std::size_t i = 0; i < count; ++i) {
      const double f = fraction[i];
      sensor[i] = from_at + f * step_at;
      at[i] = (from_x + f * step_x) * x[i] + (from_y + f * step_y) * y[i] +
              (from_z + f * step_z) * z[i] + sensor[i];
    }
  }
  placed.count += count;
}

}  // namespace

SweepPoses::SweepPoses(PoseAt pose_at, std::int64_t stamp_ns)
    : pose_at_(std::move(pose_at)), stamp_ns_(stamp_ns) {}

std::optional<Placing> SweepPoses::known_at(double since_stamp_ns) const {
  const auto pose = pose_at_(stamp_ns_ + std::llround(since_stamp_ns));
  if (!pose) return std::nullopt;
  return Placing(pose->matrix().topRows<3>());
}

const std::optional<Placing>& SweepPoses::at_knot(std::size_t i) {
  if (knots_.empty()) knots_.resize(kKnots);
  if (!knots_[i]) knots_[i] = known_at(kKnot_ns * static_cast<double>(i) - kFarthest_ns);
  return *knots_[i];
}

void SweepPoses::place(const PointRun& points, PlacedRun& placed) {
  placed.count = 0;
  std::array<std::uint32_t, PointRun::kMost> knots;
  PointRun::Values fractions;
  for (std::size_t i = 0; i < points.count; ++i) {
    const double knot = (points.since_stamp_ns[i] + kFarthest_ns) / kKnot_ns;
    knots[i] = static_cast<std::uint32_t>(knot);
    fractions[i] = knot - static_cast<double>(knots[i]);
  }
  for (Span span{0, 0}; span.from < points.count; span.from = span.to) {
    const std::size_t knot = knots[span.from];
    while (span.to < points.count && knots[span.to] == knot) ++span.to;
    const auto &from = at_knot(knot), &to = at_knot(knot + 1);
    if (from && to) {
      append(points, span, *from, *to - *from, fractions, placed);
      continue;
    }
    // At the ends of what is known no knot may be near.
    for (std::size_t i = span.from; i < span.to; ++i) {
      const std::optional<Placing> then = known_at(points.since_stamp_ns[i]);
      if (then) append(points, {i, i + 1}, *then, Placing::Zero(), fractions, placed);
    }
  }
}

}  // namespace roadbed::map::occupancy::clouds
