#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/derived/map_diff.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/page/diff_page.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/cli/command_group.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

Json change_json(const map::MapChange& change) {
  Json json = {{"theme", change.theme},
               {"element", change.element},
               {"change", to_string(change.kind)},
               {"facets", change.facets}};
  if (change.in_source) {
    json["moved_m"] = change.moved_m;
    json["x_m"] = change.in_source->x();
    json["y_m"] = change.in_source->y();
  }
  return json;
}

/// "plan, elevation"
std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

void print_differences(std::ostream& out, const map::MapChange& change) {
  fmt::print(out, "{:<12}{}: {}", change.theme, change.element, to_string(change.kind));
  if (!change.facets.empty()) fmt::print(out, " ({})", joined(change.facets));
  if (change.in_source) {
    fmt::print(out, ", by up to {:.3f} m near {:.3f},{:.3f}", change.moved_m, change.in_source->x(),
               change.in_source->y());
  }
  fmt::print(out, "\n");
}

/// `map diff` and `diff`.
class DiffCommand : public Command {
 public:
  /// @param words  what it is called.
  explicit DiffCommand(std::string words) : words_(std::move(words)) {}

  void declare(Arguments& arguments) override {
    arguments.description("Say what changed between two versions of a map");
    arguments.add("A", before_, "The older map: any readable one").required().ending(kMapEndings);
    arguments.add("B", after_, "The newer map").required().ending(kMapEndings);
    arguments
        .add("--tolerance", options_.tolerance_m, "Lines that moved less are taken as unmoved [m]")
        .not_negative()
        .with_default();
    arguments.flag("-j,--json", json_, "Print one JSON document");
    arguments.add("-o,--output", page_, "Show the changes on the newer map: a page (.html)")
        .writes(".html");
    arguments.flag("-f,--force", force_, "Replace the output if it exists");
    arguments.says_no_if("the maps differ");
    arguments.require([this] {
      if (page_.empty() || page_.extension() == ".html") return std::string();
      return "--output: a page, whose name ends in .html; not " + page_.string();
    });
    arguments.example("  roadbed " + words_ + " old.xodr new.xodr --tolerance 0.01\n  roadbed " +
                      words_ + " old.xodr new.xodr -o changes.html");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    if (!page_.empty()) map::check_writable(page_, force_);
    const map::RoadMap before = map::load_map(before_), after = map::load_map(after_);
    const auto changes = diff(before, after, options_);
    if (!page_.empty()) write_page(before, after, changes);
    if (json_) {
      Json list = Json::array();
      for (const auto& change : changes) list.push_back(change_json(change));
      const Json document = {
          {"roadbed_map_diff", 1}, {"equal", changes.empty()}, {"changes", std::move(list)}};
      fmt::print(streams.out, "{}\n", map::json_text(document, 2));
    } else {
      for (const auto& change : changes) print_differences(streams.out, change);
      fmt::print(streams.out, "{} change{}\n", changes.size(), changes.size() == 1 ? "" : "s");
    }
    return changes.empty() ? Exit::ok : Exit::no;
  }

 private:
  void write_page(const map::RoadMap& before, const map::RoadMap& after,
                  const std::vector<map::MapChange>& changes) const {
    const std::string title = fmt::format("{}, changed since {}", after_.filename().string(),
                                          before_.filename().string());
    const map::MapPageOptions options{.title = title,
                                      .file = after_.filename().string(),
                                      .crs = after.crs(),
                                      .is_own_crs = !after.crs().empty()};
    map::write_output(page_, write_diff_page(before, after, changes, options), force_);
  }

  std::string words_;
  std::filesystem::path before_, after_, page_;
  map::MapDiffOptions options_;
  bool json_ = false, force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_diff_command() { return std::make_unique<DiffCommand>("diff"); }

std::unique_ptr<Command> make_map_command() {
  auto group = std::make_unique<CommandGroup>(
      "Work on maps: compare, count, ask, edit, mend",
      "  roadbed map diff old.xodr new.xodr\n"
      "  roadbed map stats town.xodr\n"
      "  roadbed map query town.xodr 'type = driving and speed > 40'\n"
      "  roadbed map clip town.xodr --bbox=0,0,200,300 -o part.xodr\n"
      "  roadbed map fix town.xodr -o mended.xodr");
  group->add("diff", std::make_unique<DiffCommand>("map diff"));
  group->add("clip", make_map_clip_command());
  group->add("merge", make_map_merge_command());
  group->add("transform", make_map_transform_command());
  group->add("tile", make_map_tile_command());
  group->add("stats", make_map_stats_command());
  group->add("query", make_map_query_command());
  group->add("fix", make_map_fix_command());
  return group;
}

}  // namespace roadbed::tools::commands::maps
