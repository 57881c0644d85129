#include "roadbed/planning/reference/way_point_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/geometry/primitives/cross.h"
#include "roadbed/planning/reference/bezier_places.h"

namespace roadbed::planning::inline reference {
namespace {

using Eigen::Vector2d;
using geometry::CornerGaps;
using geometry::QuinticBezier;
using geometry::VehicleShape;

constexpr double kLongest_m = 40.0;
constexpr int kLengths = 60, kProportions = 40;
constexpr double kTurnsBack = 0.99;  // cosine of the angle between the segments

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
    return geometry::cross(to - from, point - from) > 0.0;
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

// All curves with the same proportions are alike: the one of total gaps 1 m, scaled. Its curvature
// falls with the length, the rate with its square.
struct Shape {
  CornerGaps unit;
  std::vector<BezierPlace> places;  // of the curve with `unit`, the corner in the origin
  double peak_curvature = 0.0, peak_rate = 0.0;
};

Shape shape_of(const CornerQuestion& question, double first_fraction, double room_m) {
  const Vector2d back = (question.before - question.at).normalized();
  const Vector2d ahead = (question.after - question.at).normalized();
  Shape shape{.unit = {first_fraction, first_fraction, 1.0 - 2.0 * first_fraction}, .places = {}};
  shape.places = dense_places_on(
      QuinticBezier::corner(2.0 * back, Vector2d(0.0, 0.0), 2.0 * ahead, shape.unit), room_m);
  for (const BezierPlace& place : shape.places) {
    shape.peak_curvature = std::max(shape.peak_curvature, std::abs(place.curvature_per_m));
    shape.peak_rate = std::max(shape.peak_rate, std::abs(place.rate_per_m2));
  }
  return shape;
}

double peak_steering_radps(const Shape& shape, double total_m, double speed_mps,
                           double wheelbase_m) {
  double peak = 0.0;
  for (const BezierPlace& place : shape.places) {
    const double tangent = wheelbase_m * place.curvature_per_m / total_m;
    const double rate_per_m2 = std::abs(place.rate_per_m2) / (total_m * total_m);
    peak = std::max(peak, wheelbase_m * speed_mps * rate_per_m2 / (1.0 + tangent * tangent));
  }
  return peak;
}

struct Choice {
  const Shape* shape;
  double total_m;
  double peak_rate_per_m2() const { return shape->peak_rate / (total_m * total_m); }
};

// Looks at one choice after the other, the gentlest first.
class GapSearch {
 public:
  GapSearch(const CornerQuestion& question, const VehicleShape& vehicle)
      : question_(question), vehicle_(vehicle) {}

  bool will_do(const Choice& choice) {
    ++looked_at_;
    const double curvature_per_m = choice.shape->peak_curvature / choice.total_m;
    if (std::atan(vehicle_.wheelbase_m * curvature_per_m) > vehicle_.max_steering_rad) {
      return ++too_bent_, false;
    }
    if (peak_steering_radps(*choice.shape, choice.total_m, question_.speed_mps,
                            vehicle_.wheelbase_m) > vehicle_.max_steering_rate_radps) {
      return ++too_quick_, false;
    }
    return keeps_inside(choice) || (++outside_, false);
  }

  std::string reason() const {
    return fmt::format(
        "none of {} curves will do: {} leave the drivable area, {} bend more than can be steered, "
        "{} would have to be steered faster than the wheels turn at {:.1f} m/s",
        looked_at_, outside_, too_bent_, too_quick_, question_.speed_mps);
  }

 private:
  // From the middle to the ends: what leaves the area mostly does so at the corner.
  bool keeps_inside(const Choice& choice) const {
    if (question_.drivable.empty()) return true;
    const std::size_t count = choice.shape->places.size(), middle = count / 2;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = i % 2 == 0 ? middle - i / 2 : middle + (i + 1) / 2;
      const geometry::Pose2& unit = choice.shape->places[std::min(at, count - 1)].pose;
      const Vector2d on_curve = question_.at + choice.total_m * unit.position();
      const geometry::Pose2 pose{on_curve.x(), on_curve.y(), unit.heading_rad};
      if (!is_inside(geometry::body_at(pose, vehicle_), question_.drivable)) return false;
    }
    return true;
  }

  const CornerQuestion& question_;
  const VehicleShape& vehicle_;
  int looked_at_ = 0, outside_ = 0, too_bent_ = 0, too_quick_ = 0;
};

}  // namespace

CornerChoice choose_corner_gaps(const CornerQuestion& question, const VehicleShape& vehicle) {
  const double room_m = room_of(question);
  const Vector2d back = question.before - question.at, ahead = question.after - question.at;
  if (back.normalized().dot(ahead.normalized()) > kTurnsBack) {
    return {.gaps = {}, .reason = "the legs lie on each other: no curve turns back between them"};
  }
  std::vector<Shape> shapes;
  for (int i = 1; i < kProportions; ++i) {
    shapes.push_back(shape_of(question, 0.5 * i / kProportions, room_m));
  }
  std::vector<Choice> choices;
  for (const Shape& shape : shapes) {
    for (int i = 1; i <= kLengths; ++i) {
      choices.push_back({&shape, room_m * (1.0 - 1e-9) * i / kLengths});
    }
  }
  std::ranges::stable_sort(choices, {}, &Choice::peak_rate_per_m2);
  GapSearch search(question, vehicle);
  for (const Choice& choice : choices) {
    if (!search.will_do(choice)) continue;
    return {.gaps = geometry::scaled_to(choice.shape->unit, choice.total_m),
            .peak_curvature_per_m = choice.shape->peak_curvature / choice.total_m,
            .peak_rate_per_m2 = choice.peak_rate_per_m2(),
            .reason = {}};
  }
  return {.gaps = {}, .reason = search.reason()};
}

}  // namespace roadbed::planning::reference
