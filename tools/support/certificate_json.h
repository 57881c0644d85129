#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/ground.h"
#include "roadbed/planning/audit_certificate.h"

namespace roadbed::tools {

/// A file that a certificate speaks of. The hash finds mix-ups and changes, not forgeries.
struct CertifiedFile {
  std::string name;    ///< as it was given on the command line
  std::string xxhash;  ///< XXH3 (64 bits) of its bytes, hexadecimal
};

CertifiedFile certified_file(const std::filesystem::path& file);

/// A certificate with its inputs, as it stands in a file.
struct CertificateFile {
  std::string program;  ///< name and version of what wrote it
  CertifiedFile occupancy, trajectory;
  /// Of what moves, if anything does; the hash is that of the obstacles, not of the file's bytes,
  /// since a scenario names other files.
  std::optional<CertifiedFile> obstacles = {};
  /// What the question was taken from; the vehicle's parts and the ground stand here besides.
  std::optional<CertifiedFile> vehicle = {}, roads = {};
  std::shared_ptr<const map::Ground> ground = nullptr;  ///< of the parts' bands, if not level
  /// One for each part of the vehicle, the body first; all of one question but for their heights.
  std::vector<planning::AuditCertificate> parts;

  planning::Verdict verdict() const;  ///< the gravest
  /// The least of all; 0 if that of one is not certified.
  double certified_clearance_m() const;
};

CertifiedFile certified_obstacles(const std::filesystem::path& file,
                                  const std::vector<planning::MovingObstacle>& obstacles);

/// The JSON of a certificate; reading it gives the same numbers, bit for bit. A span is written as
/// `[segment, from, to, at_least_m]`, a stretch as `[from_s, to_s]`. What is said of the first part
/// stands in the document itself, that of others in its list "parts".
std::string write_certificate_json(const CertificateFile& file);

/// @throws InputError naming the place of what is wrong.
CertificateFile read_certificate_json(const std::filesystem::path& file);

/// The inputs that a certificate names, with those that these name; none if it is unusable.
std::vector<std::filesystem::path> files_named_by_certificate(const std::filesystem::path& file);

/// The same as `read_certificate_json` from bytes; `name` stands for the file in messages.
CertificateFile parse_certificate_json(std::string_view bytes, const std::string& name);

}  // namespace roadbed::tools
