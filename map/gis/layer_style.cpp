#include "roadbed/map/gis/geopackage_content.h"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/files/xml_characters.h"

namespace roadbed::map::inline gis {
namespace {

/// What a symbol looks like. Colours are "red,green,blue,alpha" from 0 to 255.
struct Look {
  std::string value;  ///< of the column; empty: all other values
  std::string fill;   ///< of areas and markers; empty: none
  std::string line = "43,47,54,255";
  double width_mm = 0.1;
  std::string dash = {};    ///< "3;2" in millimetres; empty: solid
  std::string marker = {};  ///< of points: "circle", "triangle", …
  double size_mm = 2.2;
};

struct Style {
  std::string column;  ///< empty: one symbol for all
  std::vector<Look> looks;
};

const std::string kNone = "0,0,0,0";

Style lane_style() {
  const auto look = [](std::string_view type, std::string_view fill) {
    return Look{std::string(type), std::string(fill), "255,255,255,160", 0.1};
  };
  return {"type",
          {look("driving", "77,83,92,255"), look("bidirectional", "90,84,100,255"),
           look("entry", "77,90,92,255"), look("exit", "77,90,92,255"),
           look("onRamp", "77,90,92,255"), look("offRamp", "77,90,92,255"),
           look("connectingRamp", "77,90,92,255"), look("bus", "109,85,96,255"),
           look("taxi", "109,85,96,255"), look("biking", "201,139,125,255"),
           look("sidewalk", "220,214,202,255"), look("shoulder", "191,186,176,255"),
           look("border", "191,186,176,255"), look("curb", "170,165,156,255"),
           look("median", "197,211,174,255"), look("parking", "143,152,166,255"),
           look("stop", "143,152,166,255"), look("", "203,185,168,255")}};
}

Style border_style() {
  const std::string white = "255,255,255,255";
  return {"mark",
          {{"solid", "", white, 0.3},
           {"solid_solid", "", white, 0.6},
           {"broken", "", white, 0.3, "3;2"},
           {"solid_broken", "", white, 0.5},
           {"broken_solid", "", white, 0.5},
           {"broken_broken", "", white, 0.5, "3;2"},
           {"curb", "", "120,116,108,255", 0.4},
           {"grass", "", "130,160,100,255", 0.3},
           {"edge", "", "43,47,54,255", 0.4},
           {"none", "", "160,165,172,140", 0.1},
           {"", "", "160,165,172,200", 0.1}}};
}

Style finding_style() {
  const std::string ink = "255,255,255,255";
  return {"severity",
          {{"error", "214,40,40,255", ink, 0.3, "", "diamond", 4.0},
           {"warning", "247,170,30,255", ink, 0.3, "", "triangle", 3.6},
           {"info", "60,130,200,255", ink, 0.3, "", "circle", 2.6}}};
}

Style signal_style() {
  return {"dynamic",
          {{"1", "85,194,106,255", "43,47,54,255", 0.4, "", "circle", 2.6},
           {"0", "255,255,255,255", "200,55,45,255", 0.5, "", "circle", 2.2}}};
}

Style object_style() {
  const std::string ink = "43,47,54,255";
  return {"type",
          {{"crosswalk", "255,255,255,200", ink, 0.1},
           {"parkingSpace", "143,152,166,160", "255,255,255,255", 0.2},
           {"building", "205,195,180,255", "150,140,125,255", 0.2},
           {"", "190,160,110,150", ink, 0.1}}};
}

Style style_of(const std::string& layer) {
  const std::string ink = "43,47,54,255";
  if (layer == "lanes") return lane_style();
  if (layer == "borders") return border_style();
  if (layer == "findings") return finding_style();
  if (layer == "signals") return signal_style();
  if (layer == "objects") return object_style();
  if (layer == "roads") return {"", {{"", "214,209,199,255", "150,145,135,255", 0.2}}};
  if (layer == "junctions") return {"", {{"", "196,160,110,110", "150,110,60,255", 0.3}}};
  if (layer == "drivable_surface") return {"", {{"", "77,83,92,90", ink, 0.4}}};
  if (layer == "areas") return {"", {{"", "220,214,202,160", "150,145,135,255", 0.2}}};
  if (layer == "centrelines") return {"", {{"", "", "70,160,215,255", 0.2, "4;2"}}};
  if (layer == "stop_lines") return {"", {{"", "", "200,55,45,255", 0.6}}};
  return {"", {{"", "190,160,110,255", ink, 0.2, "", "square", 1.8}}};
}

using Properties = std::vector<std::pair<std::string_view, std::string>>;

std::string symbol_layer(std::string_view type, const Properties& properties) {
  std::string options;
  for (const auto& [key, value] : properties) {
    options += fmt::format(R"(<Option type="QString" name="{}" value="{}"/>)", key, value);
  }
  return fmt::format(
      R"(<layer class="{}" enabled="1" locked="0" pass="0"><Option type="Map">{}</Option></layer>)",
      type, options);
}

std::string fill_layer(const Look& look) {
  return symbol_layer("SimpleFill", {{"color", look.fill.empty() ? kNone : look.fill},
                                     {"style", look.fill.empty() ? "no" : "solid"},
                                     {"outline_color", look.line},
                                     {"outline_style", "solid"},
                                     {"outline_width", fmt::format("{}", look.width_mm)},
                                     {"outline_width_unit", "MM"},
                                     {"joinstyle", "round"}});
}

std::string line_layer(const Look& look) {
  return symbol_layer("SimpleLine", {{"line_color", look.line},
                                     {"line_style", "solid"},
                                     {"line_width", fmt::format("{}", look.width_mm)},
                                     {"line_width_unit", "MM"},
                                     {"joinstyle", "round"},
                                     {"capstyle", "flat"},
                                     {"use_custom_dash", look.dash.empty() ? "0" : "1"},
                                     {"customdash", look.dash.empty() ? "5;2" : look.dash},
                                     {"customdash_unit", "MM"}});
}

std::string marker_layer(const Look& look) {
  return symbol_layer("SimpleMarker", {{"name", look.marker},
                                       {"color", look.fill},
                                       {"outline_color", look.line},
                                       {"outline_width", fmt::format("{}", look.width_mm)},
                                       {"outline_width_unit", "MM"},
                                       {"size", fmt::format("{}", look.size_mm)},
                                       {"size_unit", "MM"}});
}

std::string symbol(ShapeKind shape, const Look& look, std::size_t number) {
  const bool is_area = shape == ShapeKind::polygon || shape == ShapeKind::multi_polygon;
  const char* type = is_area ? "fill" : shape == ShapeKind::line ? "line" : "marker";
  const std::string layer = is_area                    ? fill_layer(look)
                            : shape == ShapeKind::line ? line_layer(look)
                                                       : marker_layer(look);
  return fmt::format(
      R"(<symbol type="{}" name="{}" alpha="1" clip_to_extent="1" force_rhr="0">{}</symbol>)", type,
      number, layer);
}

std::string category(const Look& look, std::size_t number) {
  const std::string value = xml_text(look.value);
  return fmt::format(R"(<category value="{}" label="{}" symbol="{}" render="true"/>)", value,
                     look.value.empty() ? "other" : value, number);
}

}  // namespace

std::string qgis_style(const Layer& layer) {
  const Style style = style_of(layer.name);
  std::string symbols, categories;
  for (std::size_t i = 0; i < style.looks.size(); ++i) {
    symbols += symbol(layer.shape, style.looks[i], i);
    categories += category(style.looks[i], i);
  }
  const std::string renderer =
      style.column.empty()
          ? fmt::format(R"(<renderer-v2 type="singleSymbol" enableorderby="0" forceraster="0" )"
                        R"(symbollevels="0"><symbols>{}</symbols></renderer-v2>)",
                        symbols)
          : fmt::format(R"(<renderer-v2 type="categorizedSymbol" attr="{}" enableorderby="0" )"
                        R"(forceraster="0" symbollevels="0"><categories>{}</categories>)"
                        R"(<symbols>{}</symbols></renderer-v2>)",
                        style.column, categories, symbols);
  return "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>"
         R"(<qgis version="3.22.0" styleCategories="Symbology">)" +
         renderer + "</qgis>";
}

}  // namespace roadbed::map::gis
