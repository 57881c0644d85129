#pragma once

#include <pugixml.hpp>
#include <string>

#include "roadbed/map/edit/clip_memory.h"

namespace roadbed::map::inline edit {

/// Which part of an OpenDRIVE road a `<road>` is.
struct RoadCut {
  std::string road;               ///< id of the whole road
  double from_m = 0.0, to_m = 0;  ///< stations of the whole road
  double length_m = 0.0;          ///< of the whole road
  int section = 0;                ///< index of its first lane section in the whole road

  bool has_start() const { return from_m <= 0.0; }
  bool has_end() const { return to_m >= length_m; }
  bool is_whole() const { return has_start() && has_end(); }
};

/// What the road says of itself: itself where it has not been cut, or says what cannot be.
RoadCut road_cut(pugi::xml_node road);

/// Writes it, as `<cut>` in its clip memory.
void remember_cut(pugi::xml_node road, const RoadCut& cut);

/// Whether a road can be cut between its ends: not where its lane sections speak of one side only.
bool can_be_cut(pugi::xml_node road);

/// Leaves of a road what lies between two of its own stations, as exactly as it was: the reference
/// line is cut at both, with the place, heading and curvature that it has there; every record that
/// holds at the first station begins there, its polynomial about it; stations count from there;
/// signals and objects outside are gone, repeated ones, bridges and tunnels are shortened. Objects
/// with corners on both sides stand in the clip memory of the part where their own station is.
/// Links of lanes across a cut are taken off; those of roads are left to settle_references. Which
/// part it is stands in its clip memory.
/// @param from_m, to_m  stations, 0 ≤ from < to ≤ the road's length; a whole road stays as it is.
void cut_road(pugi::xml_node road, double from_m, double to_m);

/// Gives a part of a road the lateral shapes and surface strips that the whole road has there, as
/// its clip memory keeps them; a whole road has them as they were.
void restore_lateral(pugi::xml_node road);

/// Gives a road the objects back that reached over its ends when it was cut there, and lie in it
/// now.
void restore_objects(pugi::xml_node road);

/// Takes out a clip memory that holds nothing; of a whole road its `<cut>` is nothing.
void forget_empty_memory(pugi::xml_node parent);

}  // namespace roadbed::map::edit
