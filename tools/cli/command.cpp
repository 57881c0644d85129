#include "roadbed/tools/cli/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>

#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/files/input_error.h"

namespace roadbed::tools::inline cli {

Failure failure_of(const std::exception& error) {
  if (dynamic_cast<const map::InputError*>(&error) != nullptr) {
    return {Exit::unusable, error.what()};
  }
  if (const auto* fault = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    return {Exit::unusable, fmt::format("{}: {}; check the path", fault->path1().string(),
                                        fault->code().message())};
  }
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return {Exit::internal, "out of memory"};
  }
  return {Exit::internal,
          fmt::format("internal error: {}; please report it with the command line", error.what())};
}

int CommonOptions::several_threads() const {
  constexpr int most = 4;  // unless more are asked for
  return threads > 0 ? threads : std::min(map::processors(), most);
}

}  // namespace roadbed::tools::cli
