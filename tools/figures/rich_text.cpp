#include "roadbed/tools/figures/rich_text.h"

#include <fmt/format.h>

#include "roadbed/map/drawing/svg.h"
#include "roadbed/map/files/xml_characters.h"

namespace roadbed::tools::inline figures {
namespace {

using Level = TextPiece::Level;

constexpr double kSmall = 0.72;  // of the font
constexpr double kShift_em = 0.3;

/// Bytes of the UTF-8 letter that begins at a place.
std::size_t letter_size(std::string_view text, std::size_t at) {
  std::size_t size = 1;
  while (at + size < text.size() &&
         (static_cast<unsigned char>(text[at + size]) & 0xC0U) == 0x80U) {
    ++size;
  }
  return size;
}

}  // namespace

std::vector<TextPiece> pieces_of(std::string_view text) {
  std::vector<TextPiece> pieces;
  const auto add = [&](Level level, std::string_view letters) {
    if (pieces.empty() || pieces.back().level != level) pieces.push_back({level, {}});
    pieces.back().letters += letters;
  };
  for (std::size_t at = 0; at < text.size();) {
    const bool is_mark = (text[at] == '_' || text[at] == '^') && at + 1 < text.size();
    if (!is_mark) {
      add(Level::line, text.substr(at, 1));
      ++at;
      continue;
    }
    const Level level = text[at] == '_' ? Level::below : Level::above;
    const std::size_t close = text[at + 1] == '{' ? text.find('}', at) : std::string_view::npos;
    if (close != std::string_view::npos) {
      add(level, text.substr(at + 2, close - at - 2));
      at = close + 1;
    } else {
      const std::size_t size = letter_size(text, at + 1);
      add(level, text.substr(at + 1, size));
      at += 1 + size;
    }
  }
  return pieces;
}

std::string rich_text_svg(std::string_view css_class, const Eigen::Vector2d& at_px,
                          std::string_view text, std::optional<double> width_px) {
  std::string inner;
  double shift_em = 0.0;  // of the last letters, in sizes of the whole font
  for (const TextPiece& piece : pieces_of(text)) {
    const double asked_em = piece.level == Level::line    ? 0.0
                            : piece.level == Level::below ? kShift_em
                                                          : -kShift_em;
    const double size = piece.level == Level::line ? 1.0 : kSmall;
    inner += asked_em == shift_em && size == 1.0
                 ? map::html_text(piece.letters)
                 : fmt::format("<tspan dy=\"{:.2f}em\"{}>{}</tspan>", (asked_em - shift_em) / size,
                               size == 1.0 ? "" : fmt::format(" font-size=\"{}em\"", kSmall),
                               map::html_text(piece.letters));
    shift_em = asked_em;
  }
  const std::string width =
      width_px ? fmt::format(" textLength=\"{}\" lengthAdjust=\"spacingAndGlyphs\"",
                             map::svg_number(*width_px))
               : "";
  return fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\"{}>{}</text>\n", css_class,
                     map::svg_number(at_px.x()), map::svg_number(at_px.y()), width, inner);
}

double rich_text_width_px(std::string_view text, double font_px) {
  double width_px = 0.0;
  for (const TextPiece& piece : pieces_of(text)) {
    width_px +=
        map::usual_width_px(piece.letters, piece.level == Level::line ? font_px : kSmall * font_px);
  }
  return width_px;
}

std::vector<std::string> wrapped(std::string_view text, double font_px, double width_px) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    const std::string longer =
        lines.empty() ? std::string(word) : lines.back() + " " + std::string(word);
    if (!lines.empty() && rich_text_width_px(longer, font_px) <= width_px) {
      lines.back() = longer;
    } else {
      lines.emplace_back(word);
    }
    text.remove_prefix(word.size());
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  }
  return lines;
}

}  // namespace roadbed::tools::figures
