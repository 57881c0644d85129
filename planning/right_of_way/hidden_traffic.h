#pragma once

#include <map>
#include <string>
#include <vector>

#include "roadbed/geometry/primitives/polyline.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/obstacles/obstacle.h"
#include "roadbed/planning/obstacles/visibility.h"
#include "roadbed/planning/task/driving_task.h"

namespace roadbed::planning::inline right_of_way {

/// Who may come from where nothing is seen, on lanes to which way is to be given: a column of cars,
/// bumper to bumper, wherever one is hidden upstream of where the lane meets the route; at the
/// greatest speed limit of the way.
///
///        ║▭║░░ may be here
///        ║▭║░░┌──────┐
///        ║ ║  └──────┘ hides
///     ═══╬═╬══════════
///       ▭▶            only what is seen is known to be free
///
/// Nobody is expected behind who is seen on the lane, nor on lanes that give way themselves.
class HiddenTraffic {
 public:
  /// Refers to the task.
  explicit HiddenTraffic(const DrivingTask& task) : task_(task) {}

  struct MayCome {
    std::vector<Obstacle> cars = {};
    std::vector<double> in_the_way_from_m = {};  ///< per car: of the task's line, of who waits
  };

  /// Those that may come at one of the task's stop points. O(m of lanes · others); lanes are looked
  /// for at the first call for a place.
  MayCome towards(std::size_t stop_point, const Visibility& sight, double t_s);

  /// The task has other stop points.
  void forget() { approaches_.clear(); }

 private:
  struct Approach {
    geometry::Polyline way;    ///< up to the end of the lane that meets the route
    double meets_at_m;         ///< of the way
    double in_the_way_from_m;  ///< of the task's line
    double limit_mps;          ///< 0: not known
    std::string lane;          ///< that meets it
  };
  class Finder;

  const std::vector<Approach>& approaches_to(std::size_t stop_point);
  static void add_hidden(const Approach& approach, const Visibility& sight, double t_s,
                         MayCome& found);

  const DrivingTask& task_;
  std::map<std::size_t, std::vector<Approach>> approaches_;
};

}  // namespace roadbed::planning::right_of_way
