#pragma once

#include <span>
#include <string>
#include <vector>

#include "roadbed/geometry/motion/trajectory.h"
#include "roadbed/geometry/polygons/ring.h"
#include "roadbed/planning/audit/surface/surface_audit.h"

namespace roadbed::planning::inline audit {

/// What of a certificate does not hold for a surface and a drive, a line each, at most ten; nothing
/// if all of it holds.
///
/// Shares no code with the audit, and asks for no union: at the middle of each span every edge of
/// every polygon that the body could touch while it keeps what the span promises has to have
/// surface on both of its sides, of whichever polygon, to within the seams; and the body's middle
/// has to be in one. Then all of the body is. That a drive is off the surface is checked in so far
/// as all the rest is proven to be on it.
///
/// Cost: O(spans × edges near × polygons near).
std::vector<std::string> check_surface_certificate(
    const SurfaceCertificate& certificate, const std::vector<geometry::Polygon>& polygons_in_source,
    double seam_m, double margin_m, const geometry::Trajectory& drive_in_source);

}  // namespace roadbed::planning::audit
