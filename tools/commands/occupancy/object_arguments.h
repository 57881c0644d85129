#pragma once

#include "roadbed/map/occupancy/objects/found_objects.h"
#include "roadbed/tools/cli/arguments.h"

namespace roadbed::tools::inline commands::inline occupancy {

/// The options of what counts as ground.
void declare_ground(Arguments& arguments, map::GroundOptions& options);

/// The options of what counts as an object.
class ObjectArguments {
 public:
  void declare(Arguments& arguments);
  const map::ObjectOptions& options() const { return options_; }

 private:
  map::ObjectOptions options_;
};

}  // namespace roadbed::tools::commands::occupancy
