#pragma once

namespace roadbed::map::inline model {

/// How a map is read.
struct LoadOptions {
  double max_error_m = 1e-3;  ///< chord error of sampled borders and centrelines
  int threads = 1;            ///< that may be used; the map is the same for any number
};

}  // namespace roadbed::map::model
