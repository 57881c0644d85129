#include "roadbed/map/opendrive/furniture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string>

namespace roadbed::map::opendrive {
namespace {

constexpr std::string_view kStopLineSignal = "294";

// "StopLine", "stop_line", "Stop line"
bool says_stop_line(std::string_view word) {
  std::string letters;
  for (const char c : word) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return letters.starts_with("stopline");
}

// A line through the corners along their longest extent.
std::vector<Eigen::Vector3d> longest_extent(const std::vector<Eigen::Vector3d>& corners) {
  if (corners.size() < 2) return {};
  Eigen::Vector3d centre(0, 0, 0);
  for (const Eigen::Vector3d& corner : corners) centre += corner;
  centre /= static_cast<double>(corners.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector3d& corner : corners) {
    const Eigen::Vector2d off = (corner - centre).head<2>();
    spread += off * off.transpose();
  }
  // Direction of the greater eigenvalue of a symmetric 2×2 matrix.
  const double angle_rad = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
  const Eigen::Vector2d along(std::cos(angle_rad), std::sin(angle_rad));
  double least_m = 0.0, greatest_m = 0.0;
  for (const Eigen::Vector3d& corner : corners) {
    const double at_m = along.dot((corner - centre).head<2>());
    least_m = std::min(least_m, at_m);
    greatest_m = std::max(greatest_m, at_m);
  }
  const Eigen::Vector3d direction(along.x(), along.y(), 0.0);
  return {centre + least_m * direction, centre + greatest_m * direction};
}

class StopLineFinder {
 public:
  StopLineFinder(const Document& document, std::span<const RoadFrame> frames,
                 const BuiltLanes& built, const std::vector<Signal>& signals, PointBudget& budget,
                 std::vector<ImportDiagnostic>& remarks)
      : document_(document), frames_(frames), built_(built), budget_(budget), remarks_(remarks) {
    for (const Signal& signal : signals) {
      const bool stops = signal.dynamic || signal.type == "205" || signal.type == "206";
      if (!stops) continue;
      for (const LaneId lane : signal.lanes) stopping_[lane].push_back(&signal.source_id);
    }
  }

  std::vector<StopLine> find() {
    for (std::size_t road = 0; road < document_.roads.size(); ++road) {
      for (const ObjectRecord& record : document_.roads[road].objects) {
        if (says_stop_line(record.type) || says_stop_line(record.subtype) ||
            says_stop_line(record.name)) {
          add(road, record);
        }
      }
      for (const SignalRecord& record : document_.roads[road].signals) {
        if (record.type == kStopLineSignal) add(road, record);
      }
    }
    return std::move(stop_lines_);
  }

 private:
  void add(std::size_t road, const ObjectRecord& record) {
    StopLine line;
    line.source_id = record.id;
    line.in_map = longest_extent(corners(road, record));
    line.lanes = lanes(road, record.s_m, record.orientation, record.lanes, line.in_map);
    keep({road, "object", record.line}, std::move(line), {});
  }

  std::vector<Eigen::Vector3d> corners(std::size_t road, const ObjectRecord& record) const {
    if (!record.outlines.empty()) {
      return outline_in_map(frames_[road], record, record.outlines.front());
    }
    const double u = 0.5 * record.length_m, v = 0.5 * record.width_m;
    return outline_in_map(
        frames_[road], record,
        {true,
         {{false, -u, -v, 0.0}, {false, u, -v, 0.0}, {false, u, v, 0.0}, {false, -u, v, 0.0}}});
  }

  void add(std::size_t road, const SignalRecord& record) {
    constexpr double usual_width_m = 3.0;
    const double half_m = 0.5 * (record.width_m > 0.0 ? record.width_m : usual_width_m);
    StopLine line;
    line.source_id = record.id;
    for (const double t_m : {record.t_m + half_m, record.t_m - half_m}) {
      line.in_map.push_back(frames_[road].at(record.s_m, t_m, record.z_offset_m));
    }
    line.lanes = lanes(road, record.s_m, record.orientation, record.lanes, line.in_map);
    keep({road, "signal", 0}, std::move(line), record.dependencies);
  }

  // Where the file has it.
  struct Place {
    std::size_t road;
    const char* kind;
    long line;
  };

  void keep(const Place& place, StopLine line, const std::vector<std::string>& dependencies) {
    if (line.in_map.size() < 2 ||
        !std::all_of(line.in_map.begin(), line.in_map.end(), is_placeable)) {
      return;  // the object or signal itself is remarked where it is placed
    }
    std::size_t points = PointBudget::kPerThing + line.lanes.size();
    for (const LaneId lane : line.lanes) {
      const auto found = stopping_.find(lane);
      if (found != stopping_.end()) points += 1 + found->second.size();
    }
    if (!budget_.try_to_spend(points)) {
      remarks_.push_back({std::string("import.") + place.kind, true,
                          fmt::format("{} {} of road {}", place.kind, line.source_id,
                                      document_.roads[place.road].id),
                          place.line,
                          "is a stop line of more lanes and signals than a map of this size can "
                          "hold; it is left out"});
      return;
    }
    line.signals = dependencies;
    for (const LaneId lane : line.lanes) {
      const auto found = stopping_.find(lane);
      if (found == stopping_.end()) continue;
      for (const std::string* signal : found->second) line.signals.push_back(*signal);
    }
    std::sort(line.signals.begin(), line.signals.end());
    line.signals.erase(std::unique(line.signals.begin(), line.signals.end()), line.signals.end());
    stop_lines_.push_back(std::move(line));
  }

  // Those that the file names; without that, those whose middle the line crosses, if possible of
  // the way that the file says.
  std::vector<LaneId> lanes(std::size_t road, double s_m, char orientation,
                            const LaneRanges& ranges,
                            const std::vector<Eigen::Vector3d>& line) const {
    const RoadRecord& record = document_.roads[road];
    if (!ranges.empty() || line.size() < 2) {
      return addressed_lanes(record, road, built_, s_m, orientation, ranges);
    }
    const auto facing =
        crossed(addressed_lanes(record, road, built_, s_m, orientation, {}), s_m, line);
    if (!facing.empty()) return facing;
    return crossed(addressed_lanes(record, road, built_, s_m, 0, {}), s_m, line);
  }

  std::vector<LaneId> crossed(const std::vector<LaneId>& candidates, double s_m,
                              const std::vector<Eigen::Vector3d>& line) const {
    const Eigen::Vector2d from = line.front().head<2>();
    const Eigen::Vector2d along = line.back().head<2>() - from;
    std::vector<LaneId> lanes;
    for (const LaneId id : candidates) {
      const Lane& lane = built_.lanes[id.index];
      const Eigen::Vector2d middle = Lane::point_at(lane.centre, built_.station_m(id, s_m)) - from;
      const double fraction = middle.dot(along) / along.squaredNorm();
      if (fraction >= 0.0 && fraction <= 1.0) lanes.push_back(id);
    }
    return lanes;
  }

  const Document& document_;
  std::span<const RoadFrame> frames_;
  const BuiltLanes& built_;
  PointBudget& budget_;
  std::vector<ImportDiagnostic>& remarks_;
  std::map<LaneId, std::vector<const std::string*>> stopping_;
  std::vector<StopLine> stop_lines_;
};

}  // namespace

std::vector<StopLine> find_stop_lines(const Document& document, std::span<const RoadFrame> frames,
                                      const BuiltLanes& built, const std::vector<Signal>& signals,
                                      PointBudget& budget, std::vector<ImportDiagnostic>& remarks) {
  return StopLineFinder(document, frames, built, signals, budget, remarks).find();
}

}  // namespace roadbed::map::opendrive
