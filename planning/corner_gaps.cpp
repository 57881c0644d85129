#include "roadbed/planning/corner_gaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "roadbed/geometry/rectangle.h"

namespace roadbed::planning {
namespace {

using Eigen::Vector2d;
using geometry::CornerGaps;
using geometry::QuinticBezier;
using geometry::VehicleShape;

constexpr double kLongest_m = 40.0;
constexpr int kLengths = 60, kProportions = 40;
constexpr double kStep_m = 0.2;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// A place on the curve; κ′ by the derivatives of the curve, not by differences.
struct Place {
  geometry::Pose2 pose;
  double curvature_per_m, rate_per_m2;
};

Place place_at(const QuinticBezier& curve, double t) {
  const Vector2d p = curve.at(t), p1 = curve.derivative(t, 1), p2 = curve.derivative(t, 2),
                 p3 = curve.derivative(t, 3);
  const double squared = p1.squaredNorm(), speed = std::sqrt(squared);
  const double turn = cross(p1, p2), curvature = turn / (squared * speed);
  // d/dt (turn / speed³), by arc length.
  const double rate = (cross(p1, p3) - 3.0 * turn * p1.dot(p2) / squared) / (squared * squared);
  return {{p.x(), p.y(), std::atan2(p1.y(), p1.x())}, curvature, rate};
}

std::vector<Place> places_on(const QuinticBezier& curve) {
  // The parameter's speed is at most that of the control polygon's longest side, five times over.
  const auto& control = curve.control_points();
  double longest_m = 0.0;
  for (std::size_t i = 0; i + 1 < control.size(); ++i) {
    longest_m = std::max(longest_m, (control[i + 1] - control[i]).norm());
  }
  const int count = static_cast<int>(std::ceil(5.0 * longest_m / kStep_m));
  std::vector<Place> places;
  for (int i = 0; i <= count; ++i) {
    places.push_back(place_at(curve, static_cast<double>(i) / count));
  }
  return places;
}

bool holds(const std::vector<Vector2d>& ring, const Vector2d& point) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Vector2d &a = ring[i], &b = ring[j];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (point.x() < x) inside = !inside;
  }
  return inside;
}

bool cross_each_other(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const auto side = [](const Vector2d& from, const Vector2d& to, const Vector2d& point) {
    return cross(to - from, point - from) > 0.0;
  };
  return side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b);
}

bool is_inside(const geometry::Rectangle& body, const std::vector<Vector2d>& ring) {
  const auto corners = body.corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!holds(ring, corners[i])) return false;
    const Vector2d& next = corners[(i + 1) % corners.size()];
    for (std::size_t j = 0; j < ring.size(); ++j) {
      if (cross_each_other(corners[i], next, ring[j], ring[(j + 1) % ring.size()])) return false;
    }
  }
  return true;
}

struct Verdict {
  double peak_curvature_per_m = 0.0, peak_rate_per_m2 = 0.0, peak_steering_radps = 0.0;
};

Verdict peaks_of(const std::vector<Place>& places, double speed_mps, double wheelbase_m) {
  Verdict peaks;
  for (const Place& place : places) {
    const double tangent = wheelbase_m * place.curvature_per_m;
    const double rate = std::abs(place.rate_per_m2);
    peaks.peak_curvature_per_m =
        std::max(peaks.peak_curvature_per_m, std::abs(place.curvature_per_m));
    peaks.peak_rate_per_m2 = std::max(peaks.peak_rate_per_m2, rate);
    peaks.peak_steering_radps = std::max(
        peaks.peak_steering_radps, wheelbase_m * speed_mps * rate / (1.0 + tangent * tangent));
  }
  return peaks;
}

double room_of(const CornerQuestion& question) {
  const double room_m =
      std::min((question.before - question.at).norm(), (question.after - question.at).norm());
  if (!(room_m > 0.0) || !std::isfinite(room_m)) {
    throw std::invalid_argument("choose_corner_gaps: both legs need a length");
  }
  if (!(question.speed_mps >= 0.0) || !std::isfinite(question.speed_mps)) {
    throw std::invalid_argument(
        fmt::format("choose_corner_gaps: the speed must be finite and not negative, got {} m/s",
                    question.speed_mps));
  }
  return std::min(room_m, kLongest_m);
}

// Looks at one choice after the other, and keeps the best.
class Search {
 public:
  Search(const CornerQuestion& question, const VehicleShape& vehicle)
      : question_(question), vehicle_(vehicle) {}

  void look_at(const CornerGaps& gaps) {
    const auto curve = QuinticBezier::corner(question_.before, question_.at, question_.after, gaps);
    const std::vector<Place> places = places_on(curve);
    const Verdict peaks = peaks_of(places, question_.speed_mps, vehicle_.wheelbase_m);
    ++looked_at_;
    if (best_.gaps && peaks.peak_rate_per_m2 >= best_.peak_rate_per_m2) return;
    if (std::atan(vehicle_.wheelbase_m * peaks.peak_curvature_per_m) > vehicle_.max_steering_rad) {
      ++too_bent_;
    } else if (peaks.peak_steering_radps > vehicle_.max_steering_rate_radps) {
      ++too_quick_;
    } else if (!keeps_inside(places)) {
      ++outside_;
    } else {
      best_ = {gaps, peaks.peak_curvature_per_m, peaks.peak_rate_per_m2, {}};
    }
  }

  CornerChoice answer() const {
    if (best_.gaps) return best_;
    return {
        .gaps = {},
        .reason = fmt::format("none of {} curves will do: {} leave the drivable area, {} bend "
                              "more than can be steered, {} would have to be steered faster "
                              "than the wheels turn at {:.1f} m/s",
                              looked_at_, outside_, too_bent_, too_quick_, question_.speed_mps)};
  }

 private:
  bool keeps_inside(const std::vector<Place>& places) const {
    if (question_.drivable.empty()) return true;
    return std::ranges::all_of(places, [&](const Place& place) {
      return is_inside(geometry::body_at(place.pose, vehicle_), question_.drivable);
    });
  }

  const CornerQuestion& question_;
  const VehicleShape& vehicle_;
  CornerChoice best_;
  int looked_at_ = 0, outside_ = 0, too_bent_ = 0, too_quick_ = 0;
};

}  // namespace

CornerChoice choose_corner_gaps(const CornerQuestion& question, const VehicleShape& vehicle) {
  const double room_m = room_of(question);
  Search search(question, vehicle);
  for (int i = kLengths; i >= 1; --i) {
    const double total_m = room_m * (1.0 - 1e-9) * i / kLengths;
    for (int j = 1; j < kProportions; ++j) {
      const double first_m = 0.5 * total_m * j / kProportions;
      search.look_at({first_m, first_m, total_m - 2.0 * first_m});
    }
  }
  return search.answer();
}

}  // namespace roadbed::planning
