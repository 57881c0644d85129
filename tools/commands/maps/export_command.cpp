#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/commonroad/scenario.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/projection.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/gis/layers.h"
#include "roadbed/map/lanelet2/write/autoware/write.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/opendrive/write/write.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/map/validate_file.h"
#include "roadbed/tools/cli/output_format.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/commands/maps/page_overlays.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

std::string suffixes_with_meaning() {
  std::string list;
  for (const map::Format& format : map::formats()) {
    if (!format.is_written()) continue;
    list += fmt::format("{}{}: {}", list.empty() ? "" : "; ", format.suffix, format.what);
  }
  return list;
}

std::vector<std::string> written_suffixes() {
  std::vector<std::string> suffixes;
  for (const map::Format& format : map::formats()) {
    if (format.is_written()) suffixes.emplace_back(format.suffix);
  }
  return suffixes;
}

[[noreturn]] void refuse(const std::string& file, const std::string& found,
                         const std::string& needed, const std::string& remedy) {
  throw map::InputError({.file = file, .found = found, .needed = needed, .remedy = remedy});
}

void check_layers(const map::Format& format, const std::vector<std::string>& layers) {
  if (layers.size() <= format.most_layers) return;
  refuse("--layer", fmt::format("{} given", layers.size()),
         fmt::format("at most {} for {}", format.most_layers, format.suffix),
         "leave some out, or write .gpkg");
}

class ExportCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Write a map in another format, told by the output's suffix");
    arguments.add("MAP", input_, "Any readable map").required().reads().ending(kMapEndings);
    arguments.add("-o,--output", output_, suffixes_with_meaning() + "; - for standard output")
        .required()
        .writes("");
    declare_format(arguments, format_, written_suffixes());
    declare_options(arguments);
    arguments.require([this] { return output_fault(); });
    arguments.example(
        "  roadbed export town.xodr -o town.svg\n"
        "  roadbed export town.xodr -o town.html --route route.json\n"
        "  roadbed export town.xodr -o town.gpkg\n"
        "  roadbed export town.xodr -o town.nod.xml\n"
        "  roadbed export town.xodr -o - --format csv > lines.csv\n"
        "  roadbed export data/crossing.osm -o crossing.xodr --opendrive 1.4 --json\n"
        "  roadbed export town.xodr -o lanelet2_map.osm --profile autoware\n"
        "  roadbed export town.xodr -o town.geojson --crs unknown --anchor 48.78,9.18");
  }

  void declare_options(Arguments& arguments) {
    const std::vector<std::string> names = map::layer_names();
    arguments.add("--layer", layers_, "Only these layers; .fgb holds one, lanes if none is named")
        .one_of(names);
    arguments
        .add("--anchor", anchor_deg_,
             "Latitude and longitude of the map's origin, where its system is unknown")
        .values(2)
        .separated_by(',');
    arguments.add("--crs", crs_,
                  "Coordinate system of the map, in place of what it says itself: EPSG:25832, a "
                  "PROJ string, or \"unknown\"");
    arguments
        .add("--opendrive", open_drive_,
             "Version of an OpenDRIVE output, 1.8 if none is given; a file of the output's own "
             "format is written as it stands, unless its version or its system is to change")
        .one_of({"1.4", "1.8"});
    arguments
        .add("--profile", profile_,
             "Who takes the Lanelet2 output: autoware, with map_projector_info.yaml beside it")
        .one_of({"autoware"});
    arguments.flag("-f,--force", force_, "Replace the output if it exists");
    arguments.flag("-j,--json", json_,
                   "Print one JSON document: what was written, how near it is to the map, what is "
                   "not in it");
    overlays_.declare(arguments);
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    const map::Format& format = map::format_to_write(output_, suffix());
    check_layers(format, layers_);
    map::check_writable(output_, force_);
    if (!crs_.empty() && crs_ != "unknown") check_system();
    const std::string file = input_.filename().string();
    map::MapPageOptions page{.title = file == "-" ? map::input_name(input_) : file, .file = file};
    threads_ = common.several_threads();
    const map::RoadMap road_map = suffix() == ".html" ? judged_map(page) : map::load_map(input_);
    overlays_.add_to(page, road_map);
    const Written written = is_own_document(format, road_map)
                                ? source_itself(format)
                                : write(format, road_map, std::move(page));
    map::write_output_parts(output_, written.parts, force_, common.input_files);
    if (json_) print_json(streams.out, format, road_map, written);
    if (!common.quiet) print_text(streams.err, road_map, written);
    return Exit::ok;
  }

 protected:
  std::string suffix() const { return suffix_of_output(output_, format_); }

  std::string output_fault() const {
    std::string fault = standard_output_fault(output_, true, format_, json_ ? "--json" : "");
    if (fault.empty()) fault = anchor_fault();
    if (fault.empty()) fault = profile_fault();
    if (fault.empty() && suffix() == ".nod.xml" && map::is_standard_stream(output_)) {
      fault = "-o - holds one file, and .nod.xml is several";
    }
    if (fault.empty() && suffix() == ".nod.xml" &&
        output_.filename().string().find(',') != std::string::npos) {
      fault = "netconvert takes a comma in the name of a .nod.xml as two names";
    }
    return fault.empty() ? overlay_fault() : fault;
  }

  std::string profile_fault() const {
    if (profile_.empty()) return {};
    if (suffix() != ".osm") return "--profile is for .osm";
    if (map::is_standard_stream(output_)) return "--profile writes two files; give -o a name";
    return {};
  }

  std::string anchor_fault() const {
    if (anchor_deg_.empty()) return {};
    if (std::abs(anchor_deg_[0]) <= 90.0 && std::abs(anchor_deg_[1]) <= 180.0) return {};
    return "--anchor: latitude is within ±90, longitude within ±180";
  }

  std::string overlay_fault() const {
    if (overlays_.empty() || suffix() == ".html") return {};
    return "--route, --reach, --trajectory, --occupancy and --findings are for .html";
  }

 private:
  /// The map, and for its page what `validate` says of its file, with the lines of its elements.
  map::RoadMap judged_map(map::MapPageOptions& page) const {
    map::Validation validation = map::validate_file(input_);
    if (!validation.road_map) throw map::InputError({.file = validation.refusal});
    page.remarks = map::remarks_of(validation.findings);
    page.lines = std::move(validation.lines);
    return std::move(*validation.road_map);
  }

  /// What an output holds, and what there is to say of it.
  struct Written {
    std::vector<map::OutputPart> parts;
    std::vector<std::string> notes = {};
    map::Losses lost = {};
    std::optional<double> largest_error_m = {}, largest_height_error_m = {};

    std::size_t bytes() const {
      std::size_t sum = 0;
      for (const map::OutputPart& part : parts) sum += part.bytes.size();
      return sum;
    }
  };

  Written write(const map::Format& format, const map::RoadMap& road_map,
                map::MapPageOptions page) const {
    if (format.name == "OpenDRIVE") return write_open_drive(format, road_map);
    if (!profile_.empty()) return write_autoware(format, road_map);
    Written written{{}};
    const std::string file = output_.filename().string();
    written.parts = format.output(
        road_map,
        {layers_, system_of(road_map), is_own_system(road_map), &written.notes, &written.lost,
         file.substr(0, file.size() - map::format_suffix(file).size()), std::move(page)});
    add_source_losses(format, road_map, written);
    return written;
  }

  // Whether the map's own document is what is asked for; a CommonRoad file is written as 2020a.
  bool is_own_document(const map::Format& format, const map::RoadMap& road_map) const {
    const bool is_document = format.judge != nullptr && map::format_of(input_) == &format;
    return is_document && profile_.empty() && road_map.format() != "CommonRoad 2018b" &&
           !asks_for_another(road_map);
  }

  Written source_itself(const map::Format& format) const {
    std::string note = "the document is the source's own, value for value, with its faults";
    if (format.name == "OpenDRIVE") note += "; --opendrive 1.8 or 1.4 makes another version anew";
    return {one_file(format, source_bytes()), {std::move(note)}};
  }

  std::string source_bytes() const {
    return map::map_bytes(map::read_file(input_), map::input_name(input_)).bytes;
  }

  // What the file has that the map has not.
  void add_source_losses(const map::Format& format, const map::RoadMap& road_map,
                         Written& written) const {
    const map::Format* source = map::format_of(input_);
    if (source == nullptr || format.judge == nullptr) return;
    const auto lose = [&](std::string what, std::size_t count) {
      if (count > 0) written.lost.emplace_back(std::move(what), count);
    };
    if (source->name == "CommonRoad") {
      const map::commonroad::Scenario scenario =
          map::commonroad::parse_scenario(source_bytes(), map::input_name(input_));
      lose("obstacles", scenario.obstacles.size());
      lose("planning problems", scenario.planning_problems.size());
    }
    if (source != &format) return;
    for (const map::UnusedContent& unused : road_map.unused()) lose(unused.name, unused.count);
    if (format.name != "OpenDRIVE") return;
    for (auto& [name, count] : map::opendrive::unwritten_elements(source_bytes())) {
      lose(name, count);
    }
  }

  Written write_open_drive(const map::Format& format, const map::RoadMap& road_map) const {
    const auto offset = is_own_system(road_map) ? road_map.offset_in_crs() : map::CrsOffset{};
    map::opendrive::OpenDriveFile file = map::opendrive::write_open_drive(
        road_map, {system_of(road_map), offset, open_drive_ == "1.4" ? 4 : 8, threads_});
    if (map::format_of(input_) == &format) {
      file.notes.emplace_back("the document is made anew, as its version or its system changes");
    }
    Written written{one_file(format, std::move(file.bytes)), std::move(file.notes),
                    std::move(file.lost), file.largest_error_m, file.largest_height_error_m};
    add_source_losses(format, road_map, written);
    return written;
  }

  Written write_autoware(const map::Format& format, const map::RoadMap& road_map) const {
    map::lanelet2::AutowareOptions options;
    options.crs = system_of(road_map);
    if (is_own_system(road_map)) options.offset_in_crs = road_map.offset_in_crs();
    if (map::format_of(input_) == &format) {
      options.source = source_bytes();
    }
    map::lanelet2::AutowareFiles files = map::lanelet2::write_autoware(road_map, options);
    Written written{one_file(format, std::move(files.vector_map)), std::move(files.notes),
                    std::move(files.lost)};
    written.parts.push_back({"", std::move(files.projector_info), "map_projector_info.yaml"});
    return written;
  }

  static std::vector<map::OutputPart> one_file(const map::Format& format, std::string bytes) {
    std::vector<map::OutputPart> parts;
    parts.push_back({std::string(format.suffix), std::move(bytes)});
    return parts;
  }

  bool asks_for_another(const map::RoadMap& road_map) const {
    const bool version = !open_drive_.empty() && !road_map.format().ends_with(" " + open_drive_);
    return version || !crs_.empty() || !anchor_deg_.empty();
  }

  void print_text(std::ostream& err, const map::RoadMap& road_map, const Written& written) const {
    fmt::print(err, "{}: {} lanes, {} bytes\n", output_name(output_), road_map.lanes().size(),
               written.bytes());
    if (written.largest_error_m) {
      fmt::print(err, "borders within {:.4f} m of the map's, their heights within {:.3f} m\n",
                 *written.largest_error_m, *written.largest_height_error_m);
    }
    for (const auto& [what, count] : written.lost) fmt::print(err, "lost: {} {}\n", count, what);
    print_notes(err, written.notes);
  }

  // Of notes that begin alike the first three.
  static void print_notes(std::ostream& err, const std::vector<std::string>& notes) {
    constexpr int most = 3;
    std::map<std::string, int> counts;
    for (const std::string& note : notes) {
      if (++counts[first_words(note)] <= most) fmt::print(err, "note: {}\n", note);
    }
    for (const auto& [words, count] : counts) {
      if (count <= most) continue;
      fmt::print(err, "note: {} more that begin with '{} ...': --json has them all\n", count - most,
                 words);
    }
  }

  static std::string first_words(const std::string& note) {
    std::size_t end = 0;
    for (int word = 0; word < 3 && end != std::string::npos; ++word) end = note.find(' ', end + 1);
    return note.substr(0, end);
  }

  void print_json(std::ostream& out, const map::Format& format, const map::RoadMap& road_map,
                  const Written& written) const {
    Json document{{"output", output_name(output_)},
                  {"format", format.name},
                  {"lanes", road_map.lanes().size()},
                  {"bytes", written.bytes()}};
    if (written.largest_error_m) {
      document["largest_error_m"] = *written.largest_error_m;
      document["largest_height_error_m"] = *written.largest_height_error_m;
    }
    document["lost"] = Json::array();
    for (const auto& [what, count] : written.lost) {
      document["lost"].push_back({{"what", what}, {"count", count}});
    }
    document["notes"] = written.notes;
    out << map::json_text(versioned("export", document), 2) << '\n';
  }

  std::string system_of(const map::RoadMap& road_map) const {
    const std::string own = crs_.empty() ? road_map.crs() : crs_ == "unknown" ? "" : crs_;
    if (anchor_deg_.empty()) return own;
    if (own.empty()) return map::system_anchored_at(anchor_deg_[0], anchor_deg_[1]);
    refuse(input_.string(), fmt::format("the coordinate system is known: \"{}\"", own),
           "a map of unknown system for --anchor",
           "leave --anchor out, or say --crs unknown if it is wrong");
  }

  // Also for outputs that have no place in them.
  void check_system() const {
    const std::string fault = map::projection_fault(crs_);
    if (fault.empty()) return;
    refuse("--crs", fmt::format("\"{}\": PROJ cannot use it: {}", crs_, fault),
           "a code (EPSG:32632), a PROJ string or well-known text", "correct it");
  }

  bool is_own_system(const map::RoadMap& road_map) const {
    return anchor_deg_.empty() && crs_ != "unknown" && !(crs_.empty() && road_map.crs().empty());
  }

 protected:
  std::filesystem::path input_, output_;
  std::vector<std::string> layers_;
  std::vector<double> anchor_deg_;
  std::string crs_, format_, open_drive_, profile_;
  PageOverlays overlays_;
  int threads_ = 1;
  bool force_ = false, json_ = false;
};

/// What `export` does, and for a compiled map what `import` does.
class ConvertCommand : public ExportCommand {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Write a map in another format: import and export in one");
    arguments.add("A", input_, "Any readable map").required().reads().ending(kMapEndings);
    const Argument b =
        arguments.add("B", positional_output_, "The output, in place of -o").writes("");
    std::vector<std::string> suffixes = written_suffixes();
    arguments
        .add("-o,--output", output_,
             fmt::format(".rbm: compiled map; or as of export: {}; - for standard output",
                         fmt::join(suffixes, " ")))
        .writes("")
        .excludes(b);
    suffixes.insert(suffixes.begin(), ".rbm");
    declare_format(arguments, format_, suffixes);
    declare_options(arguments);
    arguments.require([this] { return fault(); });
    arguments.example(
        "  roadbed convert town.xodr town.osm\n"
        "  roadbed convert town.osm -o town.rbm");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    return is_compiled() ? import(streams, common) : ExportCommand::run(streams, common);
  }

 private:
  bool is_compiled() const { return suffix() == ".rbm"; }

  std::string fault() {
    if (output_.empty()) output_ = positional_output_;
    if (output_.empty()) return "B or -o is required: the output";
    const bool is_plain =
        layers_.empty() && anchor_deg_.empty() && open_drive_.empty() && profile_.empty() && !json_;
    if (is_compiled() && !is_plain) {
      return "--layer, --anchor, --opendrive, --profile and --json are for outputs other than .rbm";
    }
    return output_fault();
  }

  Exit import(const Streams& streams, const CommonOptions& common) const {
    std::vector<std::string> words{"--output=" + output_.string()};
    if (!crs_.empty()) words.push_back("--crs=" + crs_);
    if (force_) words.emplace_back("--force");
    words.insert(words.end(), {"--", input_.string()});
    const std::unique_ptr<Command> command = make_import_command();
    ArgumentSet set;
    command->declare(set.arguments());
    if (const std::string wrong = set.parse(words); !wrong.empty()) {
      throw std::logic_error("convert: import does not take its words: " + wrong);
    }
    return command->run(streams, common);
  }

  std::filesystem::path positional_output_;
};

}  // namespace

std::unique_ptr<Command> make_convert_command() { return std::make_unique<ConvertCommand>(); }

std::unique_ptr<Command> make_export_command() { return std::make_unique<ExportCommand>(); }

}  // namespace roadbed::tools::commands::maps
