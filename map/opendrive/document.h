#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/geometry/curves/piecewise_cubic.h"
#include "roadbed/geometry/curves/plan_view.h"
#include "roadbed/map/elements/attributes.h"
#include "roadbed/map/elements/border_mark.h"
#include "roadbed/map/elements/lane.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/opendrive/lateral_shape.h"
#include "roadbed/map/opendrive/surface_strips.h"

/// What an OpenDRIVE file says, element by element. Names follow the standard (ASAM OpenDRIVE
/// 1.4–1.8). Stations are those of the road everywhere: offsets from a lane section's start are
/// added up when read.
///
/// A document is first as the file lists it, faults and all: that is what the rules judge. `mend`
/// then makes of it what a map is built from. Up to there a number that is missing or broken is
/// NaN: comparisons with it are false, so that one fault is not found by many rules. A `node` is
/// where an element stands in the file; it holds as long as the XmlDocument does its elements.
namespace roadbed::map::opendrive {

enum class ContactPoint { start, end };

/// A cubic record of a profile (elevation, width, …), with the element that holds it.
struct CubicElement {
  pugi::xml_node node;
  geometry::CubicRecord record;
};

/// The records of a profile: as listed, and from `mend` on as the function of s that they are.
struct Profile {
  std::vector<CubicElement> listed;
  geometry::PiecewiseCubic cubic;
};

/// <predecessor>/<successor> of a road.
struct RoadLink {
  pugi::xml_node node;
  bool to_junction = false;
  std::string element_id;
  std::optional<ContactPoint> contact;
  std::optional<double> element_s_m;  ///< of a virtual junction: joins the other road in between
  bool element_forward = true;        ///< elementDir="+"
};

/// <roadMark>. `type` as the file writes it: of double lines the inner one first, in the middle
/// (lane 0) the left one.
struct RoadMark {
  double s_m = 0.0;
  MarkType type = MarkType::none;
  bool outwards = true, inwards = true;  ///< may be crossed away from the road's middle, and back
  std::string color;
  double width_m = 0.0;
};

/// <speed> of a lane or of a road's <type>.
struct SpeedRecord {
  double s_m = 0.0;
  std::optional<double> limit_mps;
};

/// <height>: how far the lane's inner and outer border stand above the road's surface.
struct LaneHeight {
  double s_m = 0.0, inner_m = 0.0, outer_m = 0.0;
  bool operator==(const LaneHeight&) const = default;
};

/// <access>: one kind of road user that is let in or kept out.
struct LaneAccess {
  double s_m = 0.0;
  bool allow = false;
  std::string restriction;
};

struct LaneRecord {
  pugi::xml_node node;
  const char* side = "";  ///< the element that it stands in: "left", "center" or "right"
  int place = 0;          ///< among the lanes of its section, as listed
  int id = 0;
  LaneType type = LaneType::none;
  std::string direction;  ///< 1.8: "standard", "reversed", "both", or empty
  bool level = false;     ///< is kept flat where the road leans
  long line = 0;
  std::vector<int> predecessors, successors;
  Profile width, border;
  std::vector<RoadMark> marks;
  std::vector<SpeedRecord> speeds;
  std::vector<LaneHeight> heights;
  std::vector<LaneAccess> accesses;
  Attributes attributes;

  /// What places the outer border; where a file has both, widths take precedence.
  const geometry::PiecewiseCubic& outer() const {
    return goes_by_width() ? width.cubic : border.cubic;
  }
  bool goes_by_width() const { return !width.cubic.empty() || border.cubic.empty(); }
};

/// Lanes by id: left ones positive, the centre 0, right ones negative. A single-sided section
/// says nothing of the other side, where the section before goes on.
struct LaneSection {
  pugi::xml_node node;
  double s_m = 0.0;
  bool single_side = false;
  long line = 0;
  std::multimap<int, LaneRecord> lanes;  ///< from `mend` on one of each id

  /// Lanes as the file lists them. One without a whole number for an id is nowhere.
  std::vector<std::reference_wrapper<const LaneRecord>> listed() const;

  /// The (first) lane of that id, null if there is none.
  const LaneRecord* find(int id) const {
    const auto found = lanes.lower_bound(id);
    return found == lanes.end() || found->first != id ? nullptr : &found->second;
  }

  /// Sections before and after that say something of a side; the number of sections: none.
  std::size_t next_left = 0, next_right = 0, before_left = 0, before_right = 0;
};

/// Lanes that something speaks of: <validity>, from and to.
using LaneRanges = std::vector<std::pair<int, int>>;

struct SignalRecord {
  pugi::xml_node node;
  bool is_broken = false;  ///< a number of it cannot be read: no signal of the map
  std::string id, name;
  double s_m = 0.0, t_m = 0.0, z_offset_m = 0.0, heading_offset_rad = 0.0;
  double width_m = 0.0;
  std::string country, type, subtype, unit, text;
  std::optional<double> value;
  bool dynamic = false;
  char orientation = 0;  ///< '+', '-', or 0 for both
  LaneRanges lanes;      ///< empty: all lanes
  std::vector<std::string> dependencies;
  Attributes attributes;

  struct Inertial {
    double x_m, y_m, z_m, heading_rad;
  };
  struct OnRoad {
    std::string road_id;
    double s_m, t_m, z_offset_m, heading_offset_rad;
  };
  std::optional<Inertial> inertial;  ///< where it stands, if not at s and t
  std::optional<OnRoad> on_road;
};

/// <signalReference>: a signal of another road that speaks to lanes of this one too.
struct SignalReference {
  pugi::xml_node node;
  bool is_broken = false;
  std::string signal_id;
  double s_m = 0.0, t_m = 0.0;
  char orientation = 0;
  LaneRanges lanes;
  long line = 0;
};

/// A corner of an outline: s, t, dz of the road, or u, v, z of the object.
struct Corner {
  bool on_road = false;
  double a = 0.0, b = 0.0, z_m = 0.0;
};

struct Outline {
  bool closed = true;
  std::vector<Corner> corners;
};

/// <repeat>: copies every `distance_m`, or one long body where that is 0.
struct Repeat {
  double s_m = 0.0, length_m = 0.0, distance_m = 0.0;
  double t_start_m = 0.0, t_end_m = 0.0, z_start_m = 0.0, z_end_m = 0.0;
  double width_start_m = 0.0, width_end_m = 0.0, height_m = 0.0;
};

struct ObjectRecord {
  pugi::xml_node node;
  bool is_broken = false;
  std::string id, name, type, subtype;
  double s_m = 0.0, t_m = 0.0, z_offset_m = 0.0, heading_rad = 0.0;
  double length_m = 0.0, width_m = 0.0, radius_m = 0.0, height_m = 0.0;
  char orientation = 0;
  LaneRanges lanes;
  std::vector<Outline> outlines;
  std::vector<Repeat> repeats;
  Attributes attributes;
  long line = 0;
};

/// <objectReference>: an object of another road that counts for this one too.
struct ObjectReference {
  std::string object_id;
  double s_m = 0.0, t_m = 0.0;
};

/// <bridge> or <tunnel>.
struct Structure {
  std::string kind, id, name, type;
  double s_m = 0.0, length_m = 0.0;
  LaneRanges lanes;
};

/// <geometry> of a plan view, as listed.
struct GeometryRecord {
  pugi::xml_node node;
  double s_m = 0.0, length_m = 0.0;
  /// None if it has no length, no curve, or a number that is broken or beyond that of any road.
  std::optional<geometry::PlanPiece> piece;
};

struct RoadRecord {
  pugi::xml_node node;
  bool is_repeated = false;  ///< has the id of a road before it: no road of the map
  std::string id, name;
  std::string junction_id;  ///< empty if it is not a connecting road
  double length_m = 0.0;
  bool left_hand_traffic = false;
  long line = 0;
  std::optional<RoadLink> predecessor, successor;
  std::vector<SpeedRecord> speeds;
  std::vector<GeometryRecord> geometry;          ///< as listed, up to `mend`
  std::vector<geometry::PlanPiece> plan_pieces;  ///< from `mend` on, relative to origin_in_source
  Profile elevation, superelevation, lane_offset;
  geometry::PiecewiseCubic crossfall_left, crossfall_right;
  LateralShape shape;
  SurfaceStrips strips;
  std::vector<LaneSection> sections;
  std::vector<SignalRecord> signals;
  std::vector<SignalReference> signal_references;
  std::vector<ObjectRecord> objects;
  std::vector<ObjectReference> object_references;
  std::vector<Structure> structures;
};

struct JunctionConnection {
  pugi::xml_node node;
  bool is_broken = false;  ///< a lane of it is no number: no connection of the map
  std::string incoming_road, connecting_road;
  bool direct = false;  ///< linkedRoad of a direct junction
  ContactPoint contact = ContactPoint::start;
  std::vector<std::pair<int, int>> lane_links;     ///< from incoming, to connecting
  std::optional<RoadLink> predecessor, successor;  ///< of a virtual connection, without a road
  long line = 0;
};

/// Which of two roads has to give way.
struct JunctionPriority {
  std::string high_road, low_road;
};

struct JunctionController {
  std::string controller_id, sequence;
};

struct JunctionRecord {
  pugi::xml_node node;
  std::string id, name;
  JunctionKind kind = JunctionKind::common;
  std::vector<JunctionConnection> connections;
  std::vector<JunctionPriority> priorities;
  std::vector<JunctionController> controllers;
};

struct Document {
  std::string version;  ///< "1.4"
  std::string crs;
  CrsOffset offset_in_crs;
  Eigen::Vector2d origin_in_source{0, 0};
  std::vector<RoadRecord> roads;
  std::vector<JunctionRecord> junctions;
  std::vector<Controller> controllers;
  std::vector<ImportDiagnostic> remarks;
  std::vector<UnusedContent> unused;
  std::optional<InputError> refusal;  ///< the first fault that makes it unusable as a map
};

}  // namespace roadbed::map::opendrive
