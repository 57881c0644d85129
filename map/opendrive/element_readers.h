#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "roadbed/map/opendrive/document.h"
#include "roadbed/map/opendrive/values.h"

/// Readers of the file's elements into the document, each in a source of the element's name.
namespace roadbed::map::opendrive {

/// <header>: revision, CRS with its offset. What is missing or broken there is remarked; another
/// major revision is a fault.
void read_header(AttributeReader& in, Document& document);

/// All <road> elements into `document.roads`, in threads. Roads without a geometry and repeated
/// ones are remarked; that there is no usable one is a fault.
void read_roads(AttributeReader& in, Document& document, int threads);

/// What there is to say of a road that is being read, and how many lanes it may have: a bound of
/// memory.
struct RoadNotes {
  std::vector<ImportDiagnostic> remarks;
  std::size_t most_lanes = 0;
};

/// Whether a map can have the road: it is not repeated, and has a plan view of positive length.
bool is_usable(const RoadRecord& road);

/// <predecessor>/<successor> of a road or of a virtual connection; none if there is no such node.
std::optional<RoadLink> read_road_link(AttributeReader& in, pugi::xml_node node);

/// <planView> of a road, as listed. Pieces of no length, and lengths that do not fit, are remarked;
/// a value beyond that of any road is a fault.
void read_plan_view(AttributeReader& in, RoadRecord& road, RoadNotes& notes);

/// Shorter than this a piece has no direction of its own; leaving it out moves nothing.
inline constexpr double kShortestPieceM = 1e-9;

/// The records of <laneOffset>, as listed.
void read_lane_offset(AttributeReader& in, pugi::xml_node lanes, RoadRecord& road);

/// All lane sections of a road, as listed; none if it has more lanes than memory is granted for,
/// which is a fault.
void read_lanes(AttributeReader& in, pugi::xml_node lanes, RoadRecord& road, RoadNotes& notes);

/// How many <lane> elements they have.
std::size_t count_lanes(pugi::xml_node lanes);

/// Puts the records of a road and of its lanes in order of their stations, and makes its profiles.
/// Sections in order of s; repeated lanes are left out.
void mend_road(RoadRecord& road);

/// Fills in which section follows which on each side. O(number of sections).
void connect_sections(std::vector<LaneSection>& sections);

/// Roads of virtual junctions join others in between (elementS): splits the lane sections there, so
/// that lanes end and begin where others join them. What is split is remarked; a station off the
/// road too.
void split_at_virtual_links(Document& document);

/// The lane sections of a road that meet at a station inside it: the one that ends there and the
/// one that begins there. None where no section begins at that station.
std::optional<std::pair<std::size_t, std::size_t>> sections_meeting_at(const RoadRecord& road,
                                                                       double s_m);

/// <roadMark> with what it allows: by its laneChange, without that by its line type — of a double
/// line the one nearer to the driver.
RoadMark read_mark(const XmlDocument& xml, pugi::xml_node node, int lane_id, double s_m);

/// <signals> of a road: signals and references to signals of other roads. One that cannot be read
/// is left out and remarked: it must not make a city unusable.
void read_signals(AttributeReader& in, pugi::xml_node signals, RoadRecord& road,
                  std::vector<ImportDiagnostic>& remarks);

/// <objects> of a road: objects with outlines and repeats, references, bridges and tunnels. One
/// that cannot be read is left out and remarked.
void read_objects(AttributeReader& in, pugi::xml_node objects, RoadRecord& road,
                  std::vector<ImportDiagnostic>& remarks);

/// All <junction> elements into `document.junctions`, all <controller> ones into
/// `document.controllers`.
void read_junctions(AttributeReader& in, Document& document);
void read_controllers(const XmlDocument& xml, Document& document);

/// Counts elements that the reader does not look at, by "parent/element"; what stands inside one
/// belongs to it. In order of name.
std::vector<UnusedContent> count_unused(const XmlDocument& xml);

}  // namespace roadbed::map::opendrive
