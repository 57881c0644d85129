#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "roadbed/map/drawing/svg.h"
#include "roadbed/map/drawing/svg_drawing.h"
#include "roadbed/map/files/xml_characters.h"

namespace roadbed::map::inline drawing::svg {
namespace {

/// Writes in pixels from the caption's upper left corner.
class Caption {
 public:
  explicit Caption(Drawing& drawing)
      : drawing_(drawing), px_(drawing.sheet.px_m), top_m_(drawing.sheet.size_m.y()) {}

  double width_px() const { return drawing_.sheet.size_m.x() / px_; }

  void text(double x_px, double y_px, double size_px, std::string_view words,
            std::string_view more = {}) {
    drawing_.canvas.add(
        fmt::format(R"(<text x="{:.2f}" y="{:.2f}" font-size="{:.3f}" {}>{}</text>)", x(x_px),
                    y(y_px), size_px * px_, more, html_text(words)));
  }
  /// Attributes of a text that is so wide in any font.
  std::string as_wide_as(double width_px) const {
    return fmt::format(R"(textLength="{:.3f}" lengthAdjust="spacingAndGlyphs")", width_px * px_);
  }
  void path(const std::string& data_px, std::string_view attributes) {
    drawing_.canvas.add(
        fmt::format(R"svg(<path transform="translate(0 {:.3f}) scale({:.6f})" {} d="{}"/>)svg",
                    top_m_, px_, attributes, data_px));
  }

 private:
  double x(double px) const { return px * px_; }
  double y(double px) const { return top_m_ + px * px_; }

  Drawing& drawing_;
  double px_, top_m_;
};

/// A bar of four fields in turn dark and light, and how long it is.
void draw_scale_bar(const Drawing& drawing, Caption& caption) {
  const double length_m = round_length_m(0.18 * drawing.sheet.size_m.x());
  const double field_px = 0.25 * length_m / drawing.sheet.px_m;
  const double left_px = caption.width_px() - 78.0 - 4.0 * field_px, y_px = 34.0;
  for (int i = 0; i < 4; ++i) {
    caption.path(
        fmt::format("M{:.2f} {:.2f}h{:.2f}v6h{:.2f}z", left_px + i * field_px, y_px, field_px,
                    -field_px),
        fmt::format(R"(fill="{}" stroke="{}" stroke-width="1")", i % 2 == 0 ? kInk : kWhite, kInk));
  }
  caption.text(left_px, y_px - 7.0, 13, "0", R"(text-anchor="middle")");
  caption.text(left_px + 4.0 * field_px, y_px - 7.0, 13, fmt::format("{} m", length_m),
               R"(text-anchor="middle")");
}

void draw_north(Caption& caption) {
  const double x_px = caption.width_px() - 34.0;
  caption.path(fmt::format("M{:.2f} 20l8 24l-8 -6z", x_px), fmt::format(R"(fill="{}")", kInk));
  caption.path(fmt::format("M{:.2f} 20l-8 24l8 -6z", x_px),
               fmt::format(R"(fill="{}" stroke="{}" stroke-width="0.8")", kWhite, kInk));
  caption.text(x_px, 15, 13, "N", R"(text-anchor="middle" font-weight="bold")");
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

struct LegendItem {
  std::string colour, words;
};

std::vector<LegendItem> legend_of(const Drawing& drawing) {
  std::vector<LegendItem> items = {{kAsphalt, "carriageway"}};
  const Shown& shown = drawing.shown;
  if (shown.junctions) items.push_back({kJunction, "junction"});
  std::vector<LaneType> ground = shown.ground;
  std::sort(ground.begin(), ground.end());
  for (const LaneType type : ground) {
    items.push_back({std::string(ground_colour(type)),
                     type == LaneType::none ? "verge" : std::string(to_string(type))});
  }
  if (shown.stop_lines) items.push_back({kStop, "stop line"});
  if (shown.lights) items.push_back({kInk, "traffic light"});
  if (shown.signs) items.push_back({"#c8372d", "sign"});
  return items;
}

void draw_legend(const Drawing& drawing, Caption& caption) {
  constexpr double kSide_px = 24.0, kFont_px = 13.0;
  const std::vector<LegendItem> items = legend_of(drawing);
  double swatches_px = 0.0, words_px = 0.0;
  for (const LegendItem& item : items) {
    swatches_px += 46.0;
    words_px += usual_width_px(item.words, kFont_px);
  }
  // As wide as the letters are, or as there is room for.
  const double room_px = std::max(caption.width_px() - 2.0 * kSide_px - swatches_px, 0.0);
  const double share = std::min(1.0, room_px / words_px);
  double x_px = kSide_px;
  for (const LegendItem& item : items) {
    caption.path(fmt::format("M{:.2f} 63h18v12h-18z", x_px),
                 fmt::format(R"(fill="{}" stroke="{}" stroke-width="0.6")", item.colour, kFaint));
    const double width_px = share * usual_width_px(item.words, kFont_px);
    caption.text(x_px + 24.0, 74.0, kFont_px, item.words, caption.as_wide_as(width_px));
    x_px += 46.0 + width_px;
  }
}

}  // namespace

void draw_caption(Drawing& drawing) {
  const RoadMap& road_map = drawing.road_map;
  Caption caption(drawing);
  caption.path(fmt::format("M0 0h{:.2f}", caption.width_px()),
               fmt::format(R"(fill="none" stroke="{}" stroke-width="1")", "#d8d3c8"));
  caption.text(24, 28, 19,
               fmt::format("{} · {} · {} · {}", counted(road_map.roads().size(), "road"),
                           counted(road_map.lanes().size(), "lane"),
                           counted(road_map.junctions().size(), "junction"),
                           counted(road_map.signals().size(), "signal")),
               R"(font-weight="600")");
  std::string crs = road_map.crs().empty() ? "coordinate system unknown" : road_map.crs();
  if (crs.size() > 90) crs = crs.substr(0, 88) + " …";
  caption.text(24, 48, 13, road_map.format() + " · " + crs, fmt::format(R"(fill="{}")", kFaint));
  draw_legend(drawing, caption);
  draw_scale_bar(drawing, caption);
  draw_north(caption);
}

}  // namespace roadbed::map::drawing::svg
