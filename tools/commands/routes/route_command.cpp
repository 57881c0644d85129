#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <iostream>
#include <string>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/planning/route/alternatives.h"
#include "roadbed/planning/route/route_area.h"
#include "roadbed/planning/route/router.h"
#include "roadbed/tools/cli/output_format.h"
#include "roadbed/tools/cli/route_question.h"
#include "roadbed/tools/commands/routes/commands.h"
#include "roadbed/tools/commands/routes/route_batch.h"
#include "roadbed/tools/commands/routes/route_output.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline routes {
namespace {

using Routes = std::vector<planning::Route>;

std::string file_text(const std::string& suffix, const map::RoadMap& road_map, const Routes& routes,
                      Coordinates coordinates) {
  if (suffix == ".csv") return route_csv(road_map, routes, coordinates);
  if (suffix != ".svg") return route_geojson(road_map, routes, coordinates);
  std::vector<planning::LanePart> parts;
  for (const planning::Route& route : routes) {
    const auto corridor = planning::corridor_of(road_map, route);
    parts.insert(parts.end(), corridor.begin(), corridor.end());
  }
  return area_svg(road_map, planning::area_of(road_map, parts), routes);
}

class RouteCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Find the cheapest route over lanes, or say why there is none");
    arguments.add("MAP", map_file_, "Any readable map").required().reads().ending(kMapEndings);
    question_.declare(arguments, true);
    arguments
        .add("--alternatives", alternatives_,
             "Find up to this many routes; each shares at most 70 % of its length with any before "
             "and "
             "costs at most 1.5 times the first")
        .within(1, 20);
    arguments
        .add("--batch", batch_,
             "Pairs instead of --from and --to: CSV with the columns from and to, places in "
             "quotes; one row of answers each")
        .reads()
        .ending(".csv");
    declare_lon_lat(arguments, wants_lon_lat_);
    arguments.flag("--matrix", matrix_, "With --batch: from every from to every to");
    arguments.flag("-j,--json", json_, "Print one JSON document");
    arguments
        .add("-o,--output", output_,
             "Write too: .geojson with the corridor, .csv a row per leg, .svg a picture; with "
             "--batch the rows, as .csv")
        .writes(".geojson");
    declare_format(arguments, format_, kAreaSuffixes);
    arguments.flag("-f,--force", force_, "Replace the output if it exists");
    arguments.require([this] { return missing(); });
    arguments.says_no_if("there is no route, with --batch for one of the pairs");
    arguments.example(
        "  roadbed route town.xodr --from lane:1/0/-1@10 --to lane:7/0/1@55\n"
        "  roadbed route town.xodr --from 270,203 --to lane:7/0/1@55 --avoid road:4 -o way.svg\n"
        "  roadbed route town.xodr --batch pairs.csv -o answers.csv --threads 2");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    if (!output_.empty()) {
      check_suffix(output_, suffix(),
                   batch_.empty() ? kAreaSuffixes : std::vector<std::string>{".csv"});
      map::check_writable(output_, force_);
    }
    if (!batch_.empty()) return run_batch(streams, common);
    const auto kept_map = common.inputs->road_map(map_file_);
    const map::RoadMap& road_map = *kept_map;
    RouteQuestion::Asked asked = question_.on(road_map);
    planning::Router router(road_map, asked.options);
    const planning::RouteAnswer answer = router.find(asked.places());
    if (!answer.route) return refuse(streams, road_map, asked, answer);
    asked.from.choose(answer.route->legs.front().lane);
    asked.to.choose(answer.route->legs.back().lane);
    Routes routes{*answer.route};
    std::vector<double> shared{0.0};
    if (alternatives_ > 1) {
      auto others = planning::find_alternatives(router, asked.from.for_route(),
                                                asked.to.for_route(), {.count = alternatives_});
      for (std::size_t i = 1; i < others.size(); ++i) {  // the first one is the answer itself
        shared.push_back(others[i].shared);
        routes.push_back(std::move(others[i].route));
      }
    }
    if (!output_.empty()) {
      map::write_output(output_, file_text(suffix(), road_map, routes, coordinates()), force_);
    }
    if (!map::is_standard_stream(output_)) print(streams, road_map, asked, routes, shared);
    if (!common.quiet) note_defaults(streams, routes.front());
    return Exit::ok;
  }

 private:
  Coordinates coordinates() const {
    return wants_lon_lat_ ? Coordinates::lon_lat : Coordinates::source;
  }

  std::string suffix() const { return suffix_of_output(output_, format_); }

  std::string missing() const {
    const std::string fault = standard_output_fault(output_, true, format_, json_ ? "--json" : "");
    if (!fault.empty()) return fault;
    if (!batch_.empty()) {
      if (wants_lon_lat_) return "--batch excludes --lonlat: its rows name no coordinates";
      if (question_.has_any_place()) return "--batch excludes --from, --via and --to";
      if (alternatives_ > 1) return "--batch excludes --alternatives";
      return "";
    }
    if (matrix_) return "--matrix needs --batch";
    if (!question_.has_places()) return "--from and --to are required";
    if (alternatives_ > 1 && question_.has_via()) return "--alternatives excludes --via";
    return "";
  }

  Exit run_batch(const Streams& streams, const CommonOptions& common) const {
    const auto kept_map = common.inputs->road_map(map_file_);
    const map::RoadMap& road_map = *kept_map;
    const BatchAnswer answer =
        route_batch(road_map, batch_, question_.rules().on(road_map),
                    {.matrix = matrix_, .json = json_, .threads = common.threads});
    if (output_.empty()) {
      fmt::print(streams.out, "{}", json_ ? answer.json : answer.csv);
    } else {
      map::write_output(output_, answer.csv, force_);
      if (json_) fmt::print(streams.out, "{}", answer.json);
    }
    for (const std::string& fault : answer.faults) {
      fmt::print(streams.err, "roadbed: {}\n", fault);
    }
    if (!common.quiet) {
      fmt::print(streams.err, "{} pairs: {} routes, {} without a route, {} rows unusable\n",
                 answer.found + answer.none + answer.faults.size(), answer.found, answer.none,
                 answer.faults.size());
    }
    return answer.faults.empty() && answer.none == 0 ? Exit::ok : Exit::no;
  }

  void print(const Streams& streams, const map::RoadMap& road_map,
             const RouteQuestion::Asked& asked, const Routes& routes,
             const std::vector<double>& shared) const {
    if (json_) {
      Json json = route_json(road_map, routes.front(), coordinates());
      json["from"] = place_json(road_map, asked.from);
      json["to"] = place_json(road_map, asked.to);
      for (std::size_t i = 1; i < routes.size(); ++i) {
        Json other = route_json(road_map, routes[i], coordinates());
        other["shared_length_fraction"] = shared[i];
        json["alternatives"].push_back(std::move(other));
      }
      fmt::print(streams.out, "{}\n", text_of(versioned("route", json), 2));
      return;
    }
    print_choice(streams, road_map, "start", asked.from);
    print_choice(streams, road_map, "goal", asked.to);
    for (std::size_t i = 0; i < routes.size(); ++i) {
      if (i > 0) {
        fmt::print(streams.out, "alternative {}, {:.0f} % shared:\n", i, 100.0 * shared[i]);
      }
      fmt::print(streams.out, "{}", route_text(road_map, routes[i]));
    }
  }

  static void print_choice(const Streams& streams, const map::RoadMap& road_map, const char* what,
                           const Place& place) {
    if (place.candidates.size() < 2) return;
    fmt::print(streams.out, "{} on lane {}, chosen of {} lanes there\n", what,
               road_map.lane(place.on_lane.lane).name, place.candidates.size());
  }

  static void note_defaults(const Streams& streams, const planning::Route& route) {
    if (route.legs_of_unknown_speed == 0) return;
    fmt::print(streams.err,
               "note: {} of {} lanes give no speed limit: the default of their type was used\n",
               route.legs_of_unknown_speed, route.legs.size());
  }

  Exit refuse(const Streams& streams, const map::RoadMap& road_map,
              const RouteQuestion::Asked& asked, const planning::RouteAnswer& answer) const {
    if (json_) {
      Json json = no_route_json(road_map, answer);
      json["from"] = place_json(road_map, asked.from);
      json["to"] = place_json(road_map, asked.to);
      fmt::print(streams.out, "{}\n", text_of(versioned("route", json), 2));
    }
    fmt::print(streams.err, "roadbed: no route: {}\n", answer.reason);
    return Exit::no;
  }

  std::filesystem::path map_file_, output_, batch_;
  std::string format_;
  RouteQuestion question_;
  int alternatives_ = 1;
  bool json_ = false, force_ = false, matrix_ = false, wants_lon_lat_ = false;
};

}  // namespace

std::unique_ptr<Command> make_route_command() { return std::make_unique<RouteCommand>(); }

}  // namespace roadbed::tools::commands::routes
