#pragma once

#include <functional>
#include <string>

#include "roadbed/map/edit/clipping/region.h"
#include "roadbed/map/edit/edited.h"

namespace roadbed::map::inline edit::inline clipping {

struct ClipOptions {
  bool whole = false;  ///< roads and lanelets that the region touches stay whole
};

/// The part of a map inside a region, as a file of its own format; what of it roadbed does not use
/// stays. Ids stay. What leads to something outside is taken off, and kept in the file under names
/// of roadbed, so that parts of one map can be put together again (merge.h).
/// @param name  stands for the file in messages.
/// @throws InputError if the file is unusable, or of a format that cannot be clipped.
Edited clip(std::string bytes, const std::string& name, const Region& region,
            const ClipOptions& options = {});

/// Clips one map again and again, as `clip` does: it is read once, and what is far from a region
/// costs next to nothing.
using Clipper = std::function<Edited(const Region& region)>;

/// @throws InputError as `clip` does.
Clipper make_clipper(std::string bytes, const std::string& name, const ClipOptions& options = {});

// Of one format.
//
// OpenDRIVE: a road is cut across its reference line, at the first and the last station at which
// its cross-section, from border to border, touches the region. So everything inside is kept, and
// where the region's edge runs slantwise to the road, the road reaches beyond it by less than its
// width. A road that comes back in falls into parts; the first keeps the id.
Edited clip_open_drive(std::string bytes, const std::string& name, const Region& region,
                       const ClipOptions& options);
Clipper open_drive_clipper(std::string bytes, const std::string& name, const ClipOptions& options);

// Lanelet2: a lanelet is cut where the region's edge crosses its borders, each exactly there, at
// new points that lanelets beside it share. Where the edge does not cross both borders alike, the
// lanelet stays whole, and so do those that share a border with it. Regulatory elements stay with
// any of their lanelets, lines that they name stay whole.
Clipper lanelet2_clipper(std::string bytes, const std::string& name, const ClipOptions& options);

// CommonRoad: lanelets beside each other are cut together, across, at the first and the last row of
// their points (or a place between two) at which any of them touches the region: everything inside
// is kept. Obstacles and planning problems stay with where they begin.
Clipper common_road_clipper(std::string bytes, const std::string& name, const ClipOptions& options);

}  // namespace roadbed::map::edit::clipping
