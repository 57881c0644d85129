#pragma once

#include <string>
#include <vector>

#include "roadbed/map/repair/one_repair.h"

// What may be mended in a file of each format, by its document. A proposal stands for itself: none
// needs another one.

namespace roadbed::map::inline repair {

/// Links that only one side names, among lanes of sections and roads that follow each other; links
/// of lanes and roads whose ends coincide; the other end of a linked road, where that is the one
/// that meets; lengths and stations of curves, and curves of no length; curves that start beside
/// the end of the one before.
/// @throws InputError if the file is no XML.
std::vector<Repair> propose_open_drive(const std::string& bytes, const std::string& name,
                                       const RepairOptions& options);

/// Nodes at the ends of borders that nearly coincide, borders with the roles of each other, borders
/// without a type (which become `virtual`: nobody may cross them, as before), nodes that a way
/// names twice running.
/// @throws InputError if the file is no Lanelet2 map.
std::vector<Repair> propose_lanelet2(const std::string& bytes, const std::string& name,
                                     const RepairOptions& options);

/// Links that only one side names, links of lanes whose ends coincide, ends of linked lanes that
/// nearly meet, bounds on each other's side or drawn against each other.
/// @throws InputError if the file is no XML.
std::vector<Repair> propose_common_road(const std::string& bytes, const std::string& name,
                                        const RepairOptions& options);

}  // namespace roadbed::map::repair
