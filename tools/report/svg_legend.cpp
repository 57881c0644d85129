#include "roadbed/tools/report/svg_legend.h"

#include <fmt/format.h>

#include "roadbed/tools/report/speed_colour.h"
#include "roadbed/tools/report/svg.h"

namespace roadbed::tools::inline report {
namespace {

constexpr double kSwatch_px = 9.0;
constexpr double kLetter_px = 7.0;  // of a 12 px font, on average and a little more

}  // namespace

void SvgLegend::add(std::string_view attributes, std::string_view text) {
  svg_ += fmt::format("<rect {} x=\"{}\" y=\"{}\" width=\"18\" height=\"9\" rx=\"1.5\"/>\n",
                      attributes, svg_number(x_px_), svg_number(y_px_ - kSwatch_px));
  svg_ += svg_text("", {x_px_ + 25.0, y_px_}, text);
  x_px_ += 25.0 + kLetter_px * static_cast<double>(text.size()) + 22.0;
}

void SvgLegend::add_speeds(double top_mps) {
  constexpr int kSteps = 24;
  constexpr double kStep_px = 5.0;
  for (int i = 0; i < kSteps; ++i) {
    svg_ += fmt::format("<rect fill=\"{}\" x=\"{}\" y=\"{}\" width=\"5.2\" height=\"9\"/>\n",
                        speed_colour((i + 0.5) / kSteps), svg_number(x_px_ + kStep_px * i),
                        svg_number(y_px_ - kSwatch_px));
  }
  x_px_ += kSteps * kStep_px;
  svg_ += svg_text("", {x_px_ + 7.0, y_px_}, fmt::format("driven at 0 to {:.1f} m/s", top_mps));
  x_px_ += 180.0;
}

}  // namespace roadbed::tools
