// What objects are made of: outlines, skeletons, markings, borders.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

#include "roadbed/map/opendrive/rules/furniture.h"

namespace roadbed::map::opendrive::rules {
namespace {

using validation::Severity;

/// Calls `check(road, object)` for every object.
template <typename Check>
void for_each_object(const Source& source, const Check& check) {
  for_each_thing(source, "objects", "object", check);
}

/// Calls `check(outline)` for every outline of an object.
template <typename Check>
void for_each_outline(pugi::xml_node object, const Check& check) {
  for (const auto outline : object.children("outline")) check(outline);
  for (const auto outline : object.child("outlines").children("outline")) check(outline);
}

std::ptrdiff_t count(pugi::xml_node parent, const char* name) {
  const auto children = parent.children(name);
  return std::distance(children.begin(), children.end());
}

void objects_without_orientation(const Source& source, const validation::ValidateOptions&,
                                 validation::Report& report) {
  if (!source.is_since(7)) return;
  for_each_object(source, [&](const RoadSource& road, pugi::xml_node object) {
    if (*object.attribute("orientation").value() != '\0') return;
    add_thing(
        report, source, road, object,
        "does not say for which direction it holds; add orientation=\"+\", \"-\" or \"none\"");
  });
}

void round_and_angular(const Source& source, const validation::ValidateOptions&,
                       validation::Report& report) {
  for_each_object(source, [&](const RoadSource& road, pugi::xml_node object) {
    const bool is_round = source.number(object, "radius") > 0.0;
    const bool is_angular =
        source.number(object, "width") > 0.0 || source.number(object, "length") > 0.0;
    if (!is_round || !is_angular) return;
    add_thing(report, source, road, object,
              "has both a radius and a width or length; keep the radius of a round object, or the "
              "width and length of an angular one");
  });
}

/// A list of corners or vertices, which describe a line only from two on.
struct Points {
  const char *on_road, *local;
  std::array<const char*, 2> curves;  ///< one of them is enough
};

constexpr Points kCorners = {"cornerRoad", "cornerLocal", {"curveLocal", "cornerLocalParamPoly3"}};
constexpr Points kVertices = {"vertexRoad", "vertexLocal", {"", ""}};

void find_empty(const Source& source, const RoadSource& road, pugi::xml_node object,
                pugi::xml_node line, const Points& points, validation::Report& report) {
  for (const char* name : {points.on_road, points.local, points.curves[0], points.curves[1]}) {
    if (line.child(name)) return;
  }
  add_thing(report, source, road, object,
            fmt::format("its <{}> {} has no points; add two or more <{}> or <{}>, or remove it",
                        line.name(), line.attribute("id").value(), points.on_road, points.local),
            line);
}

void find_lonely(const Source& source, const RoadSource& road, pugi::xml_node object,
                 pugi::xml_node line, const char* name, validation::Report& report) {
  if (count(line, name) != 1) return;
  add_thing(report, source, road, object,
            fmt::format("its <{}> {} has one <{}>, needs at least two; add the others", line.name(),
                        line.attribute("id").value(), name),
            line);
}

void find_mixed(const Source& source, const RoadSource& road, pugi::xml_node object,
                pugi::xml_node line, const Points& points, validation::Report& report) {
  if (!line.child(points.on_road) || !line.child(points.local)) return;
  add_thing(report, source, road, object,
            fmt::format("its <{}> {} has both <{}> and <{}>; describe it by one of them",
                        line.name(), line.attribute("id").value(), points.on_road, points.local),
            line);
}

/// Calls `check(road, object, outline)` for every outline of objects.
template <typename Check>
void for_each_outline_of_all(const Source& source, const Check& check) {
  for_each_object(source, [&](const RoadSource& road, pugi::xml_node object) {
    for_each_outline(object, [&](pugi::xml_node outline) { check(road, object, outline); });
  });
}

/// The same for the polylines of their skeletons.
template <typename Check>
void for_each_polyline(const Source& source, const Check& check) {
  for_each_object(source, [&](const RoadSource& road, pugi::xml_node object) {
    for (const auto polyline : object.child("skeleton").children("polyline")) {
      check(road, object, polyline);
    }
  });
}

void empty_outlines(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  for_each_outline_of_all(
      source, [&](const RoadSource& road, pugi::xml_node object, pugi::xml_node outline) {
        find_empty(source, road, object, outline, kCorners, report);
      });
}

template <bool on_road>
void lonely_corners(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  for_each_outline_of_all(source, [&](const RoadSource& road, pugi::xml_node object,
                                      pugi::xml_node outline) {
    find_lonely(source, road, object, outline, on_road ? kCorners.on_road : kCorners.local, report);
  });
}

void mixed_corners(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  for_each_outline_of_all(
      source, [&](const RoadSource& road, pugi::xml_node object, pugi::xml_node outline) {
        find_mixed(source, road, object, outline, kCorners, report);
      });
}

void empty_polylines(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for_each_polyline(source,
                    [&](const RoadSource& road, pugi::xml_node object, pugi::xml_node polyline) {
                      find_empty(source, road, object, polyline, kVertices, report);
                    });
}

template <bool on_road>
void lonely_vertices(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for_each_polyline(source,
                    [&](const RoadSource& road, pugi::xml_node object, pugi::xml_node polyline) {
                      find_lonely(source, road, object, polyline,
                                  on_road ? kVertices.on_road : kVertices.local, report);
                    });
}

void mixed_vertices(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  for_each_polyline(source,
                    [&](const RoadSource& road, pugi::xml_node object, pugi::xml_node polyline) {
                      find_mixed(source, road, object, polyline, kVertices, report);
                    });
}

std::set<std::string_view> corner_ids(pugi::xml_node object) {
  std::set<std::string_view> ids;
  for_each_outline(object, [&](pugi::xml_node outline) {
    for (const auto corner : outline.children()) {
      if (const auto id = corner.attribute("id")) ids.insert(id.value());
    }
  });
  return ids;
}

void markings_without_corner(const Source& source, const validation::ValidateOptions&,
                             validation::Report& report) {
  for_each_object(source, [&](const RoadSource& road, pugi::xml_node object) {
    const auto markings = object.child("markings");
    if (!markings) return;
    const std::set<std::string_view> corners = corner_ids(object);
    for (const auto marking : markings.children("marking")) {
      for (const auto reference : marking.children("cornerReference")) {
        if (corners.contains(reference.attribute("id").value())) continue;
        add_thing(report, source, road, object,
                  fmt::format("a marking of it refers to corner {}, which {}; correct it, or give "
                              "the marking a side",
                              reference.attribute("id").value(),
                              corners.empty() ? "no outline has" : "is in no outline"),
                  reference);
      }
    }
  });
}

/// Calls `check(road, object, border, is_complete)` for every border of objects.
template <typename Check>
void for_each_border(const Source& source, const Check& check) {
  for_each_object(source, [&](const RoadSource& road, pugi::xml_node object) {
    for (const auto border : object.child("borders").children("border")) {
      const std::string_view whole = border.attribute("useCompleteOutline").value();
      check(road, object, border, whole == "true" || whole == "1");
    }
  });
}

void borders_of_more(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for_each_border(source, [&](const RoadSource& road, pugi::xml_node object, pugi::xml_node border,
                              bool is_complete) {
    if (!is_complete || !border.child("cornerReference")) return;
    add_thing(report, source, road, object,
              "a border of it takes the complete outline but refers to corners; remove the "
              "references or useCompleteOutline",
              border);
  });
}

void borders_of_less(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  for_each_border(source, [&](const RoadSource& road, pugi::xml_node object, pugi::xml_node border,
                              bool is_complete) {
    const auto corners = count(border, "cornerReference");
    // Without the attribute and without corners it is the whole outline.
    if (is_complete || corners >= 2 || (corners == 0 && !border.attribute("useCompleteOutline"))) {
      return;
    }
    add_thing(report, source, road, object,
              fmt::format("a border of it refers to {} corners, needs at least two, or "
                          "useCompleteOutline=\"true\"; add them",
                          corners),
              border);
  });
}

constexpr std::array<SourceRule, 13> kObjectRules = {{
    {{"object.orientation", "asam.net:xodr:1.7.0:road.object.orientation", Severity::info,
      "an object of a revision 1.7 file or later does not say for which direction it holds"},
     objects_without_orientation},
    {{"object.two-shapes", "asam.net:xodr:1.7.0:road.object.circular_vs_angular", Severity::warning,
      "an object has both a radius and a width or length"},
     round_and_angular},
    {{"object.empty-outline", "asam.net:xodr:1.7.0:road.object.outline.outline_followed_by_corner",
      Severity::warning, "an outline of an object has no corner"},
     empty_outlines},
    {{"object.one-corner-road", "asam.net:xodr:1.7.0:road.corner_road.element_min_amount",
      Severity::warning, "an outline of an object has one <cornerRoad> only"},
     lonely_corners<true>},
    {{"object.one-corner-local", "asam.net:xodr:1.7.0:road.corner_local.element_min_amount",
      Severity::warning, "an outline of an object has one <cornerLocal> only"},
     lonely_corners<false>},
    {{"object.mixed-corners", "asam.net:xodr:1.9.0:road.corner_road.corner_road_local_exclusivity",
      Severity::warning, "an outline of an object has both <cornerRoad> and <cornerLocal>"},
     mixed_corners},
    {{"object.empty-polyline",
      "asam.net:xodr:1.8.0:road.object.skeleton.polyline_followed_by_vertex", Severity::warning,
      "a polyline of an object's skeleton has no vertex"},
     empty_polylines},
    {{"object.one-vertex-road",
      "asam.net:xodr:1.8.0:road.object.skeleton.vertex_road.element_min_amount", Severity::warning,
      "a polyline of an object's skeleton has one <vertexRoad> only"},
     lonely_vertices<true>},
    {{"object.one-vertex-local",
      "asam.net:xodr:1.8.0:road.object.skeleton.vertex_local.element_min_amount", Severity::warning,
      "a polyline of an object's skeleton has one <vertexLocal> only"},
     lonely_vertices<false>},
    {{"object.mixed-vertices",
      "asam.net:xodr:1.8.0:road.object.skeleton.vertex_road.polyline_elements", Severity::warning,
      "a polyline of an object's skeleton has <vertexRoad> and <vertexLocal>"},
     mixed_vertices},
    {{"object.marking-corner",
      "asam.net:xodr:1.7.0:road.object.marking.no_cornerreference_if_no_outline", Severity::warning,
      "a marking of an object refers to a corner that no outline of it has"},
     markings_without_corner},
    {{"object.border-complete", "asam.net:xodr:1.7.0:road.object.borders.useCompleteOutline_true",
      Severity::warning, "a border of an object takes the complete outline but refers to corners"},
     borders_of_more},
    {{"object.border-corners", "asam.net:xodr:1.7.0:road.object.borders.useCompleteOutline_false",
      Severity::warning,
      "a border of an object takes part of an outline but refers to fewer than two corners"},
     borders_of_less},
}};

}  // namespace

std::span<const SourceRule> object_rules() { return kObjectRules; }

}  // namespace roadbed::map::opendrive::rules
