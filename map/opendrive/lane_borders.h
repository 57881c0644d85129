#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/opendrive/document.h"

namespace roadbed::map::opendrive {

/// One side of one lane section: its lanes from the middle of the road outwards.
struct SectionSide {
  double from_s_m = 0.0, to_s_m = 0.0;
  int sign = 1;  ///< of the lanes' ids: +1 left, −1 right
  std::vector<const LaneRecord*> lanes;
};

/// The lanes of a section's side, and how far that side reaches: to the next section that says
/// something of it.
SectionSide section_side(const RoadRecord& road, std::size_t section, int sign);

/// Index of the next section that says something of that side, or the number of sections.
std::size_t next_section(const RoadRecord& road, std::size_t section, int sign);

/// All borders of a side at one station, from the lane offset outwards.
struct CrossSection {
  double s_m = 0.0;
  std::vector<Eigen::Vector2d> border_in_map;
  std::vector<double> z_m;
};

/// A side of a road between two stations with no record beginning between them, so that every
/// value along it is one cubic: where its borders are, and how much they can bend.
class SideBorders {
 public:
  SideBorders(const RoadRecord& road, const geometry::PlanView& plan_view, const SectionSide& side);

  /// Takes the records that hold between two stations.
  void enter(double from_s_m, double to_s_m);

  /// Bound of every border's second derivative by s, in plan and height, between two stations.
  double second_derivative_bound(double from_s_m, double to_s_m) const;

  /// Sets the row to the borders at a station.
  void evaluate(double s_m, CrossSection& row) const;

  /// What stands above the road's surface: one per lane, or empty where no lane is raised.
  const std::vector<LaneHeight>& raised() const { return raised_; }

 private:
  struct Range {
    double low_m, high_m;
  };
  // Of a lane's outer border: its width from the inner one, or its border from the lane offset.
  struct Outer {
    const geometry::CubicRecord* record = nullptr;
    bool by_width = true;
  };

  double outer_offset_m(const Outer& outer, double inner_m, double offset_m, double s_m) const;
  Range sideways_range(double from_s_m, double to_s_m, const geometry::CubicValue& t,
                       double roll_fraction, double height_m) const;
  double fall_d2(const geometry::CubicValue& t, double from_s_m, double to_s_m) const;
  std::optional<double> slope(const geometry::CubicValue& t, double from_s_m, double to_s_m) const;
  LateralShape::Bounds shape_bounds(double from_s_m, double to_s_m) const;
  geometry::CubicValue offset_bounds(double from_s_m, double to_s_m) const;
  void enter_raised(double s_m);

  const RoadRecord& road_;
  const geometry::PlanView& plan_view_;
  const SectionSide& side_;
  double middle_s_m_ = 0.0;
  const geometry::PlanPiece* piece_ = nullptr;
  const geometry::CubicRecord *elevation_ = nullptr, *roll_ = nullptr, *fall_ = nullptr,
                              *offset_ = nullptr;
  std::vector<Outer> outer_;  // by lane
  std::vector<LaneHeight> raised_;
};

}  // namespace roadbed::map::opendrive
