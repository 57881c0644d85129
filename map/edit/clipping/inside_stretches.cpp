#include "roadbed/map/edit/clipping/inside_stretches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "roadbed/map/edit/clipping/touching_spans.h"
#include "roadbed/map/opendrive/lane_borders.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

using Eigen::Vector2d;

constexpr double kStepM = 0.1;        // stretches shorter than this are not looked into
constexpr double kNoStretchM = 1e-5;  // shorter stretches are none

// How many metres the reference line may go per metre of station; more than 1 only where a
// polynomial's parameter runs unevenly.
double fastest(const geometry::PlanPiece& piece) {
  const auto* curve = std::get_if<geometry::ParamPoly3Curve>(&piece.curve);
  if (curve == nullptr) return 1.0;
  const double p = curve->p_end;
  const auto bound = [p](const std::array<double, 4>& c) {
    return std::abs(c[1]) + p * (2.0 * std::abs(c[2]) + p * 3.0 * std::abs(c[3]));
  };
  return std::max(1.0, std::hypot(bound(curve->u), bound(curve->v)) * p / piece.length_m);
}

// Bound of a piecewise cubic over a stretch.
double greatest(const geometry::PiecewiseCubic& cubic, double from_m, double to_m) {
  const auto& records = cubic.records();
  double most = 0.0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const double begin_m = i == 0 ? from_m : std::max(from_m, records[i].s_m);
    const double end_m = i + 1 < records.size() ? std::min(to_m, records[i + 1].s_m) : to_m;
    if (begin_m > end_m) continue;
    most = std::max(most, geometry::cubic_bounds(records[i], begin_m, end_m).value);
  }
  return most;
}

// One lane section: how far it reaches sideways at most, and where its outermost borders are.
class SectionExtent {
 public:
  SectionExtent(const opendrive::RoadRecord& road, const geometry::PlanView& plan_view,
                std::size_t section)
      : sides_{opendrive::section_side(road, section, 1),
               opendrive::section_side(road, section, -1)},
        borders_{opendrive::SideBorders(road, plan_view, sides_[0]),
                 opendrive::SideBorders(road, plan_view, sides_[1])} {}

  double widest_m(const opendrive::RoadRecord& road, double from_m, double to_m) const {
    double most_m = 0.0;
    for (const opendrive::SectionSide& side : sides_) {
      double sum_m = greatest(road.lane_offset.cubic, from_m, to_m);
      for (const opendrive::LaneRecord* lane : side.lanes) {
        sum_m += greatest(lane->outer(), from_m, to_m);
      }
      most_m = std::max(most_m, sum_m);
    }
    return most_m;
  }

  // From the left to the right.
  std::array<Vector2d, 2> at(double s_m) {
    std::array<Vector2d, 2> ends;
    for (std::size_t i = 0; i < 2; ++i) {
      borders_[i].enter(s_m, s_m);
      borders_[i].evaluate(s_m, row_);
      ends[i] = row_.border_in_map.back();
    }
    return ends;
  }

 private:
  std::array<opendrive::SectionSide, 2> sides_;
  std::array<opendrive::SideBorders, 2> borders_;
  opendrive::CrossSection row_;
};

class Search {
 public:
  Search(const opendrive::RoadRecord& road, const Vector2d& origin_in_source)
      : road_(road), plan_view_(road.plan_pieces), origin_(origin_in_source) {
    for (const geometry::PlanPiece& piece : road.plan_pieces) {
      fastest_ = std::max(fastest_, fastest(piece));
    }
  }

  std::vector<StationSpan> run(const Region& region) {
    if (road_.sections.empty()) return without_lanes(region);
    each_section([&](SectionExtent& extent, double from_m, double to_m) {
      touching_spans(
          RegionPart(region), from_m, to_m,
          [&](double a_m, double b_m) { return disc_around(a_m, b_m).box(); },
          [&](const RegionPart& part, double a_m, double b_m) {
            const Disc disc = disc_around(a_m, b_m);
            return part.side_of_disc(disc.centre, disc.radius_m);
          },
          [](double a_m, double b_m) { return b_m - a_m <= kStepM; },
          [&](const RegionPart& part, double s_m) {
            const auto [left, right] = extent.at(s_m);
            return part.touches(origin_ + left, origin_ + right);
          },
          found_);
    });
    return spans_on_grid();
  }

  geometry::Box box() {
    if (road_.sections.empty()) return geometry::Box(start());
    geometry::Box box;
    each_section([&](SectionExtent&, double from_m, double to_m) {
      box.extend(disc_around(from_m, to_m).box());
    });
    return box;
  }

 private:
  // Ends outwards to whole 2⁻²⁰ m (1 µm): stations counted from there are exact, and so are those
  // of the whole road when they are counted back.
  std::vector<StationSpan> spans_on_grid() {
    constexpr double kPerMetre = 1 << 20;
    std::vector<StationSpan> spans;
    for (const Span& span : found_) {
      const double from_m = std::floor(span.from * kPerMetre) / kPerMetre;
      const double to_m = std::ceil(span.to * kPerMetre) / kPerMetre;
      if (to_m - from_m < kNoStretchM) continue;
      if (!spans.empty() && from_m <= spans.back().to_m) {
        spans.back().to_m = std::min(to_m, road_.length_m);
      } else {
        spans.push_back({std::max(0.0, from_m), std::min(to_m, road_.length_m)});
      }
    }
    return spans;
  }

  struct Disc {
    Vector2d centre;
    double radius_m;

    geometry::Box box() const {
      const Vector2d reach = Vector2d::Constant(radius_m);
      return {centre - reach, centre + reach};
    }
  };

  Vector2d start() const { return origin_ + plan_view_.at(0.0).pose.position(); }

  std::vector<StationSpan> without_lanes(const Region& region) const {
    const bool inside = region.contains(start());
    return inside ? std::vector<StationSpan>{{0.0, road_.length_m}} : std::vector<StationSpan>{};
  }

  // Calls `f` with each lane section that has a length, and its stations.
  template <typename F>
  void each_section(const F& f) {
    for (std::size_t i = 0; i < road_.sections.size(); ++i) {
      const double from_m = i == 0 ? 0.0 : road_.sections[i].s_m;
      const double to_m =
          i + 1 < road_.sections.size() ? road_.sections[i + 1].s_m : road_.length_m;
      if (!(to_m > from_m)) continue;
      SectionExtent extent(road_, plan_view_, i);
      widest_m_ = extent.widest_m(road_, from_m, to_m);
      f(extent, from_m, to_m);
    }
  }

  // Around all between two stations of a section.
  Disc disc_around(double from_m, double to_m) const {
    return {origin_ + plan_view_.at(0.5 * (from_m + to_m)).pose.position(),
            0.5 * (to_m - from_m) * fastest_ + widest_m_ + kNoStretchM};
  }

  const opendrive::RoadRecord& road_;
  const geometry::PlanView plan_view_;
  const Vector2d origin_;
  double fastest_ = 1.0, widest_m_ = 0.0;
  std::vector<Span> found_;
};

}  // namespace

std::vector<StationSpan> stretches_inside(const opendrive::RoadRecord& road,
                                          const Vector2d& origin_in_source, const Region& region) {
  return Search(road, origin_in_source).run(region);
}

geometry::Box box_around(const opendrive::RoadRecord& road, const Vector2d& origin_in_source) {
  return Search(road, origin_in_source).box();
}

}  // namespace roadbed::map::edit::clipping
