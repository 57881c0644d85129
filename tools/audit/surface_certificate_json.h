#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/planning/audit/surface/surface_audit.h"
#include "roadbed/tools/audit/certified_file.h"
#include "roadbed/tools/audit/road_audit.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline audit {

/// What a certificate says of a surface that a drive has to stay on.
struct CertifiedSurface {
  std::string on;                          ///< the words of the question
  std::optional<CertifiedFile> file = {};  ///< of a route or an area
  double margin_m = 0.0, seam_m = 0.0;
  double inflate_m = 0.0;  ///< margin around the vehicle, which its parts have
  std::vector<planning::SurfaceCertificate> parts;  ///< one for each part of the vehicle

  planning::Verdict verdict() const;
  /// The least that is proven; 0 where some of the drive is not.
  double certified_margin_m() const;
};

/// What an audit found, as a certificate has it.
/// @pre it was asked to certify
CertifiedSurface certified_surface(const RoadAudit& road, double inflate_m);

/// As it stands in a certificate's member "surface"; reading it gives the same numbers, bit for
/// bit.
Json surface_certificate_json(const CertifiedSurface& surface);

/// @throws InputError naming the place of what is wrong.
CertifiedSurface read_surface_certificate(const JsonNode& node);

/// What of it does not hold for a drive, a line each, by brute force from the map's own polygons.
/// @param parts_of_vehicle  without the margin.
/// @param road_map          null where none is named.
std::vector<std::string> surface_faults(const CertifiedSurface& surface,
                                        const std::vector<geometry::BodyPart>& parts_of_vehicle,
                                        const map::RoadMap* road_map,
                                        const geometry::Trajectory& drive);

}  // namespace roadbed::tools::audit
