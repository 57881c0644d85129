#pragma once

#include <pugixml.hpp>

#include "roadbed/geometry/curves/plan_view.h"

namespace roadbed::map::inline edit {

/// A `<geometry>` of OpenDRIVE; its numbers are those of a file that has been read.
geometry::PlanPiece plan_piece(pugi::xml_node geometry);

/// Where a road's reference line is at one of its stations.
geometry::Pose2 reference_pose(pugi::xml_node road, double s_m);

/// Leaves what of a `<planView>` lies between two stations, which then count from the first:
/// records that are cut go on being lines, arcs, spirals, poly3 and paramPoly3, and are where they
/// were to within rounding. A poly3 keeps its frame's heading, a paramPoly3 gets that of its start.
/// @param to_m  infinite: up to the end.
void cut_plan_view(pugi::xml_node plan_view, double from_m, double to_m);

/// The geometry that a station is inside of; none where two meet.
pugi::xml_node geometry_across(pugi::xml_node plan_view, double s_m);

/// Leaves of a geometry what lies between two distances from its start; its station stays.
void cut_geometry(pugi::xml_node geometry, double from_m, double to_m);

}  // namespace roadbed::map::edit
