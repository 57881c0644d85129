#include "roadbed/map/files/open_module.h"

#include <dlfcn.h>

#include <filesystem>

namespace roadbed::map::inline files {

void* function_of_module(const std::string& module, const std::string& function) {
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
  const std::filesystem::path folder = program.parent_path();
  for (const auto& place : {folder, folder / "../lib"}) {
    void* opened = ::dlopen((place / (module + ".so")).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (opened == nullptr) continue;
    if (void* found = ::dlsym(opened, function.c_str())) return found;
  }
  return nullptr;
}

}  // namespace roadbed::map::files
