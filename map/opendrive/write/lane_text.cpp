#include "roadbed/map/opendrive/write/lane_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "roadbed/map/opendrive/values.h"
#include "roadbed/map/opendrive/write/border_marks.h"
#include "roadbed/map/opendrive/write/number_text.h"

namespace roadbed::map::opendrive {
namespace {

constexpr double kInside_m = 1e-6, kNoWidth_m = 0.01;

std::string_view type_word(const Lane& lane, int minor) {
  if (!lane.one_way && minor < 8 && lane.type == LaneType::driving) return "bidirectional";
  if (lane.type == LaneType::other) return "special1";
  const bool is_new = lane.type == LaneType::connecting_ramp || lane.type == LaneType::bus ||
                      lane.type == LaneType::taxi || lane.type == LaneType::curb;
  if (is_new && minor < 5) return lane.type == LaneType::curb ? "border" : "driving";
  return to_string(lane.type);
}

constexpr std::array<std::pair<Participant, std::string_view>, 8> kUsers = {{
    {Participant::pedestrian, "pedestrian"},
    {Participant::bicycle, "bicycle"},
    {Participant::motorcycle, "motorcycle"},
    {Participant::car, "passengerCar"},
    {Participant::taxi, "taxi"},
    {Participant::bus, "bus"},
    {Participant::truck, "truck"},
    {Participant::emergency, "emergency"},
}};

class LanesWriter {
 public:
  LanesWriter(const RoadMap& road_map, const PlannedRoad& road, const RoadShape& shape,
              const RoadPart& part, bool left_hand_traffic, int minor, LaneLosses& losses)
      : road_map_(road_map),
        road_(road),
        shape_(shape),
        part_(part),
        left_hand_(left_hand_traffic),
        minor_(minor),
        losses_(losses) {}

  std::string write() {
    text_ = "<lanes>\n";
    add_records(shape_.lane_offset, part_.from_m, part_.to_m, part_.from_m, "laneOffset", "s",
                text_);
    for (const WrittenSection& section : written_sections(shape_)) {
      WrittenSection part = section;
      part.from_m = std::max(part.from_m, part_.from_m);
      part.to_m = std::min(part.to_m, part_.to_m);
      if (part.to_m > part.from_m + 1e-6) sections_.push_back(part);
    }
    for (std::size_t i = 0; i < sections_.size(); ++i) add_section(i);
    return text_ + "</lanes>\n";
  }

 private:
  template <typename... Values>
  void add(fmt::format_string<Values...> words, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), words, std::forward<Values>(values)...);
  }

  const PlannedSection& planned(const WrittenSection& section) const {
    return road_.sections[section.planned];
  }

  void add_section(std::size_t index) {
    const WrittenSection& section = sections_[index];
    const std::size_t middle = planned(section).left_lanes;
    const auto [first, behind] = written_lanes(section);
    add("<laneSection s=\"{}\">\n", short_number(section.from_m - part_.from_m));
    if (first < middle) {
      text_ += "<left>\n";
      for (std::size_t i = first; i < middle; ++i) add_lane(index, i);
      text_ += "</left>\n";
    }
    add("<center><lane id=\"0\" type=\"none\">{}</lane></center>\n", marks(section, middle));
    if (middle < behind) {
      text_ += "<right>\n";
      for (std::size_t i = middle; i < behind; ++i) add_lane(index, i);
      text_ += "</right>\n";
    }
    text_ += "</laneSection>\n";
  }

  // All lanes, but in a rim not those outside that have ended; at least one.
  std::pair<std::size_t, std::size_t> written_lanes(const WrittenSection& section) const {
    const std::size_t middle = planned(section).left_lanes, count = planned(section).lanes.size();
    std::size_t first = 0, behind = count;
    while (first < middle && !is_seen(section, first)) ++first;
    while (behind > middle && !is_seen(section, behind - 1)) --behind;
    if (first < behind) return {first, behind};
    return middle < count ? std::pair{middle, middle + 1} : std::pair{middle - 1, middle};
  }

  bool is_seen(const WrittenSection& section, std::size_t place) const {
    return section.has_lane(place) ||
           section.shape->has_width(place, 0.5 * (section.from_m + section.to_m));
  }

  std::string marks(const WrittenSection& section, std::size_t border) const {
    const bool is_there = (border > 0 && section.has_lane(border - 1)) ||
                          (border < planned(section).lanes.size() && section.has_lane(border));
    if (!is_there) return {};
    return marks_text(road_map_, planned(section), shape_.sections[section.planned], border,
                      section.from_m, section.to_m, minor_);
  }

  void add_lane(std::size_t index, std::size_t place) {
    const WrittenSection& section = sections_[index];
    const PlannedSection& planned = this->planned(section);
    const bool is_left = place < planned.left_lanes;
    const Lane& lane = road_map_.lane(planned.lanes[place].lane);
    if (!section.has_lane(place) ||
        std::ranges::find(part_.bare_lanes, place) != part_.bare_lanes.end()) {
      add("<lane id=\"{}\" type=\"none\">", lane_id(planned, place));
      add_widths(section, place);
      text_ += "</lane>\n";
      return;
    }
    add("<lane id=\"{}\" type=\"{}\"{}>", lane_id(planned, place), type_word(lane, minor_),
        direction(lane, planned.lanes[place].forward, is_left));
    add_links(index, place);
    add_widths(section, place);
    text_ += marks(section, is_left ? place : place + 1);
    add_speeds(section, place, lane);
    add_access(lane);
    add_heights(section, place);
    text_ += "</lane>\n";
  }

  void add_widths(const WrittenSection& section, std::size_t place) {
    const geometry::PiecewiseCubic& widths = section.shape->widths[place];
    const auto add_from = [&](double from_m, double to_m) {
      add_records(widths, from_m, to_m, section.from_m, "width", "sOffset", text_);
    };
    // SUMO's netconvert looks at widths where records begin only, and drops a lane that has none
    // there: one that opens over a single record gets it as two.
    const double middle_m = 0.5 * (section.from_m + section.to_m);
    const bool is_single =
        widths.record_at(section.from_m) == widths.record_at(section.to_m - kInside_m);
    const bool opens = is_single && widths.at(section.from_m).value < kNoWidth_m &&
                       widths.at(middle_m).value > kNoWidth_m;
    add_from(section.from_m, opens ? middle_m : section.to_m);
    if (opens) add_from(middle_m, section.to_m);
  }

  std::string direction(const Lane& lane, bool forward, bool is_left) {
    const bool usual = forward == (is_left == left_hand_);
    if (lane.one_way && usual) return {};
    if (minor_ >= 8) return lane.one_way ? " direction=\"reversed\"" : " direction=\"both\"";
    if (lane.one_way || lane.type != LaneType::driving) ++losses_.direction;
    return {};
  }

  void add_links(std::size_t section, std::size_t place) {
    const std::vector<int> before =
        section == 0 ? joined(0, place) : inside(section, place, section - 1, false);
    const std::vector<int> after = section + 1 == sections_.size()
                                       ? joined(1, place)
                                       : inside(section, place, section + 1, true);
    if (before.empty() && after.empty()) return;
    text_ += "<link>";
    for (const int id : before) add("<predecessor id=\"{}\"/>", id);
    for (const int id : after) add("<successor id=\"{}\"/>", id);
    text_ += "</link>";
  }

  // To lanes of another road; a junction says it by its connections.
  std::vector<int> joined(std::size_t end, std::size_t place) const {
    std::vector<int> ids;
    if (!part_.links[end] || part_.links[end]->to_junction) return ids;
    for (const auto& [lane, id] : part_.lane_links[end]) {
      if (lane == place) ids.push_back(id);
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
  }

  // To lanes of the section beside in the same road.
  std::vector<int> inside(std::size_t section, std::size_t place, std::size_t other,
                          bool ahead) const {
    const WrittenSection &here = sections_[section], &there = sections_[other];
    const PlannedLane& lane = planned(here).lanes[place];
    if (here.planned == there.planned) {  // one of them is a rim
      return there.has_lane(place) ? std::vector{lane_id(planned(here), place)}
                                   : std::vector<int>{};
    }
    const LaneLinks& links = road_map_.graph().of(lane.lane);
    const auto& next = lane.forward == ahead ? links.successors : links.predecessors;
    std::vector<int> ids;
    const auto& lanes = planned(there).lanes;
    const double s_m = std::max(here.from_m, there.from_m);
    if (!here.shape->has_width(place, s_m)) return ids;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const bool is_linked = std::find(next.begin(), next.end(), lanes[i].lane) != next.end();
      if (is_linked && there.shape->has_width(i, s_m)) {
        ids.push_back(lane_id(planned(there), i));
      }
    }
    return ids;
  }

  void add_speeds(const WrittenSection& section, std::size_t place, const Lane& lane) {
    std::vector<double> from_m;
    for (const SpeedLimit& limit : lane.speed_limits) from_m.push_back(limit.from_s_m);
    const auto limits =
        along_road(shape_.sections[section.planned], place, planned(section).lanes[place].forward,
                   lane.length_m(), from_m, lane.speed_limits);
    for (std::size_t i = 0; i < limits.size(); ++i) {
      const double begin = section.from_m, end = section.to_m;
      const double next = i + 1 < limits.size() ? limits[i + 1].s_m : end;
      if (!limits[i].value.limit_mps || limits[i].s_m >= end - 1e-3 || next <= begin + 1e-3)
        continue;
      const double limit_mps = *limits[i].value.limit_mps;
      add("<speed sOffset=\"{}\" {}/>", short_number(std::max(0.0, limits[i].s_m - begin)),
          std::isfinite(limit_mps) ? fmt::format("max=\"{}\" unit=\"m/s\"", limit_mps)
                                   : "max=\"no limit\"");
    }
  }

  void add_heights(const WrittenSection& section, std::size_t place) {
    const auto& records = shape_.sections[section.planned].heights[place];
    for (std::size_t i = 0; i < records.size(); ++i) {
      const bool is_before = i + 1 < records.size() && records[i + 1].s_m <= section.from_m;
      if (is_before || records[i].s_m >= section.to_m) continue;
      add("<height sOffset=\"{}\" inner=\"{}\" outer=\"{}\"/>",
          short_number(std::max(0.0, records[i].s_m - section.from_m)),
          short_number(records[i].inner_m), short_number(records[i].outer_m));
    }
  }

  // Who may use the lane, where its type does not say it.
  void add_access(const Lane& lane) {
    const Participants usual = participants_of(lane.type), named = lane.participants;
    if (named == usual) return;
    if (minor_ < 8) {
      ++losses_.access;
      return;
    }
    const bool allows = std::any_of(kUsers.begin(), kUsers.end(),
                                    [&](const auto& user) { return named.has(user.first); });
    for (const auto& [kind, word] : kUsers) {
      if (!(allows ? named : usual).has(kind)) continue;
      add("<access sOffset=\"0\" rule=\"{}\" restriction=\"{}\"/>", allows ? "allow" : "deny",
          word);
    }
  }

  const RoadMap& road_map_;
  const PlannedRoad& road_;
  const RoadShape& shape_;
  const RoadPart& part_;
  bool left_hand_;
  int minor_;
  LaneLosses& losses_;
  std::vector<WrittenSection> sections_;  // of the part
  std::string text_;
};

}  // namespace

std::string lanes_text(const RoadMap& road_map, const PlannedRoad& road, const RoadShape& shape,
                       const RoadPart& part, bool left_hand_traffic, int minor,
                       LaneLosses& losses) {
  return LanesWriter(road_map, road, shape, part, left_hand_traffic, minor, losses).write();
}

}  // namespace roadbed::map::opendrive
