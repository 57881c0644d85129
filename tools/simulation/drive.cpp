#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools::inline simulation {

std::string_view name(Outcome outcome) {
  switch (outcome) {
    case Outcome::goal_reached:
      return "goal reached";
    case Outcome::stopped:
      return "stopped";
    case Outcome::collision:
      return "collision";
    case Outcome::timed_out:
      return "timed out";
  }
  return "";
}

}  // namespace roadbed::tools
