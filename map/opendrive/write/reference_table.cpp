#include "roadbed/map/opendrive/write/reference_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <variant>

#include "roadbed/map/opendrive/write/clothoid.h"

namespace roadbed::map::opendrive {
namespace {

// Of half a cell, at most: how far it turns, and how much of that by its curvature's rate.
constexpr double kHalfTurn_rad = 0.2, kByRate_rad = 0.02;
constexpr double kLongestCell_m = 2.0;
constexpr double kBucketsPerMetre = 2.0;

Eigen::Vector2d turned_left(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

}  // namespace

std::pair<double, double> curvatures_per_m(const geometry::PlanCurve& curve) {
  if (std::holds_alternative<geometry::LineCurve>(curve)) return {0.0, 0.0};
  if (const auto* arc = std::get_if<geometry::ArcCurve>(&curve)) {
    return {arc->curvature_per_m, arc->curvature_per_m};
  }
  if (const auto* spiral = std::get_if<geometry::SpiralCurve>(&curve)) {
    return {spiral->start_curvature_per_m, spiral->end_curvature_per_m};
  }
  throw std::invalid_argument("reference line: pieces must be lines, arcs or clothoids");
}

ReferenceTable::ReferenceTable(std::span<const geometry::PlanPiece> pieces)
    : end_s_m_(pieces.back().s_m + pieces.back().length_m) {
  for (const geometry::PlanPiece& piece : pieces) {
    if (!cells_.empty()) joints_m_.push_back(piece.s_m);
    add_piece(piece);
  }
  const auto buckets = static_cast<std::size_t>(end_s_m_ * kBucketsPerMetre) + 1;
  std::size_t cell = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    const double s_m = static_cast<double>(bucket) / kBucketsPerMetre;
    while (cell + 1 < cells_.size() && cells_[cell + 1].from_m <= s_m) ++cell;
    cell_of_bucket_.push_back(cell);
  }
}

void ReferenceTable::add_piece(const geometry::PlanPiece& piece) {
  const auto [start_per_m, end_per_m] = curvatures_per_m(piece.curve);
  const double rate_per_m2 = (end_per_m - start_per_m) / piece.length_m;
  const double turn_per_m = std::max(std::abs(start_per_m), std::abs(end_per_m));
  const double half_m =
      std::min({0.5 * kLongestCell_m, kHalfTurn_rad / std::max(turn_per_m, 1e-9),
                std::sqrt(2.0 * kByRate_rad / std::max(std::abs(rate_per_m2), 1e-9))});
  const double count = std::ceil(0.5 * piece.length_m / half_m), step_m = piece.length_m / count;
  for (double i = 0.0; i < count; i += 1.0) {
    Cell cell{piece.s_m + i * step_m, piece.s_m + (i + 0.5) * step_m, 0.0, rate_per_m2, {}, {}};
    const geometry::PlanPoint middle = geometry::plan_point(piece, cell.middle_m);
    cell.curvature_per_m = middle.curvature_per_m;
    cell.in_map = middle.pose.position();
    cell.along[0] = unit(middle.pose.heading_rad);
    for (std::size_t n = 0; n + 1 < kTerms; ++n) {
      Eigen::Vector2d sum = cell.curvature_per_m * cell.along[n];
      if (n > 0) sum += rate_per_m2 * cell.along[n - 1];
      cell.along[n + 1] = turned_left(sum) / static_cast<double>(n + 1);
    }
    cells_.push_back(cell);
  }
}

std::optional<double> ReferenceTable::joint_between(double from_m, double to_m) const {
  const double middle_m = 0.5 * (from_m + to_m);
  const auto behind = std::ranges::lower_bound(joints_m_, middle_m);
  std::optional<double> nearest_m;
  for (const auto joint : {behind, behind == joints_m_.begin() ? behind : behind - 1}) {
    if (joint == joints_m_.end() || *joint <= from_m || *joint >= to_m) continue;
    const double off_m = std::abs(*joint - middle_m);
    if (!nearest_m || off_m < std::abs(*nearest_m - middle_m)) nearest_m = *joint;
  }
  return nearest_m;
}

ReferenceTable::Point ReferenceTable::at(double s_m) const {
  const auto bucket = static_cast<std::size_t>(std::max(0.0, s_m) * kBucketsPerMetre);
  std::size_t index = cell_of_bucket_[std::min(bucket, cell_of_bucket_.size() - 1)];
  while (index + 1 < cells_.size() && cells_[index + 1].from_m <= s_m) ++index;
  const Cell& cell = cells_[index];
  const double ds_m = s_m - cell.middle_m;
  Eigen::Vector2d along = cell.along[kTerms - 1], moved = along / static_cast<double>(kTerms);
  for (std::size_t n = kTerms - 1; n-- > 0;) {
    along = cell.along[n] + ds_m * along;
    moved = cell.along[n] * (1.0 / static_cast<double>(n + 1)) + ds_m * moved;
  }
  return {cell.in_map + ds_m * moved, along, cell.curvature_per_m + cell.rate_per_m2 * ds_m};
}

}  // namespace roadbed::map::opendrive
