#pragma once

#include <string>
#include <vector>

#include "roadbed/map/occupancy/clouds/cloud_filter.h"
#include "roadbed/tools/cli/arguments.h"

namespace roadbed::tools::inline commands::inline occupancy {

/// The options of a CloudFilter, all but those that need PCL.
class FilterArguments {
 public:
  void declare(Arguments& arguments);
  map::CloudFilter filter() const;

  /// As one would type it; empty where everything counts.
  std::string words() const;

 private:
  std::vector<double> classes_, left_out_classes_, intensity_, range_m_, height_m_, vehicle_box_;
  std::string returns_;
};

}  // namespace roadbed::tools::commands::occupancy
