// A planner's answer in, a trajectory or InputError out; what can be read is followed.
#include <cstddef>
#include <cstdint>
#include <string>

#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/simulation/outside_planner.h"
#include "roadbed/tools/simulation/trajectory_follower.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roadbed;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    const tools::OutsidePlan plan = tools::parse_outside_plan(bytes, "fuzz");
    if (plan.trajectory.empty()) return 0;
    tools::TrajectoryFollower follower(plan.trajectory, {});
    follower.error_of({0.0, 0.0, 0.0});
    follower.acceleration_mps2(plan.trajectory.start_s(), {0.0, 0.0, 0.0}, 1.0);
  } catch (const map::InputError&) {
  }
  return 0;
}
