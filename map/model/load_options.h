#pragma once

namespace roadbed::map::inline model {

/// How a map is read.
struct LoadOptions {
  double max_error_m = 1e-3;  ///< chord error of sampled borders and centrelines
};

}  // namespace roadbed::map::model
