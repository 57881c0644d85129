#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/planning/reference/speed_ceiling.h"
#include "roadbed/tools/simulation/drive.h"
#include "roadbed/tools/simulation/driven_way.h"
#include "roadbed/tools/simulation/path_keeper.h"
#include "roadbed/tools/simulation/speed_search.h"
#include "roadbed/tools/simulation/timed_goal.h"
#include "roadbed/tools/simulation/waiting_places.h"
#include "roadbed/tools/simulation/way_occupancy.h"

namespace roadbed::tools {

/// How much is dared: room to obstacles, and braking.
struct Daring {
  double margin_m;
  SpeedSearchOptions speed;
  bool is_emergency;
};

/// From the most careful on.
inline constexpr std::array<Daring, 3> kDarings{{
    {.margin_m = 0.4, .speed = {}, .is_emergency = false},
    {.margin_m = 0.4, .speed = {.least_mps2 = -8.0, .most_mps2 = 4.0}, .is_emergency = true},
    {.margin_m = 0.1, .speed = {.least_mps2 = -8.0, .most_mps2 = 4.0}, .is_emergency = true},
}};

/// One line to the goal, and the path that is kept along it.
struct Course {
  const planning::ReferenceLine& line;
  planning::SpeedCeiling ceiling;
  std::vector<GoalStretch> stretches;
  std::vector<WaitingPlace> lights;
  PathKeeper keeper;
};

/// One path, the way along it, and the best drive found on it.
struct Attempt {
  const Course* course;
  std::optional<PathKeeper::Proposal> proposal;  ///< none: the path that is being driven
  DrivenWay way;
  double on_road_m;  ///< how far along the way the body keeps to the road
  SpeedSearchAnswer answer;
  const Daring* daring = nullptr;
  std::shared_ptr<const WayOccupancy> occupancy = nullptr;  ///< with that room
  double cost = 0.0;
  std::optional<DriveLead> lead;
};

/// How far beside the reference line the path ends.
double beside_m(const Attempt& attempt);

/// Whether it meets nothing, and takes no bend faster than can be borne.
bool is_drivable(const Attempt& attempt);

/// Whether nothing else need be tried: it is drivable, and does not miss the goal.
bool is_good(const Attempt& attempt);

/// Free before not free; then by cost, or by how long it is free and how slow it is by then.
bool is_better(const Attempt& a, const Attempt& b);

}  // namespace roadbed::tools
