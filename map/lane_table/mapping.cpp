#include "roadbed/map/lane_table/mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/parse_json.h"
#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::lane_table {
namespace {

using Json = nlohmann::json;

class MappingReader {
 public:
  explicit MappingReader(const std::string& name) : name_(name) {}

  Mapping read(const std::string& bytes) {
    const Json root = parse(bytes);
    if (!root.is_object()) refuse("the document", "is no object", "{\"drawing\": \"centreline\"}");
    for (const auto& [key, value] : root.items()) take(key, value);
    return std::move(mapping_);
  }

 private:
  [[noreturn]] void refuse(const std::string& element, const std::string& found,
                           const std::string& needed) const {
    throw InputError({.file = name_,
                      .element = element,
                      .found = found,
                      .needed = needed,
                      .remedy = "see map/lane_table/README.md"});
  }

  Json parse(const std::string& bytes) const {
    try {
      return parse_json(bytes, name_, {.keys_stand_once = true, .most_levels = 8});
    } catch (const Json::exception& error) {
      refuse_json(error, name_);
    }
  }

  std::string text(const std::string& key, const Json& value) const {
    if (!value.is_string()) refuse(key, "is no text", "the name of a column");
    return value.get<std::string>();
  }

  NumberColumn number(const std::string& key, const Json& value) const {
    if (!value.is_number()) return {std::nullopt, text(key, value)};
    const double given = value.get<double>();
    if (!std::isfinite(given)) refuse(key, "is no finite number", "a number or a column");
    return {given, ""};
  }

  void take(const std::string& key, const Json& value) {
    if (key == "drawing") return take_drawing(text(key, value));
    if (key == "layer") return void(mapping_.layer = text(key, value));
    if (key == "lane") return void(mapping_.lane = text(key, value));
    if (key == "side") return void(mapping_.side = text(key, value));
    if (key == "width_m") return void(mapping_.width_m = number(key, value));
    if (key == "heading_deg") return void(mapping_.heading_deg = number(key, value));
    if (key == "type") return void(mapping_.type = text(key, value));
    if (key == "types") return take_types(value);
    if (key == "speed_kmh") return void(mapping_.speed_kmh = number(key, value));
    if (key == "successors") return void(mapping_.successors = text(key, value));
    if (key == "link_m") return take_link(value);
    refuse(
        one_line(key), "is not known",
        "drawing, layer, lane, side, width_m, heading_deg, type, types, speed_kmh, successors or "
        "link_m");
  }

  void take_drawing(const std::string& word) {
    if (word == "centreline") return void(mapping_.drawing = Drawing::centreline);
    if (word == "borders") return void(mapping_.drawing = Drawing::borders);
    if (word == "polygon") return void(mapping_.drawing = Drawing::polygon);
    refuse("drawing", fmt::format("is \"{}\"", one_line(word)), "centreline, borders or polygon");
  }

  void take_types(const Json& value) {
    if (!value.is_object()) refuse("types", "is no object", "{\"word\": \"driving\"}");
    for (const auto& [word, type] : value.items()) {
      const std::string name = text("types", type);
      std::optional<LaneType> found;
      for (int i = 0; i <= static_cast<int>(LaneType::other); ++i) {
        if (to_string(static_cast<LaneType>(i)) == name) found = static_cast<LaneType>(i);
      }
      if (!found) {
        refuse("types", fmt::format("\"{}\" is no type of lane", one_line(name)),
               "driving, biking, bus, sidewalk, shoulder, parking, …");
      }
      mapping_.types.emplace(word, *found);
    }
  }

  void take_link(const Json& value) {
    const bool fits = value.is_number() && value.get<double>() > 0.0 && value.get<double>() <= 10.0;
    if (!fits) refuse("link_m", "is no distance", "a number above 0, at most 10");
    mapping_.link_m = value.get<double>();
  }

  const std::string& name_;
  Mapping mapping_;
};

}  // namespace

Mapping read_mapping(const std::string& bytes, const std::string& name) {
  return MappingReader(name).read(bytes);
}

}  // namespace roadbed::map::lane_table
