#pragma once

#include <string>
#include <vector>

#include "roadbed/map/edit/edited.h"

namespace roadbed::map::inline edit::inline merging {

/// A map file.
struct MergeInput {
  std::string bytes, name;  ///< the name stands for it in messages
};

struct MergeOptions {
  double tolerance_m = 0.05;  ///< ends at most this far apart are linked
  bool same_system = false;   ///< take all coordinates as those of the first map
};

/// An element that got another id, because another map has its own.
struct Renamed {
  std::string file, kind, from, to;
};

/// Where parts of different maps meet.
struct Seam {
  std::string first, second;  ///< "end of road 5", "start of road 12"
  double gap_m = 0.0;         ///< between the places that meet: of lanes linked, the greatest
  std::string what;           ///< "joined", "linked", "linked but for lanes …", or why not
  double x_m = 0.0, y_m = 0.0;
};

struct Merged : Edited {
  std::vector<Renamed> renamed;
  std::vector<Seam> seams;
};

/// One map of several of the same format. Parts that a clip left (clip.h) are what they were
/// before: roads and lanelets that were cut are whole again, where nothing between is missing. What
/// all say alike is taken once. Of different elements with one id the later one gets another, and
/// so does whatever names it. Free ends that coincide are linked.
/// @throws InputError if a file is unusable, they are of different formats, or of different
///         coordinate systems.
Merged merge(std::vector<MergeInput> inputs, const MergeOptions& options = {});

// Of one format.
Merged merge_open_drive(std::vector<MergeInput> inputs, const MergeOptions& options);
Merged merge_lanelet2(std::vector<MergeInput> inputs, const MergeOptions& options);

// CommonRoad: obstacles and planning problems come along, but for those of a file whose time step
// is another.
Merged merge_common_road(std::vector<MergeInput> inputs, const MergeOptions& options);

}  // namespace roadbed::map::edit::merging
