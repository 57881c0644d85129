#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <vector>

#include "roadbed/map/storage/output_folder.h"
#include "roadbed/tools/commands/drives/commands.h"
#include "roadbed/tools/figures/paper_figures.h"

namespace roadbed::tools::inline commands::inline drives {
namespace {

std::vector<Figure> all_figures() {
  std::vector<Figure> figures = reference_line_figures();
  std::ranges::move(lateral_planner_figures(), std::back_inserter(figures));
  figures.push_back(cruise_control_figure());
  std::ranges::move(steering_law_figures(), std::back_inserter(figures));
  std::ranges::move(tracking_figures(), std::back_inserter(figures));
  return figures;
}

class FiguresCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Compute the paper's figures 2 to 14, each as SVG and CSV");
    arguments.add("-o,--output", folder_, "Folder for the figures").required().writes("/");
    arguments.flag("-f,--force", force_, "Replace files in the folder");
    arguments.example("  roadbed figures -o figures");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    map::OutputFolder folder(folder_, {.force = force_});
    const std::vector<Figure> figures = all_figures();
    for (const Figure& figure : figures) {
      folder.write(figure.name + ".svg", figure_svg(figure));
      folder.write(figure.name + ".csv", figure_csv(figure));
    }
    folder.commit();
    for (const Figure& figure : figures) {
      fmt::print(streams.out, "{}\n", (std::filesystem::path(folder_) / figure.name).string());
    }
    return Exit::ok;
  }

 private:
  std::string folder_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_figures_command() { return std::make_unique<FiguresCommand>(); }

}  // namespace roadbed::tools::commands::drives
