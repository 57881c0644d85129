#include "roadbed/planning/behaviour/behaviour.h"

namespace roadbed::planning::inline behaviour {

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

}  // namespace roadbed::planning::behaviour
