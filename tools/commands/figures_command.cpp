#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <vector>

#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/commands/commands.h"
#include "roadbed/tools/report/paper_figures.h"

namespace roadbed::tools::inline commands {
namespace {

std::vector<Figure> all_figures() {
  std::vector<Figure> figures = reference_line_figures();
  std::ranges::move(lateral_planner_figures(), std::back_inserter(figures));
  std::ranges::move(tracking_figures(), std::back_inserter(figures));
  std::ranges::move(steering_law_figures(), std::back_inserter(figures));
  return figures;
}

class FiguresCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Compute the paper's figures 2 to 10 and 12 to 14, each as SVG and CSV");
    arguments.add("-o,--output", folder_, "Folder for the figures").required();
    arguments.flag("-f,--force", force_, "Replace files in the folder");
    arguments.example("  roadbed figures -o figures");
  }

  Exit run(const Streams& streams, const CommonOptions&) override {
    map::make_output_folder(folder_, force_);
    const std::filesystem::path folder = folder_;
    for (const Figure& figure : all_figures()) {
      map::write_output(folder / (figure.name + ".svg"), chart_svg(figure.chart));
      map::write_output(folder / (figure.name + ".csv"), chart_csv(figure.chart));
      fmt::print(streams.out, "{}\n", (folder / figure.name).string());
    }
    return Exit::ok;
  }

 private:
  std::string folder_;
  bool force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_figures_command() { return std::make_unique<FiguresCommand>(); }

}  // namespace roadbed::tools::commands
