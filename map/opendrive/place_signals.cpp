#include "roadbed/map/opendrive/furniture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string_view>

namespace roadbed::map::opendrive {
namespace {

double normalized(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

class SignalPlacer {
 public:
  SignalPlacer(const Document& document, std::span<const RoadFrame> frames, const BuiltLanes& built,
               PointBudget& budget, std::vector<ImportDiagnostic>& remarks)
      : document_(document), frames_(frames), built_(built), budget_(budget), remarks_(remarks) {
    std::size_t parts = built.lanes.size();
    for (std::size_t i = 0; i < document.roads.size(); ++i) {
      const RoadRecord& road = document.roads[i];
      road_index_.emplace(road.id, i);
      parts += road.signals.size() + road.signal_references.size();
      std::size_t most = 0;
      for (const LaneSection& section : road.sections) most = std::max(most, section.lanes.size());
      most_lanes_.push_back(most);
    }
    steps_ = geometry::WorkBudget(geometry::most_steps(parts));
  }

  std::vector<Signal> place() {
    for (std::size_t road = 0; road < document_.roads.size(); ++road) {
      for (const SignalRecord& record : document_.roads[road].signals) add(road, record);
    }
    for (std::size_t road = 0; road < document_.roads.size(); ++road) {
      for (const SignalReference& reference : document_.roads[road].signal_references) {
        refer(road, reference);
      }
    }
    for (Signal& signal : signals_) name_lanes_once(signal);
    return std::move(signals_);
  }

 private:
  // Lanes in order, each once, with the first station that was given for it.
  static void name_lanes_once(Signal& signal) {
    std::vector<std::pair<LaneId, double>> places;
    for (std::size_t i = 0; i < signal.lanes.size(); ++i) {
      places.emplace_back(signal.lanes[i], signal.lane_s_m[i]);
    }
    const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
    std::stable_sort(places.begin(), places.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    places.erase(std::unique(places.begin(), places.end(), same), places.end());
    signal.lanes.clear();
    signal.lane_s_m.clear();
    for (const auto& [lane, s_m] : places) {
      signal.lanes.push_back(lane);
      signal.lane_s_m.push_back(s_m);
    }
  }

  void add(std::size_t road, const SignalRecord& record) {
    Signal signal;
    const Eigen::Vector3d in_map = place_of(road, record, signal);
    if (!is_placeable(in_map)) {
      fault("signal " + record.id, document_.roads[road].line,
            "stands where no map reaches; it is left out, correct its s, t and zOffset");
      return;
    }
    signal.source_id = record.id;
    signal.name = record.name;
    signal.road = RoadId{static_cast<std::uint32_t>(road)};
    signal.road_s_m = record.s_m;
    signal.road_t_m = record.t_m;
    signal.in_map = in_map.head<2>();
    signal.z_m = in_map.z();
    signal.country = record.country;
    signal.type = record.type;
    signal.subtype = record.subtype;
    signal.value = record.value;
    signal.unit = record.unit;
    signal.text = record.text;
    signal.dynamic = record.dynamic;
    signal.attributes = record.attributes;
    speak_to(road, record.s_m, record.orientation, record.lanes, document_.roads[road].line,
             signal);
    index_.emplace(record.id, signals_.size());
    signals_.push_back(std::move(signal));
  }

  // Where it stands, and by that the way it faces: towards the traffic that it speaks to. A heading
  // of the file is that of the traffic.
  Eigen::Vector3d place_of(std::size_t road, const SignalRecord& record, Signal& signal) const {
    double heading_rad = record.heading_offset_rad;
    Eigen::Vector3d in_map;
    if (record.inertial) {
      const auto& place = *record.inertial;
      in_map = {place.x_m - document_.origin_in_source.x(),
                place.y_m - document_.origin_in_source.y(), place.z_m};
      signal.heading_rad = normalized(place.heading_rad + std::numbers::pi);
      return in_map;
    }
    const auto other =
        record.on_road ? road_index_.find(record.on_road->road_id) : road_index_.end();
    if (other != road_index_.end()) {
      const auto& place = *record.on_road;
      const RoadFrame& frame = frames_[other->second];
      in_map = frame.at(place.s_m, place.t_m, place.z_offset_m);
      heading_rad = frame.heading_rad(place.s_m) + place.heading_offset_rad;
    } else {
      in_map = frames_[road].at(record.s_m, record.t_m, record.z_offset_m);
      heading_rad += frames_[road].heading_rad(record.s_m);
    }
    const bool faces_both = record.orientation == 0 && record.heading_offset_rad == 0.0;
    const double turn_rad = record.orientation == '-' ? 0.0 : std::numbers::pi;
    if (!faces_both && std::isfinite(heading_rad)) {
      signal.heading_rad = normalized(heading_rad + turn_rad);
    }
    return in_map;
  }

  // What lanes take here is little; what lists each lane of each signal takes much more, which
  // counts where a signal has more lanes than any road.
  static std::size_t points_for(std::size_t lanes) {
    constexpr std::size_t usual = 16;
    return 1 + lanes / 8 + 2 * (std::max(lanes, usual) - usual);
  }

  void speak_to(std::size_t road, double s_m, char orientation, const LaneRanges& ranges, long line,
                Signal& signal) {
    std::vector<LaneId> lanes;
    constexpr std::size_t steps_per_lane = 4;  // to find it by its name
    if (steps_.spend(steps_per_lane * most_lanes_[road])) {
      lanes = addressed_lanes(document_.roads[road], road, built_, s_m, orientation, ranges);
    }
    if (steps_.is_spent() || !budget_.try_to_spend(points_for(lanes.size()))) {
      fault(fmt::format("signal {} of road {}", signal.source_id, document_.roads[road].id), line,
            "the signals speak to more lanes than a map of this size can hold; this one speaks to "
            "none");
      return;
    }
    for (const LaneId lane : lanes) {
      signal.lanes.push_back(lane);
      signal.lane_s_m.push_back(built_.station_m(lane, s_m));
    }
  }

  void refer(std::size_t road, const SignalReference& reference) {
    const auto found = index_.find(reference.signal_id);
    if (found == index_.end()) {
      fault("road " + document_.roads[road].id, reference.line,
            fmt::format("refers to signal {}, which is not there", reference.signal_id));
      return;
    }
    Signal& signal = signals_[found->second];
    speak_to(road, reference.s_m, reference.orientation, reference.lanes, reference.line, signal);
    signal.attributes.emplace_back(
        "signalReference",
        fmt::format("road {}, s {}, t {}", document_.roads[road].id, reference.s_m, reference.t_m));
  }

  void fault(std::string element, long line, std::string message) {
    remarks_.push_back({"import.signal", true, std::move(element), line, std::move(message)});
  }

  const Document& document_;
  std::span<const RoadFrame> frames_;
  const BuiltLanes& built_;
  std::vector<std::size_t> most_lanes_;  // of any section, of each road
  geometry::WorkBudget steps_{0};
  PointBudget& budget_;
  std::vector<ImportDiagnostic>& remarks_;
  std::map<std::string_view, std::size_t> road_index_;
  std::map<std::string_view, std::size_t> index_;
  std::vector<Signal> signals_;
};

}  // namespace

std::vector<Signal> place_signals(const Document& document, std::span<const RoadFrame> frames,
                                  const BuiltLanes& built, PointBudget& budget,
                                  std::vector<ImportDiagnostic>& remarks) {
  return SignalPlacer(document, frames, built, budget, remarks).place();
}

}  // namespace roadbed::map::opendrive
