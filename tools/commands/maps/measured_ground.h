#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace roadbed::tools::inline commands::inline maps {

/// Heights of the ground at points by all of some files, point clouds together, each octree by
/// itself: of several that know one, the first counts, and clouds before octrees.
/// @throws InputError if a file is unusable, or no point is on measured ground.
std::vector<std::optional<double>> measured_ground(const std::vector<std::filesystem::path>& files,
                                                   std::span<const Eigen::Vector2d> at_in_source);

}  // namespace roadbed::tools::commands::maps
