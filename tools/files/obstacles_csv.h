#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "roadbed/planning/obstacles/obstacle.h"

namespace roadbed::tools::inline files {

/// Reads boxes with time stamps: a header line with the columns
/// `t_s,id,x_m,y_m,heading_rad,length_m,width_m` in any order, others are ignored, then a row per
/// box and time. Poses are those of the centre in source coordinates; between its rows a box moves
/// linearly, the shorter way round. It is there from its first to its last row; one of a single row
/// stands for ever. Where its size changes the largest counts. Obstacles come by their first row.
/// @throws InputError naming line and column.
std::vector<planning::ObstacleInSource> parse_obstacles_csv(std::string_view bytes,
                                                            const std::string& name);

/// Writes boxes with time stamps, which parse_obstacles_csv() reads as the same obstacles, but for
/// kinds, which the format does not have; lengths to half a micrometre.
/// @pre one that moves is there from its first row to its last, one that stands for ever.
std::string write_obstacles_csv(const std::vector<planning::ObstacleInSource>& obstacles);

/// All that is known of obstacles, so that equal texts mean equal obstacles.
std::string obstacles_text(const std::vector<planning::ObstacleInSource>& obstacles);

}  // namespace roadbed::tools::files
