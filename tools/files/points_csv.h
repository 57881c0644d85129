#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::tools::inline files {

/// Reads points: a header line that names the columns `x_m` and `y_m` (or `x` and `y`), then a row
/// per point. Order is free; other columns are ignored.
/// @throws InputError naming line and column; a file without a row is refused too.
std::vector<Eigen::Vector2d> read_points_csv(const std::filesystem::path& file);

/// The same from bytes; `name` stands for the file in messages.
std::vector<Eigen::Vector2d> parse_points_csv(std::string_view bytes, const std::string& name);

}  // namespace roadbed::tools
