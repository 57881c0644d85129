#include "roadbed/tools/simulation/drive.h"

namespace roadbed::tools {

std::string_view name(Behaviour behaviour) {
  switch (behaviour) {
    case Behaviour::cruise:
      return "cruise";
    case Behaviour::pass:
      return "pass";
    case Behaviour::follow:
      return "follow";
    case Behaviour::yield:
      return "yield";
    case Behaviour::stop:
      return "stop";
    case Behaviour::emergency:
      return "emergency";
  }
  return "";
}

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
