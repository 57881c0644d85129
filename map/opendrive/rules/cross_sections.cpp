// <crossSectionSurface>: strips that give the road its height across.

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <utility>

#include "roadbed/map/opendrive/rules/source.h"

namespace roadbed::map::opendrive::rules {
namespace {

using validation::Severity;

/// Calls `check(road, surface)` for every road that has one.
template <typename Check>
void for_each_surface(const Source& source, const Check& check) {
  for (const RoadSource& road : source.roads) {
    const auto surface = road.record.node.child("lateralProfile").child("crossSectionSurface");
    if (surface) check(road, surface);
  }
}

void surfaces_that_lean(const Source& source, const validation::ValidateOptions&,
                        validation::Report& report) {
  for_each_surface(source, [&](const RoadSource& road, pugi::xml_node surface) {
    for (const char* name : {"superelevation", "shape"}) {
      const auto other = surface.parent().child(name);
      if (!other) continue;
      add_at(report, source, road, other,
             fmt::format("has a <crossSectionSurface> and a <{}>, which are added up; keep one of "
                         "them",
                         name));
    }
  });
}

/// The strips of a side: inner and outer one.
struct Strips {
  pugi::xml_node inner, outer;
};

/// Calls `check(road, surface, strips, name)` for both sides of every surface.
template <typename Check>
void for_each_side(const Source& source, const Check& check) {
  for_each_surface(source, [&](const RoadSource& road, pugi::xml_node surface) {
    const auto strips = surface.child("surfaceStrips");
    for (const auto& [inner, outer] : {std::pair{"1", "2"}, {"-1", "-2"}}) {
      check(road, surface,
            Strips{strips.find_child_by_attribute("strip", "id", inner),
                   strips.find_child_by_attribute("strip", "id", outer)},
            inner);
    }
  });
}

void single_strips(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  for_each_side(source, [&](const RoadSource& road, pugi::xml_node surface, const Strips& strips,
                            const char* inner) {
    if (strips.inner && !strips.outer && strips.inner.child("width")) {
      add_at(report, source, road, strips.inner.child("width"),
             fmt::format("strip {} has a width although no strip is beyond it; remove the width, "
                         "the strip reaches to the road's edge",
                         inner));
    }
    if (strips.outer && !strips.inner) {
      add_at(report, source, road, surface,
             fmt::format("has no strip {}, so that the outer one does not hold; number the only "
                         "strip of a side {}",
                         inner, inner));
    }
  });
}

void strips_without_width(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  for_each_side(
      source, [&](const RoadSource& road, pugi::xml_node, const Strips& strips, const char* inner) {
        if (!strips.inner || !strips.outer || strips.inner.child("width").child("coefficients"))
          return;
        add_at(report, source, road, strips.inner,
               fmt::format("strip {} has no width, so that the outer one does not hold; add it",
                           inner));
      });
}

constexpr std::array<SourceRule, 3> kCrossSectionRules = {{
    {{"cross-section.leaning",
      "asam.net:xodr:1.8.0:road.cross_section_surface.no_shape_superelevation", Severity::warning,
      "a road has both a cross section surface and a superelevation or shape"},
     surfaces_that_lean},
    {{"cross-section.single-strip", "asam.net:xodr:1.8.0:road.cross_section_surface.use_strip",
      Severity::warning, "the only strip of a side has a width, or the number of an outer one"},
     single_strips},
    {{"cross-section.strip-width", "asam.net:xodr:1.8.0:road.cross_section_surface.use_width",
      Severity::warning, "the inner of two strips has no width"},
     strips_without_width},
}};

}  // namespace

std::span<const SourceRule> cross_section_rules() { return kCrossSectionRules; }

}  // namespace roadbed::map::opendrive::rules
