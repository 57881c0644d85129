#pragma once

#include <pugixml.hpp>

namespace roadbed::map::inline edit::inline merging {

/// Whether a `<road>` goes on where another one ends or before that, both being parts of one road
/// (road_cut), and is at the same place there to within 1 mm.
bool goes_on(pugi::xml_node first, pugi::xml_node second);

/// Makes of two such parts one road, the first: what `cut_road` took apart is as it was, to within
/// rounding. Of where both are, the first one counts. The second is used up, and still to be
/// removed. References are those of the whole road (restore_references).
void join_roads(pugi::xml_node first, pugi::xml_node second);

}  // namespace roadbed::map::edit::merging
