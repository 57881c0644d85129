#include "roadbed/tools/support/place.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "roadbed/geometry/angle.h"
#include "roadbed/map/input_error.h"

namespace roadbed::tools {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMetresPerRadian = 2.0;
constexpr double kSearch_m = 100.0;  // to say how far off the road a point is
constexpr std::string_view kLane = "lane:";
constexpr const char* kForms = "X,Y or X,Y,HEADING or lane:NAME or lane:NAME@S";

class Finder {
 public:
  Finder(const map::RoadMap& road_map, std::string_view text, const PlaceOrigin& origin)
      : road_map_(road_map), text_(text), origin_(origin) {}

  Place find() const {
    return text_.starts_with(kLane) ? on_lane(text_.substr(kLane.size())) : at_point(numbers());
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& needed,
                           const std::string& remedy) const {
    throw map::InputError({.file = origin_.file,
                           .place = origin_.pointer,
                           .element = fmt::format("place \"{}\"", text_),
                           .found = found,
                           .needed = needed,
                           .remedy = remedy});
  }

  std::optional<double> number(std::string_view word) const {
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) {
      return std::nullopt;
    }
    return value;
  }

  std::vector<double> numbers() const {
    std::vector<double> values;
    std::string_view rest = text_;
    while (true) {
      const std::size_t comma = rest.find(',');
      const std::optional<double> value = number(rest.substr(0, comma));
      if (!value) refuse("is not a place", kForms, "write it like that");
      values.push_back(*value);
      if (comma == std::string_view::npos) break;
      rest.remove_prefix(comma + 1);
    }
    if (values.size() < 2 || values.size() > 3) {
      refuse("is not a place", kForms, "write it like that");
    }
    return values;
  }

  Place on_lane(std::string_view rest) const {
    const std::size_t at = rest.rfind('@');
    const std::string_view lane_name = rest.substr(0, at);
    const std::optional<map::LaneId> id = road_map_.find_lane(lane_name);
    if (!id) refuse("no lane has this name", "one", "list the lanes with: roadbed info");
    const map::Lane& lane = road_map_.lane(*id);
    double s_m = 0.0;
    if (at != std::string_view::npos) {
      const std::optional<double> station = number(rest.substr(at + 1));
      if (!station) refuse("the station is no number", kForms, "write it like that");
      s_m = *station;
    }
    if (s_m < 0.0 || s_m > lane.length_m()) {
      refuse("the station is not on the lane", fmt::format("0 to {:.3f} m", lane.length_m()),
             "change it");
    }
    return {.on_lane = {.lane = *id, .s_m = s_m}, .map_from_vehicle = lane.pose_at(s_m)};
  }

  Place at_point(const std::vector<double>& values) const {
    const Eigen::Vector2d point = road_map_.to_map({values[0], values[1]});
    std::optional<double> heading;
    if (values.size() == 3) heading = values[2] * kDegree;
    const std::vector<map::LaneMatch> near = road_map_.locate(point, kMostOffLane_m, true);
    const map::LaneMatch* best = choose(near, heading);
    if (best == nullptr) refuse_point(point, near, heading);
    return {.on_lane = best->place,
            .map_from_vehicle = {point.x(), point.y(), heading.value_or(best->heading_rad)}};
  }

  static const map::LaneMatch* choose(const std::vector<map::LaneMatch>& near,
                                      const std::optional<double>& heading) {
    if (!heading) return near.empty() ? nullptr : &near.front();
    const map::LaneMatch* best = nullptr;
    double least = 0.0;
    for (const map::LaneMatch& match : near) {
      const double off = std::abs(geometry::wrap_angle(match.heading_rad - *heading));
      const double aside = match.distance_m > 0.0 ? match.distance_m : 0.0;
      const double cost = aside + kMetresPerRadian * off;
      if (off >= 0.5 * std::numbers::pi || (best != nullptr && cost >= least)) continue;
      best = &match;
      least = cost;
    }
    return best;
  }

  [[noreturn]] void refuse_point(const Eigen::Vector2d& point,
                                 const std::vector<map::LaneMatch>& near,
                                 const std::optional<double>& heading) const {
    if (heading && !near.empty()) {
      const map::Lane& lane = road_map_.lane(near.front().place.lane);
      refuse(fmt::format("the heading is against every lane there; lane {} has {:.0f}°", lane.name,
                         near.front().heading_rad / kDegree),
             "less than 90° between them", "turn it or leave it out");
    }
    const std::vector<map::LaneMatch> far = road_map_.locate(point, kSearch_m, true);
    refuse(far.empty()
               ? fmt::format("no drivable lane within {:.0f} m", kSearch_m)
               : fmt::format("{:.1f} m off the nearest drivable lane, {}", far.front().distance_m,
                             road_map_.lane(far.front().place.lane).name),
           fmt::format("at most {:.0f} m", kMostOffLane_m), "move it onto the road");
  }

  const map::RoadMap& road_map_;
  std::string_view text_;
  const PlaceOrigin& origin_;
};

}  // namespace

Place find_place(const map::RoadMap& road_map, std::string_view text, const PlaceOrigin& origin) {
  return Finder(road_map, text, origin).find();
}

}  // namespace roadbed::tools
