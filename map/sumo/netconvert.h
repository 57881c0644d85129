#pragma once

#include <string>
#include <vector>

#include "roadbed/map/sumo/write.h"

namespace roadbed::map::sumo {

/// A net, and what netconvert had to say of it.
struct ConvertedNet {
  std::string bytes;  ///< of the .net.xml, without the time at which it was made
  std::vector<std::string> warnings;
};

/// What SUMO's netconvert makes of plain files: that of $SUMO_HOME/bin, else of PATH.
/// @param files  named "net".
/// @throws InputError if there is none, or it makes no net.
/// @throws OutputError if there is no place for the files that it reads.
ConvertedNet run_netconvert(const SumoFiles& files);

}  // namespace roadbed::map::sumo
