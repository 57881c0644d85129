#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "roadbed/map/files/csv_field.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/query/lane_question.h"
#include "roadbed/map/query/map_stats.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

/// "speed_kmh": a name with its unit, for keys and columns.
std::string key_of(const map::StatsTable& table) {
  if (table.by == "speed") return "speed_kmh";
  if (table.by == "width") return "width_m";
  if (table.by == "slope") return "slope_percent";
  if (table.by == "curvature") return "curvature_per_m";
  return std::string(table.by);
}

Json amounts(const map::StatsRow& row) {
  return {{"lanes", row.lanes}, {"length_m", row.length_m}, {"area_m2", row.area_m2}};
}

Json row_json(const map::StatsTable& table, const map::StatsRow& row) {
  Json json;
  if (table.has_classes) {
    json["from"] = row.from;
    json["to"] = std::isfinite(row.to) ? Json(row.to) : Json();
  } else if (table.by == "speed") {
    json["limit"] = row.value == "unknown" ? Json() : Json(std::stod(row.value));
  } else {
    json[std::string(table.by)] = row.value;
  }
  json.update(amounts(row));
  return json;
}

Json stats_json(const map::MapStats& stats) {
  Json json = amounts(stats.all);
  for (const map::StatsTable& table : stats.tables) {
    Json rows = Json::array();
    for (const map::StatsRow& row : table.rows) rows.push_back(row_json(table, row));
    json["by_" + key_of(table)] = std::move(rows);
  }
  return versioned("map_stats", json);
}

std::string csv_row(const std::string& by, const std::string& value, const std::string& from,
                    const std::string& to, const map::StatsRow& row) {
  return fmt::format("{},{},{},{},{},{:.3f},{:.3f}\n", by, map::csv_field(value), from, to,
                     row.lanes, row.length_m, row.area_m2);
}

std::string stats_csv(const map::MapStats& stats) {
  std::string text = "by,value,from,to,lanes,length_m,area_m2\n";
  text += csv_row("all", "", "", "", stats.all);
  for (const map::StatsTable& table : stats.tables) {
    for (const map::StatsRow& row : table.rows) {
      const std::string from = table.has_classes ? fmt::format("{}", row.from) : "";
      const bool is_open = !table.has_classes || !std::isfinite(row.to);
      text +=
          csv_row(key_of(table), row.value, from, is_open ? "" : fmt::format("{}", row.to), row);
    }
  }
  return text;
}

std::string label(const map::StatsTable& table, const map::StatsRow& row) {
  if (!table.has_classes) return row.value;
  if (!std::isfinite(row.to)) return fmt::format("from {}", row.from);
  return fmt::format("{} to {}", row.from, row.to);
}

void print_row(std::ostream& out, const std::string& name, const map::StatsRow& row) {
  fmt::print(out, "  {:<16}{:>8} lanes{:>14.1f} m{:>16.1f} m²\n", name, row.lanes, row.length_m,
             row.area_m2);
}

void print_text(std::ostream& out, const map::MapStats& stats) {
  fmt::print(out, "lanes\n");
  print_row(out, "all", stats.all);
  for (const map::StatsTable& table : stats.tables) {
    const std::string unit = table.unit.empty() ? "" : fmt::format(" [{}]", table.unit);
    fmt::print(out, "by {}{}\n", table.by, unit);
    for (const map::StatsRow& row : table.rows) print_row(out, label(table, row), row);
  }
}

class MapStatsCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Sum up the length and area of lanes by type, speed limit, width, slope and curvature");
    arguments.add("MAP", map_file_, "Any readable map").required().reads().ending(kMapEndings);
    arguments
        .add("--where", question_,
             "Only lanes of which this is true, as of map query: 'drivable = true'")
        .checked(map::question_fault);
    const Argument json = arguments.flag("-j,--json", json_, "Print one JSON document");
    arguments.flag("--csv", csv_, "Print a table, a row per line").excludes(json);
    arguments.example(
        "  roadbed map stats town.xodr\n"
        "  roadbed map stats town.xodr --where 'type = driving' --csv");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    const map::RoadMap road_map = map::load_map(map_file_);
    const map::LaneQuestion question(question_.empty() ? "lane != none" : question_);
    const map::MapStats stats = map_stats(road_map, map::lanes_that_fit(road_map, question));
    if (json_) {
      streams.out << map::json_text(stats_json(stats), 2) << '\n';
    } else if (csv_) {
      streams.out << stats_csv(stats);
    } else {
      print_text(streams.out, stats);
    }
    return Exit::ok;
  }

 private:
  std::filesystem::path map_file_;
  std::string question_;
  bool json_ = false, csv_ = false;
};

}  // namespace

std::unique_ptr<Command> make_map_stats_command() { return std::make_unique<MapStatsCommand>(); }

}  // namespace roadbed::tools::commands::maps
