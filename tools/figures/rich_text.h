#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roadbed::tools::inline figures {

/// Letters that stand on, below (`_x`, `_{fa}`) or above (`^2`, `^{−1}`) the line.
struct TextPiece {
  enum class Level { line, below, above } level = Level::line;
  std::string letters;
};
std::vector<TextPiece> pieces_of(std::string_view text);

/// An SVG text element whose letters are escaped.
/// @param width_px  it is as wide in any font; none: as wide as the font makes it.
std::string rich_text_svg(std::string_view css_class, const Eigen::Vector2d& at_px,
                          std::string_view text, std::optional<double> width_px = {});

/// In the proportions of usual fonts.
double rich_text_width_px(std::string_view text, double font_px);

/// Lines of whole words.
std::vector<std::string> wrapped(std::string_view text, double font_px, double width_px);

}  // namespace roadbed::tools::figures
