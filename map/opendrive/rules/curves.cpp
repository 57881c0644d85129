#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "roadbed/geometry/primitives/angle.h"
#include "roadbed/map/opendrive/element_readers.h"
#include "roadbed/map/opendrive/rules/source.h"

namespace roadbed::map::opendrive::rules {
namespace {

constexpr double kGap_m = 1e-3;  // files round s to a few digits

validation::Finding& add(validation::Report& report, const Source& source, const RoadSource& road,
                         const CurveSource& piece, std::string message) {
  validation::Finding& finding =
      add_at(report, source, road, piece.record.node, std::move(message));
  if (piece.start) finding.in_map = piece.start->pose.position();
  return finding;
}

void missing_curves(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    if (!road.geometry.empty()) continue;
    add_at(report, source, road, road.record.node,
           "has no reference line; add a planView with at least one geometry");
  }
}

void unordered_curves(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (std::size_t i = 1; i < road.geometry.size(); ++i) {
      const CurveSource &before = road.geometry[i - 1], &piece = road.geometry[i];
      if (!(piece.record.s_m < before.record.s_m)) continue;
      add(report, source, road, piece,
          fmt::format("geometry at s {} m stands behind that at s {} m; list them in order of s",
                      piece.record.s_m, before.record.s_m));
    }
  }
}

void wrong_stations(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    double sum_m = 0.0;
    for (const CurveSource& piece : road.geometry) {
      const double off_m = piece.record.s_m - sum_m;
      if (std::abs(off_m) > kGap_m) {
        add(report, source, road, piece,
            fmt::format("geometry says s {:.4f} m, but those before it end at {:.4f} m; correct s "
                        "or a length",
                        piece.record.s_m, sum_m));
      }
      sum_m = piece.record.s_m +
              piece.record.length_m;  // one finding per slip, not for all that follow
    }
  }
}

/// Calls `check(before, after)` for every two neighbouring curves whose numbers are whole.
template <typename Check>
void for_each_joint(const RoadSource& road, const Check& check) {
  for (std::size_t i = 1; i < road.geometry.size(); ++i) {
    const CurveSource &before = road.geometry[i - 1], &after = road.geometry[i];
    if (before.end && after.start) check(before, after);
  }
}

void curve_gaps(const Source& source, const validation::ValidateOptions& options,
                validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for_each_joint(road, [&](const CurveSource& before, const CurveSource& after) {
      const double gap_m = (after.start->pose.position() - before.end->pose.position()).norm();
      if (gap_m <= options.max_gap_m) return;
      validation::Finding& finding = add(
          report, source, road, after,
          fmt::format("the curve at s {:.3f} m starts {:.3f} m off the end of the one before it; "
                      "correct x, y, the heading or a length",
                      after.record.s_m, gap_m));
      if (gap_m > 0.5) finding.severity = validation::Severity::error;
    });
  }
}

void curve_kinks(const Source& source, const validation::ValidateOptions& options,
                 validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for_each_joint(road, [&](const CurveSource& before, const CurveSource& after) {
      const double kink_rad =
          geometry::wrap_angle(after.start->pose.heading_rad - before.end->pose.heading_rad);
      if (!(std::abs(kink_rad) > options.max_kink_rad)) return;
      add(report, source, road, after,
          fmt::format("the curve at s {:.3f} m turns by {:.3f} rad against the one before it; "
                      "correct hdg or a curvature",
                      after.record.s_m, kink_rad));
    });
  }
}

void curvature_jumps(const Source& source, const validation::ValidateOptions& options,
                     validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    const CurveSource* worst = nullptr;
    double worst_jump = options.max_curvature_jump_per_m;
    for_each_joint(road, [&](const CurveSource& before, const CurveSource& after) {
      const double jump = std::abs(after.start->curvature_per_m - before.end->curvature_per_m);
      if (!(jump > worst_jump)) return;
      worst = &after;
      worst_jump = jump;
    });
    if (worst == nullptr) continue;
    add(report, source, road, *worst,
        fmt::format("curvature jumps by {:.3f} 1/m at s {:.3f} m, which no steering wheel does; "
                    "put a spiral between, or a wider arc",
                    worst_jump, worst->record.s_m));
  }
}

void zero_lengths(const Source& source, const validation::ValidateOptions&,
                  validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    if (road.record.length_m <= 0.0) {
      add_at(report, source, road, road.record.node,
             fmt::format("its length is {} m; give it a positive one or remove it",
                         road.record.length_m))
          .severity = validation::Severity::error;
    }
    for (const CurveSource& piece : road.geometry) {
      if (!(piece.record.length_m < kShortestPieceM)) continue;
      validation::Finding& finding =
          add_at(report, source, road, piece.record.node,
                 fmt::format("geometry at s {} m has length {} m; remove it", piece.record.s_m,
                             piece.record.length_m));
      // What is left of rounding does no harm: the piece is left out.
      if (piece.record.length_m > 0.0) finding.severity = validation::Severity::info;
    }
  }
}

void wrong_road_lengths(const Source& source, const validation::ValidateOptions& options,
                        validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    if (road.geometry.empty()) continue;
    const double end_m = road.geometry.back().record.s_m + road.geometry.back().record.length_m;
    if (!(std::abs(end_m - road.record.length_m) > options.max_gap_m)) continue;
    add_at(report, source, road, road.record.node,
           fmt::format("its length is {:.4f} m, but its reference line ends at {:.4f} m; correct "
                       "one of them",
                       road.record.length_m, end_m));
  }
}

void absurd_lengths(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  constexpr double kLongest = 2e5;  // [m]
  for (const RoadSource& road : source.roads) {
    if (!(road.record.length_m > kLongest)) continue;
    add_at(report, source, road, road.record.node,
           fmt::format("is {:.0f} km long; check the unit of its length",
                       road.record.length_m / 1000.0));
  }
}

const geometry::ParamPoly3Curve* param_poly3(const CurveSource& piece) {
  return piece.start ? std::get_if<geometry::ParamPoly3Curve>(&piece.record.piece->curve) : nullptr;
}

bool fits(const CurveSource& piece, geometry::ParamPoly3Curve curve, double p_end) {
  constexpr double kOff_m = 1e-3;  // as in ASAM's checker
  curve.p_end = p_end;
  return std::abs(geometry::arc_length_m(curve) - piece.record.length_m) <= kOff_m;
}

void wrong_param_poly3_lengths(const Source& source, const validation::ValidateOptions&,
                               validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const CurveSource& piece : road.geometry) {
      const auto* curve = param_poly3(piece);
      if (curve == nullptr || fits(piece, *curve, curve->p_end)) continue;
      add(report, source, road, piece,
          fmt::format("paramPoly3 at s {:.3f} m is {:.4f} m long, but its length says {:.4f} m; "
                      "correct one of them",
                      piece.record.s_m, geometry::arc_length_m(*curve), piece.record.length_m));
    }
  }
}

/// Whether a paramPoly3 whose length does not fit would fit with the other kind of range.
bool other_range_fits(const CurveSource& piece, bool arc_length) {
  const auto* curve = param_poly3(piece);
  const std::string_view range = piece.record.node.child("paramPoly3").attribute("pRange").value();
  if (curve == nullptr || (range == "arcLength") != arc_length) return false;
  return !fits(piece, *curve, curve->p_end) &&
         fits(piece, *curve, arc_length ? 1.0 : piece.record.length_m);
}

template <bool arc_length>
void wrong_param_poly3_ranges(const Source& source, const validation::ValidateOptions&,
                              validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const CurveSource& piece : road.geometry) {
      if (!other_range_fits(piece, arc_length)) continue;
      add(report, source, road, piece,
          fmt::format("paramPoly3 at s {:.3f} m has its length only if p runs {}; set pRange to {}",
                      piece.record.s_m, arc_length ? "from 0 to 1" : "from 0 to its length",
                      arc_length ? "normalized" : "arcLength"));
    }
  }
}

void shifted_param_poly3s(const Source& source, const validation::ValidateOptions&,
                          validation::Report& report) {
  constexpr double kNone = 1e-6;
  for (const RoadSource& road : source.roads) {
    for (const CurveSource& piece : road.geometry) {
      const auto* curve = param_poly3(piece);
      if (curve == nullptr) continue;
      const double slope = std::abs(curve->v[1]) / std::max(std::abs(curve->u[1]), kNone);
      if (std::abs(curve->u[0]) <= kNone && std::abs(curve->v[0]) <= kNone && slope <= kNone &&
          curve->u[1] > 0.0) {
        continue;
      }
      add(report, source, road, piece,
          fmt::format("paramPoly3 at s {:.3f} m does not start at x, y along hdg; make aU, aV and "
                      "bV zero and bU positive",
                      piece.record.s_m));
    }
  }
}

void several_shapes(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const CurveSource& piece : road.geometry) {
      int shapes = 0;
      for (const char* name : {"line", "arc", "spiral", "poly3", "paramPoly3"}) {
        for ([[maybe_unused]] const auto shape : piece.record.node.children(name)) ++shapes;
      }
      if (shapes <= 1) continue;
      add(report, source, road, piece,
          fmt::format("geometry at s {:.3f} m has {} curves; keep one", piece.record.s_m, shapes));
    }
  }
}

void straight_arcs(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const CurveSource& piece : road.geometry) {
      const auto arc = piece.record.node.child("arc");
      if (!arc || source.number(arc, "curvature") != 0.0) continue;
      add(report, source, road, piece,
          fmt::format("arc at s {:.3f} m has no curvature; make it a line", piece.record.s_m));
    }
  }
}

void constant_spirals(const Source& source, const validation::ValidateOptions&,
                      validation::Report& report) {
  for (const RoadSource& road : source.roads) {
    for (const CurveSource& piece : road.geometry) {
      const auto spiral = piece.record.node.child("spiral");
      if (!spiral || source.number(spiral, "curvStart") != source.number(spiral, "curvEnd")) {
        continue;
      }
      add(report, source, road, piece,
          fmt::format("spiral at s {:.3f} m keeps its curvature; make it an arc or a line",
                      piece.record.s_m));
    }
  }
}

constexpr std::array<SourceRule, 16> kCurveRules = {{
    {{"curve.missing", "asam.net:xodr:1.4.0:road.geometry.refline_exists",
      validation::Severity::error, "a road has no reference line"},
     missing_curves},
    {{"curve.order", "asam.net:xodr:1.4.0:road.geometry.elem_asc_order",
      validation::Severity::warning, "the curves of a reference line are not in order of s"},
     unordered_curves},
    {{"curve.station", "asam.net:xodr:1.9.0:road.geometry.s-value_sum",
      validation::Severity::warning, "a curve's s is not the sum of the lengths before it"},
     wrong_stations},
    {{"curve.gap", "asam.net:xodr:1.4.0:road.geometry.refline_no_gaps",
      validation::Severity::warning,
      "a curve does not start where the one before it ends, within --max-gap"},
     curve_gaps},
    {{"curve.kink", "asam.net:xodr:1.4.0:road.geometry.refline_no_kinks",
      validation::Severity::warning,
      "a curve does not go on in the direction of the one before it, within --max-kink"},
     curve_kinks},
    {{"curve.curvature-jump",
      {},
      validation::Severity::info,
      "curvature jumps between two curves by more than --max-curvature-jump"},
     curvature_jumps},
    {{"curve.zero-length",
      {},
      validation::Severity::warning,
      "a road or a curve has no positive length"},
     zero_lengths},
    {{"curve.road-length", "asam.net:xodr:1.9.0:road.length_sum_geometries",
      validation::Severity::warning, "a road's length is not that of its reference line"},
     wrong_road_lengths},
    {{"curve.absurd-length", {}, validation::Severity::warning, "a road is longer than 200 km"},
     absurd_lengths},
    {{"curve.param-poly3-length", "asam.net:xodr:1.7.0:road.geometry.parampoly3.length_match",
      validation::Severity::warning, "a paramPoly3 is not as long as its length says, within 1 mm"},
     wrong_param_poly3_lengths},
    {{"curve.param-poly3-arc-length",
      "asam.net:xodr:1.7.0:road.geometry.parampoly3.arclength_range", validation::Severity::warning,
      "a paramPoly3 of range arcLength has its length only with p from 0 to 1"},
     wrong_param_poly3_ranges<true>},
    {{"curve.param-poly3-normalized",
      "asam.net:xodr:1.7.0:road.geometry.parampoly3.normalized_range",
      validation::Severity::warning,
      "a paramPoly3 of range normalized has its length only with p from 0 to its length"},
     wrong_param_poly3_ranges<false>},
    {{"curve.param-poly3-start", "asam.net:xodr:1.7.0:road.geometry.paramPoly3.valid_parameters",
      validation::Severity::warning, "a paramPoly3 does not start at its place along its heading"},
     shifted_param_poly3s},
    {{"curve.several-shapes", "asam.net:xodr:1.7.0:road.geometry.one_geom_elem_per_spec",
      validation::Severity::error, "a geometry has more than one curve"},
     several_shapes},
    {{"curve.straight-arc", "asam.net:xodr:1.9.0:road.geometry.arc.no_zero_curvature",
      validation::Severity::info, "an arc has no curvature"},
     straight_arcs},
    {{"curve.constant-spiral", "asam.net:xodr:1.9.0:road.geometry.spiral.curvature_change",
      validation::Severity::info, "a spiral's curvature does not change"},
     constant_spirals},
}};

}  // namespace

std::span<const SourceRule> curve_rules() { return kCurveRules; }

}  // namespace roadbed::map::opendrive::rules
