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
    first_ = section_at_start();
    last_ = section_before(shape_, part_.to_m);
    for (std::size_t i = first_; i <= last_; ++i) add_section(i);
    return text_ + "</lanes>\n";
  }

 private:
  template <typename... Values>
  void add(fmt::format_string<Values...> words, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), words, std::forward<Values>(values)...);
  }

  std::size_t section_at_start() const {
    return part_.from_m <= 0.0 ? 0 : section_before(shape_, part_.from_m);
  }

  double begin_m(std::size_t section) const {
    return std::max(part_.from_m, shape_.sections[section].s_m);
  }
  double end_m(std::size_t section) const {
    return section == last_ ? part_.to_m : shape_.sections[section + 1].s_m;
  }

  void add_section(std::size_t index) {
    const PlannedSection& section = road_.sections[index];
    add("<laneSection s=\"{}\">\n", short_number(begin_m(index) - part_.from_m));
    if (section.left_lanes > 0) {
      text_ += "<left>\n";
      for (std::size_t i = 0; i < section.left_lanes; ++i) add_lane(index, i);
      text_ += "</left>\n";
    }
    add("<center><lane id=\"0\" type=\"none\">{}</lane></center>\n",
        marks(index, section.left_lanes));
    if (section.left_lanes < section.lanes.size()) {
      text_ += "<right>\n";
      for (std::size_t i = section.left_lanes; i < section.lanes.size(); ++i) add_lane(index, i);
      text_ += "</right>\n";
    }
    text_ += "</laneSection>\n";
  }

  std::string marks(std::size_t section, std::size_t border) const {
    return marks_text(road_map_, road_.sections[section], shape_.sections[section], border,
                      begin_m(section), end_m(section), minor_);
  }

  void add_lane(std::size_t section, std::size_t place) {
    const PlannedSection& planned = road_.sections[section];
    const bool is_left = place < planned.left_lanes;
    const Lane& lane = road_map_.lane(planned.lanes[place].lane);
    if (std::ranges::find(part_.bare_lanes, place) != part_.bare_lanes.end()) {
      add("<lane id=\"{}\" type=\"none\">", lane_id(planned, place));
      add_widths(section, place);
      text_ += "</lane>\n";
      return;
    }
    add("<lane id=\"{}\" type=\"{}\"{}>", lane_id(planned, place), type_word(lane, minor_),
        direction(lane, planned.lanes[place].forward, is_left));
    add_links(section, place);
    add_widths(section, place);
    text_ += marks(section, is_left ? place : place + 1);
    add_speeds(section, place, lane);
    add_access(lane);
    text_ += "</lane>\n";
  }

  void add_widths(std::size_t section, std::size_t place) {
    add_records(shape_.sections[section].widths[place], begin_m(section), end_m(section),
                begin_m(section), "width", "sOffset", text_);
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
        section == first_ ? joined(0, place) : inside(section, place, section - 1, false);
    const std::vector<int> after =
        section == last_ ? joined(1, place) : inside(section, place, section + 1, true);
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
    const PlannedLane& lane = road_.sections[section].lanes[place];
    const LaneLinks& links = road_map_.graph().of(lane.lane);
    const auto& next = lane.forward == ahead ? links.successors : links.predecessors;
    std::vector<int> ids;
    const auto& lanes = road_.sections[other].lanes;
    const double s_m = shape_.sections[std::max(section, other)].s_m;
    if (!shape_.sections[section].has_width(place, s_m)) return ids;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const bool is_linked = std::find(next.begin(), next.end(), lanes[i].lane) != next.end();
      if (is_linked && shape_.sections[other].has_width(i, s_m)) {
        ids.push_back(lane_id(road_.sections[other], i));
      }
    }
    return ids;
  }

  void add_speeds(std::size_t section, std::size_t place, const Lane& lane) {
    std::vector<double> from_m;
    for (const SpeedLimit& limit : lane.speed_limits) from_m.push_back(limit.from_s_m);
    const auto limits =
        along_road(shape_.sections[section], place, road_.sections[section].lanes[place].forward,
                   lane.length_m(), from_m, lane.speed_limits);
    for (std::size_t i = 0; i < limits.size(); ++i) {
      const double begin = begin_m(section), end = end_m(section);
      const double next = i + 1 < limits.size() ? limits[i + 1].s_m : end;
      if (!limits[i].value.limit_mps || limits[i].s_m >= end - 1e-3 || next <= begin + 1e-3)
        continue;
      add("<speed sOffset=\"{}\" max=\"{}\" unit=\"m/s\"/>",
          short_number(std::max(0.0, limits[i].s_m - begin)), *limits[i].value.limit_mps);
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
  std::size_t first_ = 0, last_ = 0;
  std::string text_;
};

}  // namespace

std::string lanes_text(const RoadMap& road_map, const PlannedRoad& road, const RoadShape& shape,
                       const RoadPart& part, bool left_hand_traffic, int minor,
                       LaneLosses& losses) {
  return LanesWriter(road_map, road, shape, part, left_hand_traffic, minor, losses).write();
}

}  // namespace roadbed::map::opendrive
