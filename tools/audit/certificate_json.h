#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/ground/ground.h"
#include "roadbed/planning/audit/certificate.h"
#include "roadbed/planning/audit/ground_under.h"
#include "roadbed/tools/audit/certified_file.h"
#include "roadbed/tools/audit/surface_certificate_json.h"

namespace roadbed::tools::inline audit {

/// What the heights of a vehicle were above, and where that was taken from.
struct CertifiedGround {
  planning::GroundRule::Kind kind = planning::GroundRule::Kind::level;
  planning::GroundUnder under;
};

/// A certificate with its inputs, as it stands in a file.
struct CertificateFile {
  std::string program;                          ///< name and version of what wrote it
  std::optional<CertifiedFile> occupancy = {};  ///< none: it is about the surface only
  CertifiedFile trajectory = {};
  /// Of dynamic obstacles, if there are any; the hash is that of the obstacles, not of the file's
  /// bytes, since a scenario names other files.
  std::optional<CertifiedFile> obstacles = {};
  std::optional<CertifiedFile> vehicle = {};  ///< none: CommonRoad's vehicle 2
  std::optional<CertifiedFile> roads = {};
  double underside_m = 0.2;     ///< above the ground, of the body and of circles without their own
  CertifiedGround ground = {};  ///< what the parts' bands are above
  double least_measured = 0.0;  ///< required of `measured_fraction`
  /// One for each part of the vehicle, the body first; all of one question but for their heights.
  /// None without an occupancy.
  std::vector<planning::AuditCertificate> parts;
  std::optional<CertifiedSurface> surface = {};  ///< that the drive has to stay on

  planning::Verdict verdict() const;  ///< the gravest; unknown where too little was measured
  /// The least of all; 0 if that of one is not certified, or without an occupancy.
  double certified_clearance_m() const;
  /// Mean over the parts, by the space that they take.
  double measured_fraction() const;
};

/// The JSON of a certificate; reading it gives the same numbers, bit for bit. A span is written as
/// `[segment, from, to, at_least_m]`, a stretch as `[from_s, to_s]`, an observed time as `[from_s,
/// to_s, x_m, y_m]`. What is said of the first part
/// stands in the document itself, that of others in its list "parts".
std::string write_certificate_json(const CertificateFile& file);

/// @throws InputError naming the place of what is wrong.
CertificateFile read_certificate_json(const std::filesystem::path& file);

/// The inputs that a certificate names, with those that these name; none if it is unusable.
std::vector<std::filesystem::path> files_named_by_certificate(const std::filesystem::path& file);

/// The same as `read_certificate_json` from bytes; `name` stands for the file in messages.
CertificateFile parse_certificate_json(std::string_view bytes, const std::string& name);

}  // namespace roadbed::tools::audit
