#include "roadbed/tools/commands/occupancy/object_arguments.h"

namespace roadbed::tools::inline commands::inline occupancy {

void declare_ground(Arguments& arguments, map::GroundOptions& options) {
  arguments
      .add("--ground-slope", options.slope, "The steepest ground: rise over run, 0.3 is 17 degrees")
      .within(0.01, 10.0)
      .with_default();
  arguments
      .add("--ground-cell", options.cell_m,
           "Side of the squares whose lowest points are taken for ground [m]")
      .within(0.05, 20.0)
      .with_default();
  arguments
      .add("--ground-height", options.most_height_m,
           "What is higher over the ground is none, from two thirds of it on level ground [m]")
      .within(0.02, 5.0)
      .with_default();
  arguments
      .add("--widest-object", options.widest_m,
           "The narrower side of the largest thing that is no ground, as houses are not [m]")
      .within(1.0, 200.0)
      .with_default();
}

void ObjectArguments::declare(Arguments& arguments) {
  arguments
      .add("--tolerance", options_.tolerance_m, "Points that are this near are of one object [m]")
      .within(0.05, 10.0)
      .with_default();
  arguments
      .add("--least-points", options_.least_points, "What has fewer points in a cloud is no object")
      .within(1, 1e6)
      .with_default();
  arguments
      .add("--tallest", options_.tallest_m,
           "What is higher above the ground than this is in nobody's way: crowns of trees, signs "
           "[m]")
      .within(0.1, 100.0)
      .with_default();
  arguments
      .add("--longest", options_.longest_m,
           "What is longer is cut, so that boxes lie close around walls [m]")
      .within(0.5, 1000.0)
      .with_default();
  arguments.add("--widest", options_.widest_m, "What is wider is cut [m]")
      .within(0.5, 1000.0)
      .with_default();
  declare_ground(arguments, options_.ground);
}

}  // namespace roadbed::tools::commands::occupancy
