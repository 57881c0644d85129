#include "roadbed/planning/obstacles/traffic.h"

namespace roadbed::planning::inline obstacles {

std::vector<BodyThere> bodies_there(std::span<const Obstacle> obstacles, double t_s) {
  std::vector<BodyThere> there;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if (!obstacles[i].is_there(t_s)) continue;
    const geometry::Rectangle body = rectangle_at(obstacles[i], t_s);
    const bool is_again = !there.empty() && there.back().body.centre == body.centre;
    if (!is_again) there.push_back({i, body});
  }
  return there;
}

}  // namespace roadbed::planning::obstacles
