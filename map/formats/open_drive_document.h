#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/piecewise_cubic.h"
#include "roadbed/geometry/plan_view.h"
#include "roadbed/map/formats/xml.h"
#include "roadbed/map/lane.h"
#include "roadbed/map/road_map.h"

/// What an OpenDRIVE file says, element by element, before it becomes a RoadMap. Names follow the
/// standard (ASAM OpenDRIVE 1.4–1.8).
namespace roadbed::map::open_drive {

enum class ContactPoint { start, end };

/// <predecessor>/<successor> of a road.
struct RoadLink {
  bool to_junction = false;
  std::string element_id;
  std::optional<ContactPoint> contact;
};

struct RoadMark {
  double s_offset_m = 0.0;
  std::string type;
  std::string lane_change;  ///< "both", "increase", "decrease", "none", or empty
};

struct LaneSpeed {
  double s_offset_m = 0.0;
  std::optional<double> limit_mps;
};

/// <height>: how far the lane's inner and outer border stand above the road's surface.
struct LaneHeight {
  double s_offset_m = 0.0, inner_m = 0.0, outer_m = 0.0;
};

struct LaneRecord {
  int id = 0;
  LaneType type = LaneType::none;
  std::string direction;  ///< 1.8: "standard", "reversed", "both", or empty
  long line = 0;
  std::vector<int> predecessors, successors;
  geometry::PiecewiseCubic width, border;  ///< by the road's s, not the section's
  std::vector<RoadMark> marks;
  std::vector<LaneSpeed> speeds;
  std::vector<LaneHeight> heights;
};

/// Lanes by id: left ones positive, the centre 0, right ones negative. A single-sided section
/// says nothing of the other side, where the section before goes on.
struct LaneSection {
  double s_m = 0.0;
  bool single_side = false;
  long line = 0;
  std::map<int, LaneRecord> lanes;
};

struct RoadSpeed {
  double s_m = 0.0;
  std::optional<double> limit_mps;
};

struct RoadRecord {
  std::string id, name;
  std::string junction_id;  ///< empty if it is not a connecting road
  double length_m = 0.0;
  bool left_hand_traffic = false;
  long line = 0;
  std::optional<RoadLink> predecessor, successor;
  std::vector<RoadSpeed> speeds;
  std::vector<geometry::PlanPiece> plan_pieces;  ///< relative to Document::origin_in_source
  geometry::PiecewiseCubic elevation, superelevation, lane_offset;
  geometry::PiecewiseCubic crossfall_left, crossfall_right;
  std::vector<LaneSection> sections;
};

struct JunctionConnection {
  std::string incoming_road, connecting_road;
  bool direct = false;  ///< linkedRoad of a direct junction
  ContactPoint contact = ContactPoint::start;
  std::vector<std::pair<int, int>> lane_links;  ///< from incoming, to connecting
  long line = 0;
};

struct JunctionRecord {
  std::string id, name;
  std::vector<JunctionConnection> connections;
};

struct SignalRecord {
  std::string id, name, road_id;
  double s_m = 0.0, t_m = 0.0;
  std::string country, type, subtype, unit;
  std::optional<double> value;
  bool dynamic = false;
  std::string orientation;                                 ///< "+", "-" or "none"
  std::vector<std::pair<int, int>> lane_ranges;            ///< from, to; empty: all lanes
  std::vector<std::pair<std::string, double>> references;  ///< roads and s it also speaks to
};

struct Document {
  std::string version;  ///< "1.4"
  std::string crs;
  Eigen::Vector2d origin_in_source{0, 0};
  std::vector<RoadRecord> roads;
  std::vector<JunctionRecord> junctions;
  std::vector<SignalRecord> signals;
  std::vector<ImportRemark> remarks;
};

/// Whether an XML document with this root element is OpenDRIVE.
bool is_open_drive(const std::string& root_element);

/// @throws InputError if it is not an OpenDRIVE document with at least one usable road.
Document read_document(const XmlDocument& xml);

}  // namespace roadbed::map::open_drive
