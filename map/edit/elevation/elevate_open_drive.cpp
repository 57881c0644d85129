#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/geometry/index/box_tree.h"
#include "roadbed/map/edit/elevation/elevate.h"
#include "roadbed/map/edit/elevation/height_network.h"
#include "roadbed/map/edit/elevation/profile_cubics.h"
#include "roadbed/map/edit/elevation/road_stations.h"
#include "roadbed/map/edit/road_cut.h"
#include "roadbed/map/edit/xml_edit.h"
#include "roadbed/map/opendrive/read.h"

namespace roadbed::map::inline edit::inline elevation {
namespace {

using Eigen::Vector2d;

constexpr double kOneEndM = 0.05;    // ends of reference lines this near are one
constexpr double kOneWayRad = 0.1;   // ends that point so alike have one slope across
constexpr double kProfileM = 0.002;  // off the lines that were measured, at the outermost border
constexpr double kLevelM = 5e-4;     // a road that leans less is level

/// A road with what was measured of it.
struct MeasuredRoad {
  const opendrive::RoadRecord* road = nullptr;
  std::vector<RoadStation> stations;
  std::vector<CrossLine> lines;     ///< of the stations
  std::vector<std::size_t> places;  ///< of the stations in the network of heights

  double widest_m() const {
    double widest_m = 1.0;
    for (const RoadStation& station : stations) {
      widest_m = std::max({widest_m, std::abs(station.right_t_m), std::abs(station.left_t_m)});
    }
    return widest_m;
  }
};

class Elevator {
 public:
  explicit Elevator(const opendrive::Document& document) {
    constexpr double kApartM = 2.0, kMostStations = 100'000.0;  // 100 MB
    double length_m = 0.0;
    for (const opendrive::RoadRecord& road : document.roads) length_m += road.length_m;
    const double apart_m = std::max(kApartM, length_m / kMostStations);
    for (const opendrive::RoadRecord& road : document.roads) {
      roads_.push_back({&road, stations_of(road, document.origin_in_source, apart_m), {}, {}});
    }
  }

  void run(const GroundHeights& ground, Edited& result) {
    measure(ground, result);
    meet_at_ends();
    const auto heights_m = find_heights();
    std::size_t on_ground = 0, beside = 0, left = 0;
    for (const MeasuredRoad& road : roads_) {
      const bool is_measured = std::any_of(road.lines.begin(), road.lines.end(),
                                           [](const CrossLine& line) { return line.height_m; });
      ++(is_measured ? on_ground : heights_m[road.places[0]] ? beside : left);
      if (heights_m[road.places[0]]) write(road, heights_m);
    }
    result.count("roads on the ground", on_ground);
    result.count("roads without measured ground, by those that they meet", beside);
    result.count("roads that meet none on the ground, left as they are", left);
    result.count("lateral profiles in place of others", replaced_);
  }

 private:
  void measure(const GroundHeights& ground, Edited& result) {
    std::vector<Vector2d> at;
    for (const MeasuredRoad& road : roads_) {
      for (const RoadStation& station : road.stations) {
        for (std::size_t i = 0; i < RoadStation::kPlaces; ++i) {
          at.push_back(station.place_in_source(station.t_m(i)));
        }
      }
    }
    const std::vector<std::optional<double>> heights_m = ground(at);
    std::size_t next = 0, known = 0, unknown = 0;
    double squares_m2 = 0.0, worst_m = 0.0, count = 0.0;
    for (MeasuredRoad& road : roads_) {
      for (const RoadStation& station : road.stations) {
        std::array<std::optional<double>, RoadStation::kPlaces> across;
        std::copy_n(heights_m.begin() + static_cast<std::ptrdiff_t>(next), across.size(),
                    across.begin());
        next += across.size();
        const CrossLine line = road.lines.emplace_back(station.line_through(across));
        ++(line.height_m ? known : unknown);
        for (std::size_t i = 0; line.height_m && i < across.size(); ++i) {
          if (!across[i]) continue;
          const double off_m =
              *across[i] - *line.height_m - line.slope.value_or(0.0) * station.t_m(i);
          squares_m2 += off_m * off_m, worst_m = std::max(worst_m, std::abs(off_m)), count += 1.0;
        }
      }
    }
    result.count("stations on the ground", known);
    result.count("stations where no ground was measured, by those along the roads", unknown);
    if (known == 0) return;
    result.notes.push_back(fmt::format(
        "roads lean as planes across: the ground is {:.3f} m (root mean square) and at most "
        "{:.3f} m off them",
        std::sqrt(squares_m2 / count), worst_m));
  }

  struct End {
    MeasuredRoad* road;
    std::size_t station;
    Vector2d at;
  };

  // Numbers the stations: ends at one place are one, with one slope.
  void meet_at_ends() {
    std::vector<End> ends;
    for (MeasuredRoad& road : roads_) {
      road.places.resize(road.stations.size());
      std::iota(road.places.begin(), road.places.end(), place_count_);
      place_count_ += road.places.size();
      for (const std::size_t i : {std::size_t{0}, road.stations.size() - 1}) {
        ends.push_back({&road, i, road.stations[i].reference_in_source.position()});
      }
    }
    std::sort(ends.begin(), ends.end(),
              [](const End& a, const End& b) { return a.at.x() < b.at.x(); });
    std::vector<geometry::Box> boxes;
    for (const End& end : ends) boxes.emplace_back(end.at);
    const geometry::BoxTree tree(boxes);
    const Vector2d reach = Vector2d::Constant(kOneEndM);
    std::vector<bool> is_met(ends.size());
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (is_met[i]) continue;
      std::vector<std::size_t> near;
      tree.visit(geometry::Box(ends[i].at - reach, ends[i].at + reach), [&](std::size_t k) {
        if (k > i && !is_met[k] && (ends[k].at - ends[i].at).norm() <= kOneEndM) near.push_back(k);
      });
      std::sort(near.begin(), near.end());
      std::vector<End> here{ends[i]};
      for (const std::size_t k : near) {
        is_met[k] = true;
        here.push_back(ends[k]);
      }
      meet(here);
    }
  }

  static void meet(const std::vector<End>& ends) {
    const End& first = ends.front();
    const Vector2d way = direction(first);
    double sum = 0.0, count = 0.0;
    const auto turned = [&](const End& end) {  // 1, −1, or 0 where it points elsewhere
      const double along = way.dot(direction(end));
      return std::abs(along) < std::cos(kOneWayRad) ? 0.0 : std::copysign(1.0, along);
    };
    for (const End& end : ends) {
      end.road->places[end.station] = first.road->places[first.station];
      const auto slope = end.road->lines[end.station].slope;
      if (!slope || turned(end) == 0.0) continue;
      sum += turned(end) * *slope, count += 1.0;
    }
    for (const End& end : ends) {
      if (count == 0.0 || turned(end) == 0.0) continue;
      end.road->lines[end.station].slope = turned(end) * sum / count;
    }
  }

  static Vector2d direction(const End& end) {
    const double heading = end.road->stations[end.station].reference_in_source.heading_rad;
    return {std::cos(heading), std::sin(heading)};
  }

  // Of each place: what is known there in the mean, and what changes between.
  std::vector<std::optional<double>> find_heights() const {
    HeightNetwork network(place_count_);
    std::vector<double> before_m(place_count_), befores(place_count_), sum_m(place_count_),
        sums(place_count_);
    for (const MeasuredRoad& road : roads_) {
      for (std::size_t i = 0; i < road.places.size(); ++i) {
        const std::size_t place = road.places[i];
        const double s_m = road.stations[i].s_m;
        const auto& elevation = road.road->elevation.cubic;
        before_m[place] += elevation.empty() ? 0.0 : elevation.at(s_m).value;
        befores[place] += 1.0;
        if (const auto height_m = road.lines[i].height_m) {
          sum_m[place] += *height_m, sums[place] += 1.0;
        }
        if (i > 0) network.connect(road.places[i - 1], place, s_m - road.stations[i - 1].s_m);
      }
    }
    std::vector<std::optional<double>> changes_m(place_count_);
    for (std::size_t i = 0; i < place_count_; ++i) {
      if (befores[i] > 0.0) before_m[i] /= befores[i];
      if (sums[i] > 0.0) changes_m[i] = sum_m[i] / sums[i] - before_m[i];
    }
    std::vector<std::optional<double>> heights_m = network.filled(changes_m);
    for (std::size_t i = 0; i < place_count_; ++i) {
      if (heights_m[i]) *heights_m[i] += before_m[i];
    }
    return heights_m;
  }

  void write(const MeasuredRoad& road, const std::vector<std::optional<double>>& heights_m) {
    std::vector<double> s_m, z_m, roll_s_m, roll_rad;
    double leans_m = 0.0;
    const double widest_m = road.widest_m();
    for (std::size_t i = 0; i < road.stations.size(); ++i) {
      s_m.push_back(road.stations[i].s_m);
      z_m.push_back(heights_m[road.places[i]].value());
      if (!road.lines[i].slope) continue;
      roll_s_m.push_back(s_m.back());
      roll_rad.push_back(std::atan(*road.lines[i].slope));
      leans_m = std::max(leans_m, std::abs(roll_rad.back()) * widest_m);
    }
    pugi::xml_node node = road.road->node;
    put(ordered_child(node, "elevationProfile", kRoadOrder), "elevation",
        cubics_through(s_m, z_m, kProfileM));
    if (roll_s_m.empty()) return;  // it leans as it did
    pugi::xml_node lateral = ordered_child(node, "lateralProfile", kRoadOrder);
    if (lateral.first_child()) ++replaced_;
    for (const char* name : {"superelevation", "crossfall", "shape", "crossSectionSurface"}) {
      for (const auto record : children(lateral, name)) lateral.remove_child(record);
    }
    find_clip_memory(node).remove_child("lateralProfile");
    if (leans_m > kLevelM) {
      if (roll_s_m.front() > 0.0) {  // as from the first one on, and to the end as at the last
        roll_s_m.insert(roll_s_m.begin(), 0.0);
        roll_rad.insert(roll_rad.begin(), roll_rad.front());
      }
      if (roll_s_m.back() < s_m.back()) {
        roll_s_m.push_back(s_m.back());
        roll_rad.push_back(roll_rad.back());
      }
      put(lateral, "superelevation", cubics_through(roll_s_m, roll_rad, kProfileM / widest_m));
    }
    if (!lateral.first_child()) node.remove_child(lateral);
  }

  static void put(pugi::xml_node profile, const char* name,
                  const std::vector<geometry::CubicRecord>& records) {
    for (const auto record : children(profile, name)) profile.remove_child(record);
    pugi::xml_node last;
    for (const geometry::CubicRecord& record : records) {
      last = last ? profile.insert_child_after(name, last) : profile.prepend_child(name);
      set_number(last, "s", record.s_m);
      set_number(last, "a", record.a);
      set_number(last, "b", record.b);
      set_number(last, "c", record.c);
      set_number(last, "d", record.d);
    }
  }

  std::vector<MeasuredRoad> roads_;
  std::size_t place_count_ = 0, replaced_ = 0;
};

}  // namespace

Edited elevate_open_drive(std::string bytes, const std::string& name, const GroundHeights& ground) {
  const std::string indent = indent_of(bytes);
  const XmlDocument xml(std::move(bytes), name);
  opendrive::Document document = opendrive::read_document(xml);
  opendrive::mend(document);
  Edited result;
  Elevator(document).run(ground, result);
  result.bytes = text_of(xml, indent);
  return result;
}

}  // namespace roadbed::map::edit::elevation
