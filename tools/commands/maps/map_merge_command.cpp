#include "roadbed/map/edit/merging/merge.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/csv_field.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/commands/maps/edit_output.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

std::string renamed_csv(const std::vector<map::Renamed>& list) {
  std::string text = "file,kind,from,to\n";
  for (const map::Renamed& one : list) {
    text += fmt::format("{},{},{},{}\n", map::csv_field(one.file), map::csv_field(one.kind),
                        map::csv_field(one.from), map::csv_field(one.to));
  }
  return text;
}

Json renamed_json(const std::vector<map::Renamed>& list) {
  Json json = Json::array();
  for (const map::Renamed& one : list) {
    json.push_back({{"file", one.file}, {"kind", one.kind}, {"from", one.from}, {"to", one.to}});
  }
  return json;
}

Json seams_json(const std::vector<map::Seam>& list) {
  Json json = Json::array();
  for (const map::Seam& seam : list) {
    json.push_back({{"first", seam.first},
                    {"second", seam.second},
                    {"what", seam.what},
                    {"gap_m", seam.gap_m},
                    {"x_m", seam.x_m},
                    {"y_m", seam.y_m}});
  }
  return json;
}

class MergeCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Make one map of several: parts that a clip left, or neighbours");
    arguments.add("MAPS", inputs_, "OpenDRIVE, Lanelet2 or CommonRoad files, all of one format")
        .required()
        .reads()
        .ending(kMapEndings);
    output_.declare(arguments);
    arguments.add("--renamed", renamed_file_, "Write the elements that got another id, as CSV")
        .writes(".csv");
    arguments
        .add("--tolerance", options_.tolerance_m, "Free ends at most this far apart are linked [m]")
        .not_negative()
        .with_default();
    arguments.flag("--same-system", options_.same_system,
                   "Take all coordinates as those of the first map, whatever the files say");
    arguments.require([this] { return output_.fault(); });
    arguments.example(
        "  roadbed map clip town.xodr --bbox=0,-100,300,500 -o west.xodr\n"
        "  roadbed map clip town.xodr --bbox=300,-100,700,500 -o east.xodr\n"
        "  roadbed map merge west.xodr east.xodr -o whole.xodr --renamed ids.csv");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    output_.check();
    if (!renamed_file_.empty()) map::check_writable(renamed_file_, output_.force());
    std::vector<map::MergeInput> inputs;
    for (const auto& file : inputs_)
      inputs.push_back({map::read_file(file), map::input_name(file)});
    const map::Merged merged = map::merge(std::move(inputs), options_);
    std::map<std::filesystem::path, std::string> beside;
    if (!renamed_file_.empty()) beside[renamed_file_] = renamed_csv(merged.renamed);
    const Exit exit = output_.finish(
        merged, "map_merge", streams, common,
        {{"renamed", renamed_json(merged.renamed)}, {"seams", seams_json(merged.seams)}}, beside);
    if (!output_.prints_json() && !common.quiet) say(streams, merged);
    return exit;
  }

 private:
  void say(const Streams& streams, const map::Merged& merged) const {
    if (!merged.renamed.empty()) {
      fmt::print(streams.err, "{} elements have another id: see --renamed or --json\n",
                 merged.renamed.size());
    }
    for (const map::Seam& seam : merged.seams) {
      if (seam.what == "joined" && seam.gap_m < 1e-3) continue;
      fmt::print(streams.err, "{} and {}, {:.3f} m apart near {:.3f},{:.3f}: {}\n", seam.first,
                 seam.second, seam.gap_m, seam.x_m, seam.y_m, seam.what);
    }
  }

  std::vector<std::filesystem::path> inputs_;
  map::MergeOptions options_;
  EditOutput output_;
  std::filesystem::path renamed_file_;
};

}  // namespace

std::unique_ptr<Command> make_map_merge_command() { return std::make_unique<MergeCommand>(); }

}  // namespace roadbed::tools::commands::maps
