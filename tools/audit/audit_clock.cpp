#include "roadbed/tools/audit/audit_clock.h"

#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/planning/obstacles/recorded_obstacles.h"
#include "roadbed/tools/files/drive_file.h"
#include "roadbed/tools/simulation/world.h"

namespace roadbed::tools::inline audit {

long second_0_step(const std::filesystem::path& drive,
                   std::span<const std::filesystem::path> files) {
  if (!drive.empty() && is_solution(drive)) return 0;
  for (const std::filesystem::path& file : files) {
    if (file.empty() || !is_common_road(file)) continue;
    const auto step = planning::initial_step(
        map::commonroad::parse_scenario(map::read_file(file), map::input_name(file)));
    if (step) return *step;
  }
  return 0;
}

}  // namespace roadbed::tools::audit
