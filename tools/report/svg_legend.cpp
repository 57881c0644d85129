#include "roadbed/tools/report/svg_legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "roadbed/map/drawing/svg.h"

namespace roadbed::tools::inline report {
namespace {

using Colour = std::array<double, 3>;
constexpr std::array<Colour, 6> kStops = {
    {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};

constexpr double kSwatch_px = 9.0;
constexpr double kFont_px = 12.0;

}  // namespace

std::string speed_colour(double fraction) {
  const double place = std::clamp(fraction, 0.0, 1.0) * (kStops.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const double part = place - static_cast<double>(below);
  Colour mixed{};
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    mixed[i] = std::round((1.0 - part) * kStops[below][i] + part * kStops[below + 1][i]);
  }
  return fmt::format("#{:02x}{:02x}{:02x}", static_cast<int>(mixed[0]), static_cast<int>(mixed[1]),
                     static_cast<int>(mixed[2]));
}

void SvgLegend::add(std::string_view attributes, std::string_view text) {
  svg_ += fmt::format("<rect {} x=\"{}\" y=\"{}\" width=\"18\" height=\"9\" rx=\"1.5\"/>\n",
                      attributes, map::svg_number(x_px_), map::svg_number(y_px_ - kSwatch_px));
  x_px_ += 25.0;
  add_text(text);
}

void SvgLegend::add_text(std::string_view text) {
  const double width_px = map::usual_width_px(text, kFont_px);
  svg_ += map::svg_text_of_width("", {x_px_, y_px_}, text, width_px);
  x_px_ += width_px + 22.0;
}

void SvgLegend::add_speeds(double top_mps) {
  constexpr int kSteps = 24;
  constexpr double kStep_px = 5.0;
  for (int i = 0; i < kSteps; ++i) {
    svg_ += fmt::format("<rect fill=\"{}\" x=\"{}\" y=\"{}\" width=\"5.2\" height=\"9\"/>\n",
                        speed_colour((i + 0.5) / kSteps), map::svg_number(x_px_ + kStep_px * i),
                        map::svg_number(y_px_ - kSwatch_px));
  }
  x_px_ += kSteps * kStep_px + 7.0;
  add_text(fmt::format("driven at 0 to {:.1f} m/s", top_mps));
}

}  // namespace roadbed::tools::report
