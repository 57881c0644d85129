#include <fmt/format.h>
#include <fmt/ostream.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "roadbed/map/files/csv_field.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/planning/route/route_area.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tools/cli/output_format.h"
#include "roadbed/tools/cli/route_question.h"
#include "roadbed/tools/commands/routes/commands.h"
#include "roadbed/tools/commands/routes/route_output.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline routes {
namespace {

struct Limit {
  double value = 0.0;
  planning::RouteCost measure = planning::RouteCost::time;
};

std::optional<Limit> limit_of(const std::string& text) {
  constexpr double kMost = 1e5;  // 27 hours, 100 km
  Limit limit;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), limit.value);
  const std::string unit(rest, text.data() + text.size());
  if (error != std::errc() || !(limit.value > 0.0 && limit.value <= kMost)) return {};
  if (unit != "s" && unit != "m") return {};
  limit.measure = unit == "s" ? planning::RouteCost::time : planning::RouteCost::distance;
  return limit;
}

std::string reached_csv(const map::RoadMap& road_map,
                        const std::vector<planning::ReachedLane>& reached, const char* unit,
                        bool has_lon_lat) {
  std::string text = fmt::format("lane,from_s_m,to_s_m,cost_{},reversed{}\n", unit,
                                 has_lon_lat ? kLonLatColumns : "");
  for (const planning::ReachedLane& lane : reached) {
    const planning::LanePart& part = lane.part;
    text += fmt::format("{},{:.3f},{:.3f},{:.4f},{}", map::csv_field(road_map.lane(part.lane).name),
                        part.from_s_m, part.to_s_m, lane.cost, lane.reversed ? 1 : 0);
    if (has_lon_lat) text += lon_lat_fields(road_map, part.lane, part.from_s_m, part.to_s_m);
    text += '\n';
  }
  return text;
}

class ReachCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Find the lanes that can be reached within a time or a distance (isochrone)");
    arguments.add("MAP", map_file_, "Any readable map").required().reads().ending(kMapEndings);
    arguments.add("--from", from_, std::string("Start: ") + kPlaceSyntax)
        .required()
        .checked(place_syntax_fault);
    arguments.add("--within", within_, "Time or distance budget: 60s or 500m, up to 100000")
        .required()
        .checked([](const std::string& text) {
          return limit_of(text) ? "" : "is not a number up to 100000 with s or m behind it";
        });
    rules_.declare(arguments, false);
    declare_lon_lat(arguments, wants_lon_lat_);
    arguments.flag("-j,--json", json_, "Print one JSON document");
    arguments
        .add("-o,--output", output_,
             "Write too: .geojson the area, .csv a row per lane, .svg a picture; - for standard "
             "output, in place of what is printed")
        .writes(".geojson");
    declare_format(arguments, format_, kAreaSuffixes);
    arguments.require(
        [this] { return standard_output_fault(output_, true, format_, json_ ? "--json" : ""); });
    arguments.flag("-f,--force", force_, "Replace the output if it exists");
    arguments.says_no_if("nothing can be reached");
    arguments.example("  roadbed reach town.xodr --from lane:1/0/-1@10 --within 60s -o reach.svg");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    if (!output_.empty()) {
      check_suffix(output_, suffix(), kAreaSuffixes);
      map::check_writable(output_, force_);
    }
    const Limit limit = limit_of(within_).value();
    const map::RoadMap road_map = map::load_map(map_file_);
    const Place from = find_place(road_map, from_, rules_.participant());
    planning::Router router(road_map, rules_.on(road_map, limit.measure));
    const std::string fault = router.unfit(from.for_route(), "start");
    if (!fault.empty()) {
      fmt::print(streams.err, "roadbed: nothing can be reached: {}\n", fault);
      return Exit::no;
    }
    const auto reached = planning::isochrone(router, from.for_route(), limit.value);
    const char* unit = limit.measure == planning::RouteCost::time ? "s" : "m";
    if (!output_.empty()) write(road_map, reached, unit);
    if (!map::is_standard_stream(output_)) print(streams, road_map, reached, unit);
    return Exit::ok;
  }

 private:
  std::string suffix() const { return suffix_of_output(output_, format_); }

  void write(const map::RoadMap& road_map, const std::vector<planning::ReachedLane>& reached,
             const char* unit) const {
    if (suffix() == ".csv") {
      const std::string rows = reached_csv(road_map, reached, unit, wants_lon_lat_);
      return map::write_output(output_, rows, force_);
    }
    std::vector<planning::LanePart> parts;
    for (const planning::ReachedLane& lane : reached) parts.push_back(lane.part);
    const auto area = planning::area_of(road_map, parts);
    map::write_output(output_,
                      suffix() == ".svg" ? area_svg(road_map, area, {})
                                         : area_geojson(road_map, area, {{"within", within_}},
                                                        wants_lon_lat_ ? Coordinates::lon_lat
                                                                       : Coordinates::source),
                      force_);
  }

  void print(const Streams& streams, const map::RoadMap& road_map,
             const std::vector<planning::ReachedLane>& reached, const char* unit) const {
    double length_m = 0.0;
    Json lanes = Json::array();
    for (const planning::ReachedLane& lane : reached) {
      length_m += std::abs(lane.part.to_s_m - lane.part.from_s_m);
      lanes.push_back({{"lane", road_map.lane(lane.part.lane).name},
                       {"from_s_m", lane.part.from_s_m},
                       {"to_s_m", lane.part.to_s_m},
                       {"reversed", lane.reversed},
                       {std::string("cost_") + unit, lane.cost}});
      if (!wants_lon_lat_) continue;
      add_lon_lat(road_map, lane.part.lane, lane.part.from_s_m, lane.part.to_s_m, lanes.back());
    }
    if (json_) {
      fmt::print(streams.out, "{}\n",
                 text_of(versioned("reach",
                                   {{"within", within_}, {"length_m", length_m}, {"lanes", lanes}}),
                         2));
      return;
    }
    fmt::print(streams.out, "{} lanes, {:.1f} m, within {}\n", reached.size(), length_m, within_);
    for (const planning::ReachedLane& lane : reached) {
      fmt::print(streams.out, "  {:<16} {:>9.2f} to {:>9.2f} m  from {:.2f} {}{}\n",
                 road_map.lane(lane.part.lane).name, lane.part.from_s_m, lane.part.to_s_m,
                 lane.cost, unit, lane.reversed ? ", reversed" : "");
    }
  }

  std::filesystem::path map_file_, output_;
  std::string from_, within_, format_;
  RouteRules rules_;
  bool json_ = false, force_ = false, wants_lon_lat_ = false;
};

}  // namespace

std::unique_ptr<Command> make_reach_command() { return std::make_unique<ReachCommand>(); }

}  // namespace roadbed::tools::commands::routes
