#include "roadbed/map/edit/elevation/point_heights.h"

#include <fmt/format.h>

#include <cmath>

namespace roadbed::map::inline edit::inline elevation {

std::vector<std::optional<double>> heights_on(const std::vector<Eigen::Vector3d>& in_source,
                                              const HeightNetwork& lines,
                                              const GroundHeights& ground, const std::string& what,
                                              Edited& result) {
  std::vector<Eigen::Vector2d> at;
  at.reserve(in_source.size());
  for (const Eigen::Vector3d& point : in_source) at.emplace_back(point.head<2>());
  std::vector<std::optional<double>> changes_m = ground(at);
  std::size_t measured = 0, between = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (!changes_m[i]) continue;
    *changes_m[i] -= in_source[i].z();
    ++measured;
  }
  std::vector<std::optional<double>> heights_m = lines.filled(changes_m);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (!heights_m[i]) continue;
    between += changes_m[i] ? 0 : 1;
    *heights_m[i] += in_source[i].z();
  }
  result.count(what + " on the ground", measured);
  result.count(what + " where no ground was measured, by those along the lines", between);
  result.count(what + " that no line connects with any on the ground, left as they are",
               at.size() - measured - between);
  return heights_m;
}

std::string height_text(double height_m) {
  constexpr double kPerMetre = 1e4;
  return fmt::format("{}", std::round(height_m * kPerMetre) / kPerMetre + 0.0);
}

}  // namespace roadbed::map::edit::elevation
