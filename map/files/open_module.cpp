#include "roadbed/map/files/open_module.h"

#include <dlfcn.h>
#include <link.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

namespace roadbed::map::inline files {
namespace {

namespace fs = std::filesystem;

/// The program or shared library that this is linked into.
fs::path own_file() {
  Dl_info found{};
  void* map = nullptr;
  if (::dladdr1(reinterpret_cast<void*>(&own_file), &found, &map, RTLD_DL_LINKMAP) != 0) {
    const std::string name = static_cast<const ::link_map*>(map)->l_name;
    if (!name.empty()) return fs::canonical(name);  // the program itself has no name there
  }
  return fs::read_symlink("/proc/self/exe");
}

/// Relative to the file above: in the build, in a Python package, installed.
std::vector<fs::path> module_folders() {
  std::vector<fs::path> folders;
  // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing here changes the environment
  if (const char* named = std::getenv("ROADBED_MODULES")) folders.emplace_back(named);
  const fs::path own = own_file().parent_path();
  for (const fs::path place : {"lib", "../lib", "roadbed", "../" ROADBED_MODULE_FOLDER}) {
    folders.push_back(own / place);
  }
  if (const fs::path installed = ROADBED_INSTALLED_MODULES; installed.is_absolute()) {
    folders.push_back(installed);  // a wheel is installed nowhere in particular
  }
  return folders;
}

}  // namespace

ModuleFunction function_of_module(const std::string& module, const std::string& function) {
  const std::string file = module + ".so";
  std::string fault = file + " is not installed";
  for (const fs::path& folder : module_folders()) {
    if (!fs::exists(folder / file)) continue;
    void* opened = ::dlopen((folder / file).c_str(), RTLD_NOW | RTLD_LOCAL);
    void* found = opened == nullptr ? nullptr : ::dlsym(opened, function.c_str());
    if (found != nullptr) return {.address = found};
    fault = file + " cannot be opened: " + ::dlerror();  // NOLINT(concurrency-mt-unsafe)
  }
  return {.fault = fault};
}

}  // namespace roadbed::map::files
