#pragma once

// Private to map/occupancy: how the functions of the module that links PCL are found.

#include <string>

namespace roadbed::map::inline occupancy::inline clouds {

/// A function of the module that links PCL. The module is opened now, not when the program starts,
/// which would cost every command 50 ms.
/// @throws InputError if roadbed was built without PCL.
void* pcl_function(const std::string& name);

/// The same with its type, as the headers of the module's functions name it.
template <typename Function>
Function& pcl_function_as(const std::string& name) {
  return *reinterpret_cast<Function*>(pcl_function(name));
}

}  // namespace roadbed::map::occupancy::clouds
