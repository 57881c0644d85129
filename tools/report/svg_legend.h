#pragma once

#include <string>
#include <string_view>

namespace roadbed::tools::inline report {

/// Colour of a fraction 0 … 1 of the largest speed, "#rrggbb": from dark violet over teal to
/// yellow, as bright as the fraction is large (stops of viridis, matplotlib, CC0), told apart by
/// all kinds of colour vision.
std::string speed_colour(double fraction);

/// Entries of a picture's legend, one beside the other on one line; as wide in any font.
class SvgLegend {
 public:
  explicit SvgLegend(double baseline_px) : y_px_(baseline_px) {}

  /// A swatch that looks as its attributes say (`class="ego"`), and what it means.
  void add(std::string_view attributes, std::string_view text);

  /// The colours of speeds from 0 to `top_mps`.
  void add_speeds(double top_mps);

  const std::string& svg() const { return svg_; }

 private:
  void add_text(std::string_view text);

  double x_px_ = 18.0;
  double y_px_;
  std::string svg_;
};

}  // namespace roadbed::tools::report
