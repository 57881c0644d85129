#include "roadbed/map/opendrive/write/reference_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/opendrive/write/clothoid.h"

namespace roadbed::map::opendrive {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr std::size_t kLeastSteps = 12;
constexpr std::size_t kMostSteps = 400'000;  // longer roads are followed less closely

// A symmetric, positive definite matrix with two bands beside its diagonal, and two right sides.
class BandedSystem {
 public:
  explicit BandedSystem(std::size_t size)
      : rows_(size, {0.0, 0.0, 0.0}), right_(size, {0.0, 0.0}) {}

  // Adds weight · (Σ cₖ p(first + k) − constant)². Places outside hold nothing.
  void add(std::ptrdiff_t first, std::array<double, 3> c, const Eigen::Vector2d& constant,
           double weight) {
    for (std::ptrdiff_t i = 0; i < 3; ++i) {
      if (!inside(first + i) || c[static_cast<std::size_t>(i)] == 0.0) continue;
      const double ci = c[static_cast<std::size_t>(i)];
      right_[static_cast<std::size_t>(first + i)] += weight * ci * constant;
      for (std::ptrdiff_t j = 0; j <= i; ++j) {
        if (!inside(first + j)) continue;
        rows_[static_cast<std::size_t>(first + i)][static_cast<std::size_t>(i - j)] +=
            weight * ci * c[static_cast<std::size_t>(j)];
      }
    }
  }

  // By Cholesky's factors L D Lᵀ, in place.
  Points solve() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (i >= 2) rows_[i][2] /= rows_[i - 2][0];
      if (i >= 1) {
        if (i >= 2) rows_[i][1] -= rows_[i][2] * rows_[i - 2][0] * rows_[i - 1][1];
        rows_[i][1] /= rows_[i - 1][0];
        rows_[i][0] -= rows_[i][1] * rows_[i][1] * rows_[i - 1][0];
        right_[i] -= rows_[i][1] * right_[i - 1];
      }
      if (i >= 2) {
        rows_[i][0] -= rows_[i][2] * rows_[i][2] * rows_[i - 2][0];
        right_[i] -= rows_[i][2] * right_[i - 2];
      }
    }
    for (std::size_t i = rows_.size(); i-- > 0;) {
      right_[i] /= rows_[i][0];
      if (i + 1 < rows_.size()) right_[i] -= rows_[i + 1][1] * right_[i + 1];
      if (i + 2 < rows_.size()) right_[i] -= rows_[i + 2][2] * right_[i + 2];
    }
    return std::move(right_);
  }

 private:
  bool inside(std::ptrdiff_t place) const {
    return place >= 0 && place < static_cast<std::ptrdiff_t>(rows_.size());
  }

  std::vector<std::array<double, 3>> rows_;  // diagonal, and the two places left of it
  Points right_;
};

// The target in equal steps, smoothed between its ends.
Points smoothed(const ReferenceTarget& target, double scale_m) {
  const geometry::Polyline line(target.in_map);
  const auto steps =
      std::clamp(static_cast<std::size_t>(std::ceil(line.length_m() / target.step_m)), kLeastSteps,
                 kMostSteps);
  const double step_m = line.length_m() / static_cast<double>(steps);
  const double stiffness = std::pow(scale_m / step_m, 4);
  Points wanted;
  for (std::size_t i = 0; i <= steps; ++i) wanted.push_back(line.at(step_m * double(i)));
  // Unknown are the points between the ends: place i is point i + 1.
  BandedSystem system(steps - 1);
  const auto last = static_cast<std::ptrdiff_t>(steps) - 2;
  for (std::ptrdiff_t i = 0; i <= last; ++i) {
    system.add(i, {1.0, 0.0, 0.0}, wanted[static_cast<std::size_t>(i) + 1], 1.0);
    Eigen::Vector2d constant(0, 0);
    if (i == 0) constant -= wanted.front();
    if (i == last) constant -= wanted.back();
    system.add(i - 1, {1.0, -2.0, 1.0}, constant, stiffness);
  }
  const Eigen::Vector2d ahead = step_m * unit(target.start_heading_rad);
  const Eigen::Vector2d back = -step_m * unit(target.end_heading_rad);
  system.add(0, {1.0, 0.0, 0.0}, wanted.front() + ahead, 2.0 * stiffness);
  system.add(last, {1.0, 0.0, 0.0}, wanted.back() + back, 2.0 * stiffness);
  Points points = system.solve();
  points.insert(points.begin(), wanted.front());
  points.push_back(wanted.back());
  return points;
}

class ClothoidCutter {
 public:
  ClothoidCutter(const ReferenceTarget& target, const Points& points, double tolerance_m)
      : tolerance_m_(tolerance_m) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d along =
          points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1];
      poses_.push_back({points[i].x(), points[i].y(), std::atan2(along.y(), along.x())});
    }
    poses_.front().heading_rad = target.start_heading_rad;
    poses_.back().heading_rad = target.end_heading_rad;
  }

  std::vector<geometry::PlanPiece> cut() {
    std::vector<geometry::PlanPiece> pieces;
    std::vector<std::size_t> starts;
    for (std::size_t from = 0; from + 1 < poses_.size();) {
      auto [piece, to] = longest(from, end_m(pieces));
      if (!piece && reach_end_from_before(pieces, starts)) break;
      if (!piece) {  // turns back altogether: straight on
        to = from + 1;
        piece = geometry::PlanPiece{end_m(pieces), step_m(from), poses_[from], {}};
      }
      pieces.push_back(*piece);
      starts.push_back(from);
      from = to;
    }
    return pieces;
  }

 private:
  static double end_m(const std::vector<geometry::PlanPiece>& pieces) {
    return pieces.empty() ? 0.0 : pieces.back().s_m + pieces.back().length_m;
  }

  // The last of the pieces that may lead to the end instead does; those behind it go.
  bool reach_end_from_before(std::vector<geometry::PlanPiece>& pieces,
                             const std::vector<std::size_t>& starts) const {
    for (std::size_t i = pieces.size(); i-- > 0;) {
      const auto piece = clothoid_between(poses_[starts[i]], poses_.back(), pieces[i].s_m);
      if (!piece) continue;
      pieces.resize(i);
      pieces.push_back(*piece);
      return true;
    }
    return false;
  }

  double step_m(std::size_t i) const {
    return std::max(1e-6, (poses_[i + 1].position() - poses_[i].position()).norm());
  }

  // The longest piece from a point on, by doubling its reach, then halving. Points to which the
  // line would have to turn too sharply are passed by.
  std::pair<std::optional<geometry::PlanPiece>, std::size_t> longest(std::size_t from,
                                                                     double s_m) const {
    std::size_t good = from + 1, bad = poses_.size();
    auto best = clothoid_between(poses_[from], poses_[good], s_m);
    while (!best && good + 1 < bad) best = clothoid_between(poses_[from], poses_[++good], s_m);
    const auto reaches = [&](std::size_t to) {
      auto piece = clothoid_between(poses_[from], poses_[to], s_m);
      if (!piece || !keeps(*piece, from, to)) return false;
      best = piece;
      good = to;
      return true;
    };
    for (std::size_t reach = 2 * (good - from); good + 1 < poses_.size(); reach *= 2) {
      const std::size_t to = std::min(from + reach, poses_.size() - 1);
      if (reaches(to)) continue;
      bad = to;
      break;
    }
    while (good + 1 < bad) {
      const std::size_t middle = good + (bad - good) / 2;
      if (!reaches(middle)) bad = middle;
    }
    return {best, good};
  }

  // Within the tolerance at some points, those amid the piece first: there it is off most.
  bool keeps(const geometry::PlanPiece& piece, std::size_t from, std::size_t to) const {
    const std::size_t stride = std::max<std::size_t>(1, (to - from) / 24);
    const std::size_t count = (to - from - 1) / stride, middle = (count + 1) / 2;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t step = i < middle ? middle - i : i + 1;
      if (!is_near(piece, from, to, from + step * stride)) return false;
    }
    return true;
  }

  bool is_near(const geometry::PlanPiece& piece, std::size_t from, std::size_t to,
               std::size_t i) const {
    const double s_m = piece.s_m + piece.length_m * double(i - from) / double(to - from);
    const geometry::Pose2 pose = geometry::plan_point(piece, s_m).pose;
    const Eigen::Vector2d off = poses_[i].position() - pose.position();
    const double beside_m = std::abs(geometry::cross(unit(pose.heading_rad), off));
    return beside_m <= tolerance_m_ && off.norm() <= 1.0;
  }

  double tolerance_m_;
  std::vector<geometry::Pose2> poses_;
};

}  // namespace

std::vector<geometry::PlanPiece> fit_reference_line(const ReferenceTarget& target, double scale_m,
                                                    double tolerance_m) {
  return ClothoidCutter(target, smoothed(target, scale_m), tolerance_m).cut();
}

}  // namespace roadbed::map::opendrive
