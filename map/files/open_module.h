#pragma once

#include <string>

namespace roadbed::map::inline files {

/// A function of a module, or why there is none.
struct ModuleFunction {
  void* address = nullptr;
  std::string fault = {};  ///< empty if there is an address
};

/// A function of a module that is opened now, so that only the commands that use a large library
/// pay for starting it. Modules are looked for beside the program or library that this is part of,
/// wherever it was installed or built; in the folder that the environment variable ROADBED_MODULES
/// names; and where `cmake --install` puts them without a --prefix.
ModuleFunction function_of_module(const std::string& module, const std::string& function);

}  // namespace roadbed::map::files
