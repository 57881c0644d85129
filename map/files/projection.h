#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>

namespace roadbed::map::inline files {

/// Coordinates of a coordinate reference system as longitude (x) and latitude (y) in degrees,
/// WGS 84, in place. Heights stay what they are: only the horizontal part of `crs` is used. PROJ is
/// opened now, not when the program starts, which would cost every command 8 ms.
/// @param crs  EPSG code ("EPSG:25832"), PROJ string or well-known text.
/// @throws InputError if roadbed was built without PROJ, PROJ does not know the system, or a point
///         is where the projection has no answer.
void to_lon_lat(const std::string& crs, std::span<Eigen::Vector2d> points);

/// Its inverse, in place. Throws as above.
void from_lon_lat(const std::string& crs, std::span<Eigen::Vector2d> points);

/// The horizontal part of a system as well-known text (WKT 1). Throws as above.
std::string well_known_text(const std::string& crs);

/// Refuses systems whose coordinates are not metres in a plane: degrees, geocentric ones, feet.
/// @throws InputError, and as above.
void require_metres(const std::string& crs);

/// Opens PROJ, where it is installed, as the first use of it does.
void open_projection_module();

/// Why PROJ cannot use a system; empty if it can. Throws where there is no PROJ.
std::string projection_fault(const std::string& crs);

/// The number of a system that names itself "EPSG:25832", or is UTM on WGS 84 or longitude and
/// latitude on it as a PROJ string; none otherwise.
std::optional<int> epsg_code(const std::string& crs);

/// The system as a PROJ string, which other programs ask for, where it is an EPSG code of UTM on
/// WGS 84; else as it stands.
std::string proj_string(const std::string& crs);

/// A transverse Mercator system whose origin is at a place: coordinates of an unknown system taken
/// as metres east and north of there.
/// @throws std::invalid_argument if the place is not on the globe.
std::string system_anchored_at(double latitude_deg, double longitude_deg);

}  // namespace roadbed::map::files
