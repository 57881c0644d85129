#include <nanobind/nanobind.h>

#include "roadbed/tools/cli/build_id.h"
#include "roadbed/tools/python/bindings.h"

NB_MODULE(_roadbed, module) {
  namespace python = roadbed::tools::python;
  module.attr("__doc__") = "What roadbed's libraries bring to Python; `import roadbed` has it all.";
  module.attr("__version__") = roadbed::tools::version();
  python::bind_errors(module);
  python::bind_lanes(module);
  python::bind_maps(module);
  python::bind_reference_lines(module);
  python::bind_routes(module);
  python::bind_motion(module);
  python::bind_obstacles(module);
  python::bind_occupancy(module);
  python::bind_audits(module);
  python::bind_plans(module);
  python::bind_controllers(module);
  python::bind_drives(module);
}
