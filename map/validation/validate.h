#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/road_map.h"
#include "roadbed/map/validation/finding.h"

namespace roadbed::map {

/// Above these a rule speaks up.
struct ValidateOptions {
  double max_gap_m = 0.01;                     ///< between the ends of linked lanes
  double max_kink_rad = 0.05;                  ///< between the headings of linked centrelines
  double max_step_m = 0.02;                    ///< of elevation, width or lane offset
  double max_slope_jump = 0.05;                ///< between the slopes of two elevation records
  double max_slope = 0.3;                      ///< of the road's elevation
  double max_curvature_per_m = 0.4;            ///< of a drivable lane's centreline
  double max_curvature_jump_per_m = 0.25;      ///< between two curves of a reference line
  double max_speed_mps = 70.0;                 ///< of a speed limit
  double max_lateral_acceleration_mps2 = 8.0;  ///< at the speed limit in a bend
  double max_signal_distance_m = 50.0;         ///< from the nearest lane
  double max_object_distance_m = 100.0;        ///< from the nearest lane
  double min_overlap_m = 5.0;                  ///< along lanes that should not overlap
};

/// Every fault of a map, in order of rule and element. Never throws over a faulty map.
std::vector<Finding> validate(const RoadMap& road_map, const ValidateOptions& options = {});

/// A map with its findings.
struct Validation {
  std::optional<RoadMap> road_map;  ///< none if the file cannot be read as a map
  std::string refusal;              ///< then: the reader's one line about it
  std::vector<Finding> findings;    ///< places are in the map's frame, else in the source's

  Eigen::Vector2d to_source(const Eigen::Vector2d& in_map) const {
    return road_map ? road_map->to_source(in_map) : in_map;
  }
};

/// Every fault of a map file: of its text, of the map that it makes, and what its reader says. A
/// file that names a known format but cannot be read is a finding, not an exception.
/// @throws InputError if the file is missing or of no known format.
Validation validate_file(const std::filesystem::path& file, const ValidateOptions& options = {});

/// The same from bytes; `name` stands for the file in messages.
Validation validate_bytes(std::string bytes, const std::string& name,
                          const ValidateOptions& options = {});

}  // namespace roadbed::map
