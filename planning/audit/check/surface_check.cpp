#include "roadbed/planning/audit/check/surface_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <utility>

#include "roadbed/planning/audit/check/body_outline.h"

namespace roadbed::planning::inline audit {
namespace {

using Eigen::Vector2d;
using geometry::Polygon;
using geometry::Ring;

constexpr std::size_t kFaultsTold = 10;
constexpr double kRounding_m = 1e-6;

struct Segment {
  Vector2d from, to;
};

struct Interval {
  double from, to;
};

/// A polygon's rings as they stand, and the box around them.
struct Piece {
  const Polygon* polygon;
  Vector2d low, high;
};

template <typename Visit>
void visit_edges(const Polygon& polygon, const Visit& visit) {
  const auto of = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
  };
  of(polygon.outer);
  for (const Ring& hole : polygon.holes) of(hole);
}

Piece piece_of(const Polygon& polygon) {
  Piece piece{&polygon, polygon.outer.front(), polygon.outer.front()};
  for (const Vector2d& point : polygon.outer) {
    piece.low = piece.low.cwiseMin(point);
    piece.high = piece.high.cwiseMax(point);
  }
  return piece;
}

double cross_product_m2(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

bool is_in(const Polygon& polygon, const Vector2d& point) {
  bool inside = false;
  visit_edges(polygon, [&](const Vector2d& a, const Vector2d& b) {
    if ((a.y() > point.y()) == (b.y() > point.y())) return;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (x > point.x()) inside = !inside;
  });
  return inside;
}

/// The part of a segment within a convex quadrilateral, counter-clockwise, as fractions.
std::optional<Interval> part_within(const Segment& segment, const std::array<Vector2d, 4>& quad) {
  Interval part{0.0, 1.0};
  const Vector2d along = segment.to - segment.from;
  for (std::size_t i = 0; i < quad.size(); ++i) {
    const Vector2d side = quad[(i + 1) % quad.size()] - quad[i];
    const double at = cross_product_m2(side, segment.from - quad[i]),
                 slope = cross_product_m2(side, along);
    if (slope == 0.0) {
      if (at < 0.0) return std::nullopt;
      continue;
    }
    const double zero = -at / slope;
    (slope > 0.0 ? part.from : part.to) =
        slope > 0.0 ? std::max(part.from, zero) : std::min(part.to, zero);
  }
  if (part.from >= part.to) return std::nullopt;
  return part;
}

/// Parts of a segment in a polygon, as fractions.
std::vector<Interval> parts_in(const Segment& segment, const Polygon& polygon) {
  std::vector<double> cuts{0.0, 1.0};
  const Vector2d along = segment.to - segment.from;
  visit_edges(polygon, [&](const Vector2d& a, const Vector2d& b) {
    const Vector2d edge = b - a;
    const double turn = cross_product_m2(along, edge);
    if (turn == 0.0) return;
    const double on_segment = cross_product_m2(a - segment.from, edge) / turn;
    const double on_edge = cross_product_m2(a - segment.from, along) / turn;
    if (on_segment > 0.0 && on_segment < 1.0 && on_edge >= 0.0 && on_edge <= 1.0)
      cuts.push_back(on_segment);
  });
  std::ranges::sort(cuts);
  std::vector<Interval> parts;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (is_in(polygon, segment.from + 0.5 * (cuts[i] + cuts[i + 1]) * along)) {
      parts.push_back({cuts[i], cuts[i + 1]});
    }
  }
  return parts;
}

/// What a part leaves of intervals, but for what is no longer than `least`.
std::vector<Interval> without(const std::vector<Interval>& intervals, const Interval& part,
                              double least) {
  std::vector<Interval> left;
  for (const Interval& one : intervals) {
    const Interval before{one.from, std::min(one.to, part.from)};
    const Interval after{std::max(one.from, part.to), one.to};
    for (const Interval& rest : {before, after}) {
      if (rest.to - rest.from > least) left.push_back(rest);
    }
  }
  return left;
}

double to_point_m(const BodyOutline::Place& place, const Vector2d& point) {
  if (place.radius_m > 0.0)
    return std::max(0.0, (point - place.corners[0]).norm() - place.radius_m);
  bool is_inside = true;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < place.corners.size(); ++i) {
    const Vector2d& from = place.corners[i];
    const Vector2d along = place.corners[(i + 1) % place.corners.size()] - from;
    is_inside = is_inside && cross_product_m2(along, point - from) >= 0.0;
    const double u = std::clamp((point - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least_m = std::min(least_m, (point - from - u * along).norm());
  }
  return is_inside ? 0.0 : least_m;
}

class SurfaceCheck {
 public:
  SurfaceCheck(const SurfaceCertificate& certificate, const std::vector<Polygon>& polygons,
               double seam_m, double margin_m, const geometry::Trajectory& drive)
      : certificate_(certificate),
        // Neighbours as far apart as the seam was closed, each moved by as much, are told as one.
        beside_m_(2.0 * seam_m + kRounding_m),
        margin_m_(margin_m),
        drive_(drive),
        outline_(certificate.part, 0.0) {
    for (const Polygon& polygon : polygons) pieces_.push_back(piece_of(polygon));
    // An edge that many polygons cover together is covered by few of them in an order by chance.
    std::ranges::shuffle(pieces_, std::mt19937(1));
  }

  std::vector<std::string> faults() {
    check_cover();
    for (const ProvenSpan& span : certificate_.from_edge) {
      if (faults_.size() >= kFaultsTold) break;
      check_span(span);
    }
    if (faults_.size() > kFaultsTold) faults_.resize(kFaultsTold);
    return std::move(faults_);
  }

 private:
  std::size_t segments() const { return std::max<std::size_t>(1, drive_.points().size() - 1); }

  const geometry::TrajectoryPoint& sample(std::size_t i) const {
    return drive_.points()[std::min(i, drive_.points().size() - 1)];
  }

  double time_s(std::size_t segment, double fraction) const {
    return sample(segment).t_s + fraction * (sample(segment + 1).t_s - sample(segment).t_s);
  }

  void check_cover() {
    std::vector<Stretch> covered;
    for (const ProvenSpan& span : certificate_.from_edge) {
      if (span.segment >= segments() || !(span.from >= 0.0 && span.to <= 1.0)) {
        faults_.push_back(fmt::format("there is no segment {}", span.segment));
        return;
      }
      covered.push_back({time_s(span.segment, span.from), time_s(span.segment, span.to)});
    }
    for (const auto* left_out : {&certificate_.off, &certificate_.undecided}) {
      covered.insert(covered.end(), left_out->begin(), left_out->end());
    }
    std::ranges::sort(covered, {}, &Stretch::from_s);
    constexpr double rounding_s = 1e-9;
    double until_s = drive_.start_s();
    for (const Stretch& next : covered) {
      if (next.from_s > until_s + rounding_s) break;
      until_s = std::max(until_s, next.to_s);
    }
    if (until_s + rounding_s < drive_.end_s() || covered.empty()) {
      faults_.push_back(fmt::format("nothing is said of the time after {:.9g} s", until_s));
    }
  }

  void check_span(const ProvenSpan& span) {
    const auto at_s = [&] { return time_s(span.segment, 0.5 * (span.from + span.to)); };
    if (!(span.at_least_m >= margin_m_)) {
      faults_.push_back(fmt::format("at {:.9g} s it promises {:.9g} m, less than the margin",
                                    at_s(), span.at_least_m));
      return;
    }
    const geometry::TrajectoryPoint &a = sample(span.segment), &b = sample(span.segment + 1);
    const double way_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    const double turn_rad = std::abs(b.heading_rad - a.heading_rad);
    const double moves_m = 0.5 * (span.to - span.from) * (way_m + outline_.reach_m() * turn_rad);
    const double u = 0.5 * (span.from + span.to);
    const auto place = outline_.at(a.x_m + u * (b.x_m - a.x_m), a.y_m + u * (b.y_m - a.y_m),
                                   a.heading_rad + u * (b.heading_rad - a.heading_rad));
    const double needed_m = span.at_least_m + moves_m - kRounding_m;
    if (const auto fault = leaves(place, needed_m)) {
      faults_.push_back(fmt::format(
          "at {:.9g} s the edge at ({:.3f}, {:.3f}) is nearer than the {:.9g} m that are promised",
          at_s(), fault->x(), fault->y(), needed_m));
    }
  }

  /// A place of an edge within a distance of the body that has no surface on both sides.
  std::optional<Vector2d> leaves(const BodyOutline::Place& place, double needed_m) const {
    const map::Box2 around = place.around();
    const Vector2d margin = Vector2d::Constant(needed_m + beside_m_);
    const Vector2d low = around.min_in_source - margin, high = around.max_in_source + margin;
    std::vector<const Polygon*> near;
    for (const Piece& piece : pieces_) {
      if ((piece.low.array() <= high.array()).all() && (low.array() <= piece.high.array()).all()) {
        near.push_back(piece.polygon);
      }
    }
    const Vector2d middle =
        0.25 * (place.corners[0] + place.corners[1] + place.corners[2] + place.corners[3]);
    if (!is_on(middle, near)) return middle;
    const auto grown = grown_box(place, needed_m);
    for (const Polygon* polygon : near) {
      std::optional<Vector2d> open;
      visit_edges(*polygon, [&](const Vector2d& from, const Vector2d& to) {
        if (open) return;
        if (const auto part = near_part({from, to}, grown)) {
          open = open_place(*part, near, place, needed_m);
        }
      });
      if (open) return open;
    }
    return std::nullopt;
  }

  bool is_on(const Vector2d& point, const std::vector<const Polygon*>& near) const {
    for (const Vector2d& shift : {Vector2d(0, 0), Vector2d(beside_m_, 0), Vector2d(-beside_m_, 0),
                                  Vector2d(0, beside_m_), Vector2d(0, -beside_m_)}) {
      const Vector2d at = point + shift;
      if (std::ranges::any_of(near, [&](const Polygon* polygon) { return is_in(*polygon, at); }))
        return true;
    }
    return false;
  }

  /// The rectangle grown on all sides: it holds all within the distance.
  static std::array<Vector2d, 4> grown_box(const BodyOutline::Place& place, double by_m) {
    std::array<Vector2d, 4> grown = place.corners;
    const double radius_m = place.radius_m + by_m;
    const Vector2d across = place.corners[3] - place.corners[0];
    const Vector2d along = place.corners[1] - place.corners[0];
    const Vector2d x = along.norm() > 0.0 ? Vector2d(along.normalized()) : Vector2d(1, 0);
    const Vector2d y =
        across.norm() > 0.0 ? Vector2d(across.normalized()) : Vector2d(-x.y(), x.x());
    const std::array<std::pair<double, double>, 4> signs{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    for (std::size_t i = 0; i < grown.size(); ++i) {
      grown[i] += radius_m * (signs[i].first * x + signs[i].second * y);
    }
    return grown;
  }

  /// The part of an edge within the grown rectangle, and of what follows on it more than an open
  /// place has to be long, so that no such place is cut short.
  std::optional<Segment> near_part(const Segment& edge,
                                   const std::array<Vector2d, 4>& grown) const {
    const std::optional<Interval> part = part_within(edge, grown);
    if (!part) return std::nullopt;
    const Vector2d along = edge.to - edge.from;
    const double more = 6.0 * beside_m_ / along.norm();
    return Segment{edge.from + std::max(0.0, part->from - more) * along,
                   edge.from + std::min(1.0, part->to + more) * along};
  }

  /// A place of the edge, within the distance of the body, beside which one side is open.
  std::optional<Vector2d> open_place(const Segment& edge, const std::vector<const Polygon*>& near,
                                     const BodyOutline::Place& place, double needed_m) const {
    const Vector2d along = edge.to - edge.from;
    const double length_m = along.norm();
    if (!(length_m > 0.0)) return std::nullopt;
    const Vector2d left = Vector2d(-along.y(), along.x()) * (beside_m_ / length_m);
    for (const Vector2d& shift : {left, Vector2d(-left)}) {
      for (const Interval& open : open_parts(edge, shift, near)) {
        const Segment part{edge.from + open.from * along, edge.from + open.to * along};
        if (const auto at = nearest_within(part, place, needed_m)) return at;
      }
    }
    return std::nullopt;
  }

  /// Parts of an edge with no polygon right beside it, nor beyond a seam, but for those so short
  /// that they are a corner's. Of a short edge all, if there is none beside its middle.
  std::vector<Interval> open_parts(const Segment& edge, const Vector2d& shift,
                                   const std::vector<const Polygon*>& near) const {
    const std::array<Vector2d, 2> shifts{shift, Vector2d(kRounding_m / beside_m_ * shift)};
    const double length_m = (edge.to - edge.from).norm();
    if (length_m < 4.0 * beside_m_) {
      const Vector2d middle = 0.5 * (edge.from + edge.to);
      for (const Polygon* polygon : near) {
        if (is_in(*polygon, middle + shifts[0]) || is_in(*polygon, middle + shifts[1])) return {};
      }
      return {{0.0, 1.0}};
    }
    const double corner = 2.0 * beside_m_ / length_m;
    std::vector<Interval> open{{0.0, 1.0}};
    for (const Polygon* polygon : near) {
      for (const Vector2d& by : shifts) {
        for (const Interval& part : parts_in({edge.from + by, edge.to + by}, *polygon)) {
          open = without(open, part, corner);
        }
        if (open.empty()) return open;
      }
    }
    return open;
  }

  /// The point of a segment that is nearest to the body, by thirds; none if it is far enough.
  static std::optional<Vector2d> nearest_within(const Segment& segment,
                                                const BodyOutline::Place& place, double needed_m) {
    const auto distance_m = [&](double u) {
      const Vector2d at = segment.from + u * (segment.to - segment.from);
      return to_point_m(place, at);
    };
    double from = 0.0, to = 1.0;
    for (int i = 0; i < 60; ++i) {
      const double a = from + (to - from) / 3.0, b = to - (to - from) / 3.0;
      (distance_m(a) < distance_m(b) ? to : from) = distance_m(a) < distance_m(b) ? b : a;
    }
    const double u = 0.5 * (from + to);
    if (distance_m(u) >= needed_m) return std::nullopt;
    return segment.from + u * (segment.to - segment.from);
  }

  const SurfaceCertificate& certificate_;
  double beside_m_, margin_m_;
  const geometry::Trajectory& drive_;
  BodyOutline outline_;
  std::vector<Piece> pieces_;
  std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> check_surface_certificate(const SurfaceCertificate& certificate,
                                                   const std::vector<Polygon>& polygons,
                                                   double seam_m, double margin_m,
                                                   const geometry::Trajectory& drive) {
  return SurfaceCheck(certificate, polygons, seam_m, margin_m, drive).faults();
}

}  // namespace roadbed::planning::audit
