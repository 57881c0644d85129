#include "roadbed/map/occupancy/clouds/pcl_function.h"

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/open_module.h"

namespace roadbed::map::inline occupancy::inline clouds {

void* pcl_function(const std::string& name) {
  const ModuleFunction found = function_of_module("libroadbed_pcl", name);
  if (found.address != nullptr) return found.address;
  throw InputError({.file = "point clouds by PCL",
                    .found = found.fault,
                    .remedy = "install PCL (Debian: libpcl-filters1.13 and "
                              "libpcl-segmentation1.13; libpcl-dev before roadbed is built), or "
                              "leave out what needs it"});
}

}  // namespace roadbed::map::occupancy::clouds
