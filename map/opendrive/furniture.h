#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/opendrive/budget.h"
#include "roadbed/map/opendrive/build_lanes.h"

/// Where signals, objects and stop lines are and whom they speak to, each in a source of its own.
namespace roadbed::map::opendrive {

/// Places beside a road: (s, t, h) of its reference line, leaning with the superelevation, as
/// signals and objects give them (ASAM OpenDRIVE 1.8, section 7.6).
class RoadFrame {
 public:
  RoadFrame(const RoadRecord& road, const geometry::PlanView& plan_view)
      : road_(&road), plan_view_(&plan_view) {}

  const RoadRecord& road() const { return *road_; }

  Eigen::Vector3d at(double s_m, double t_m, double h_m) const;
  double heading_rad(double s_m) const { return plan_view_->at(s_m).pose.heading_rad; }

  /// How far the lanes reach: least and greatest t of any border at s.
  std::pair<double, double> reach_m(double s_m) const;

 private:
  const RoadRecord* road_;
  const geometry::PlanView* plan_view_;
};

/// Index of the lane section that holds at s.
std::size_t section_index_at(const RoadRecord& road, double s_m);

/// Whether it is a place that a map can hold.
bool is_placeable(const Eigen::Vector3d& in_map);

/// Drivable lanes of a road at s that something there speaks to: those that <validity> names (all
/// if it names none) and that drive the way of `orientation`. Where the file names lanes and none
/// of them drives that way, those that it names: some tools write the orientation the other way
/// round.
std::vector<LaneId> addressed_lanes(const RoadRecord& road, std::size_t road_index,
                                    const BuiltLanes& built, double s_m, char orientation,
                                    const LaneRanges& ranges);

/// The document's signals where they stand, with the lanes they speak to — on their own road and,
/// by <signalReference>, on others. What cannot be placed is left out and remarked, a reference to
/// a signal that is not there remarked. More references than the budget holds are left out.
std::vector<Signal> place_signals(const Document& document, std::span<const RoadFrame> frames,
                                  const BuiltLanes& built, PointBudget& budget,
                                  std::vector<ImportDiagnostic>& remarks);

/// The document's objects where they stand. An object with several outlines becomes one MapObject
/// for each; one that repeats, one for each copy, or one long body where copies have no distance;
/// one without an outline gets that of its length and width, or radius. A bridge or tunnel covers
/// its road from border to border. What cannot be placed is left out and remarked.
std::vector<MapObject> place_objects(const Document& document, std::span<const RoadFrame> frames,
                                     PointBudget& budget, std::vector<ImportDiagnostic>& remarks);

/// Corners of an object's outline in the map, in the file's order.
std::vector<Eigen::Vector3d> outline_in_map(const RoadFrame& frame, const ObjectRecord& object,
                                            const Outline& outline);

/// Stop lines of the file: objects whose type, subtype or name says "stop line", and signals of
/// type 294 (the German catalogue's stop line, which the standard's examples use). An object lies
/// along its longest extent, a signal across its road. Lanes are those that <validity> names, else
/// those that the line crosses. Signals are those that the line's own depend on, and the lights and
/// stop or give-way signs (205, 206) that speak to one of its lanes.
std::vector<StopLine> find_stop_lines(const Document& document, std::span<const RoadFrame> frames,
                                      const BuiltLanes& built, const std::vector<Signal>& signals,
                                      PointBudget& budget, std::vector<ImportDiagnostic>& remarks);

}  // namespace roadbed::map::opendrive
