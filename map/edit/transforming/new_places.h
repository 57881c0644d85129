#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

namespace roadbed::map::inline edit::inline transforming {

/// Refuses places that no map may have, for a transformed file could not be read again.
/// @param points  in the file's new coordinates [m].
/// @throws InputError
void require_places(std::span<const Eigen::Vector2d> points, const std::string& file);

[[noreturn]] void refuse_place(const Eigen::Vector2d& point, const std::string& needed,
                               const std::string& file);

}  // namespace roadbed::map::edit::transforming
