#pragma once

#include <string>

namespace roadbed::map::inline files {

/// A function of a module that is opened now, so that only the commands that use a large library
/// pay for starting it. Modules are beside the program, as installed, or in the build's folder of
/// libraries. Null if there is no such module or function.
void* function_of_module(const std::string& module, const std::string& function);

}  // namespace roadbed::map::files
