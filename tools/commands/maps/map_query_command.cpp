#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "roadbed/map/files/csv_field.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/gis/layers.h"
#include "roadbed/map/gis/write.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/query/lane_question.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/cli/output_format.h"
#include "roadbed/tools/commands/maps/commands.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

std::string help_of_fields() {
  std::string help;
  for (const map::LaneField& field : map::lane_fields()) {
    help += fmt::format("{}{} ({})", help.empty() ? "" : "; ", field.name, field.what);
  }
  return help + "; tag.KEY (what the source says under a key)";
}

std::string ids_text(const map::RoadMap& road_map, const std::vector<map::LaneId>& lanes) {
  std::string text;
  for (const map::LaneId id : lanes) text += road_map.lane(id).name + '\n';
  return text;
}

std::string csv_value(const map::FieldValue& value) {
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  const auto* texts = std::get_if<std::vector<std::string>>(&value);
  return texts == nullptr ? "" : map::csv_field(fmt::format("{}", fmt::join(*texts, " ")));
}

std::string csv_text(const map::RoadMap& road_map, const std::vector<map::LaneId>& lanes) {
  std::string text;
  for (const map::LaneField& field : map::lane_fields()) {
    text += fmt::format("{}{}", text.empty() ? "" : ",", field.name);
  }
  text += '\n';
  for (const map::LaneId id : lanes) {
    const map::AskedLane lane(road_map, road_map.lane(id));
    const char* separator = "";
    for (const map::LaneField& field : map::lane_fields()) {
      text += separator + csv_value(field.value(lane));
      separator = ",";
    }
    text += '\n';
  }
  return text;
}

/// The layer `lanes` of an export, those lanes only.
std::string geojson_text(const map::RoadMap& road_map, const std::vector<map::LaneId>& lanes) {
  std::vector<map::Layer> layers{map::make_layer(road_map, "lanes")};
  std::vector<map::Feature> kept;
  for (const map::LaneId id : lanes) kept.push_back(std::move(layers[0].features[id.index]));
  layers[0].features = std::move(kept);
  map::to_source(road_map, layers);
  const bool has_lon_lat = !road_map.crs().empty();
  if (has_lon_lat) {
    map::source_to_crs(road_map, layers);
    map::to_lon_lat(road_map.crs(), layers);
  }
  return map::write_geojson(layers, {has_lon_lat, road_map.format(), road_map.crs()});
}

class MapQueryCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("List the lanes of which something is true");
    arguments.add("MAP", map_file_, "Any readable map").required().reads().ending(kMapEndings);
    arguments
        .add("QUESTION", question_,
             "Comparisons of fields by = != < <= > >= ~ (is a part) and in (A, B), joined by and, "
             "or, not and parentheses; none is what a lane does not say. Fields: " +
                 help_of_fields())
        .required()
        .checked(map::question_fault);
    arguments
        .add("-o,--output", output_,
             "Write to this file: .txt names, .csv all fields, .geojson the lanes; else to "
             "standard output")
        .writes(".csv");
    declare_format(arguments, format_, {".txt", ".csv", ".geojson"});
    arguments.flag("-f,--force", force_, "Replace the output if it exists");
    arguments.says_no_if("no lane fits");
    arguments.example(
        "  roadbed map query town.xodr 'type = driving and speed > 40'\n"
        "  roadbed map query town.xodr 'width < 3 or successors = none' --format csv\n"
        "  roadbed map query town.xodr 'junction != none' -o crossing_lanes.geojson");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    const bool prints = output_.empty() || map::is_standard_stream(output_);
    const std::string suffix =
        prints ? "." + (format_.empty() ? "txt" : format_) : suffix_of_output(output_, format_);
    if (!prints) map::check_writable(output_, force_);
    const map::RoadMap road_map = map::load_map(map_file_);
    const auto lanes = map::lanes_that_fit(road_map, map::LaneQuestion(question_));
    const std::string text = suffix == ".csv"       ? csv_text(road_map, lanes)
                             : suffix == ".geojson" ? geojson_text(road_map, lanes)
                                                    : ids_text(road_map, lanes);
    if (prints) {
      streams.out << text;
    } else {
      map::write_output(output_, text, force_);
    }
    if (!common.quiet) {
      fmt::print(streams.err, "{} of {} lanes\n", lanes.size(), road_map.lanes().size());
    }
    return lanes.empty() ? Exit::no : Exit::ok;
  }

 private:
  std::filesystem::path map_file_, output_;
  std::string question_, format_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_map_query_command() { return std::make_unique<MapQueryCommand>(); }

}  // namespace roadbed::tools::commands::maps
