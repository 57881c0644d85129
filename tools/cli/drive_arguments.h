#pragma once

#include <optional>
#include <string>
#include <vector>

#include "roadbed/tools/cli/arguments.h"
#include "roadbed/tools/files/drive_file.h"

namespace roadbed::tools::inline cli {

/// The options that say what files of drives leave open: `--topic --pose-frame --rate`.
class DriveArguments {
 public:
  std::vector<Argument> declare(Arguments& arguments);

  /// @param shape  of the vehicle whose centre may be meant.
  DriveOptions options(const geometry::VehicleShape& shape) const;

 private:
  std::string topic_, frame_;
  std::optional<double> rate_hz_;
};

}  // namespace roadbed::tools::cli
