#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>

#include "roadbed/map/opendrive/rules/source.h"

namespace roadbed::map::opendrive::rules {
namespace {

std::optional<int> unsigned_short(const char* text) {
  const std::string_view written = text;
  int value = 0;
  const auto [end, error] = std::from_chars(written.data(), written.data() + written.size(), value);
  const bool whole = error == std::errc() && end == written.data() + written.size();
  if (!whole || written.empty() || value < 0 || value > 65535) return {};
  return value;
}

void missing_header(const Source& source, const validation::ValidateOptions&,
                    validation::Report& report) {
  if (source.xml.root().child("header")) return;
  report.add("header", std::nullopt, "there is no <header>; add one with the file's revision")
      .line = source.xml.line_of(source.xml.root());
}

void undefined_version(const Source& source, const validation::ValidateOptions&,
                       validation::Report& report) {
  const auto header = source.xml.root().child("header");
  if (!header) return;
  for (const char* name : {"revMajor", "revMinor"}) {
    if (unsigned_short(header.attribute(name).value())) continue;
    report
        .add("header", std::nullopt,
             fmt::format("{}=\"{}\" is no whole number from 0 to 65535; state the revision", name,
                         header.attribute(name).value()))
        .line = source.xml.line_of(header);
  }
}

void unknown_version(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  const auto header = source.xml.root().child("header");
  const auto major = unsigned_short(header.attribute("revMajor").value());
  const auto minor = unsigned_short(header.attribute("revMinor").value());
  if (!major || !minor || (*major == 1 && *minor <= 9)) return;
  report
      .add("header", std::nullopt,
           fmt::format("revision {}.{} is no revision of the standard (1.0 to 1.9); convert the "
                       "file or correct it",
                       *major, *minor))
      .line = source.xml.line_of(header);
}

void several_projections(const Source& source, const validation::ValidateOptions&,
                         validation::Report& report) {
  const auto header = source.xml.root().child("header");
  const auto first = header.child("geoReference");
  for (auto more = first.next_sibling("geoReference"); more;
       more = more.next_sibling("geoReference")) {
    report
        .add("header", std::nullopt,
             "a second <geoReference>; keep the one that the coordinates are in")
        .line = source.xml.line_of(more);
  }
}

void broken_offset(const Source& source, const validation::ValidateOptions&,
                   validation::Report& report) {
  const auto offset = source.xml.root().child("header").child("offset");
  if (!offset) return;
  for (const char* name : {"x", "y", "z", "hdg"}) {
    if (!offset.attribute(name) || !std::isnan(source.number(offset, name))) continue;
    report
        .add("header", std::nullopt,
             fmt::format("<offset> {}=\"{}\" is no finite number; correct it", name,
                         offset.attribute(name).value()))
        .line = source.xml.line_of(offset);
  }
}

void far_coordinates(const Source& source, const validation::ValidateOptions&,
                     validation::Report& report) {
  constexpr double kFarM = 1e5;  // 32-bit floats keep a centimetre up to here
  for (const RoadSource& road : source.roads) {
    const auto place = road.place();
    if (!place || place->cwiseAbs().maxCoeff() <= kFarM) continue;
    report
        .add("header", place,
             fmt::format("coordinates are up to {:.0f} km from (0, 0), where programs that use "
                         "32-bit floats lose centimetres; use <offset>",
                         place->cwiseAbs().maxCoeff() / 1000.0))
        .line = source.xml.line_of(road.record.node);
    return;
  }
}

constexpr std::array<SourceRule, 6> kHeaderRules = {{
    {{"header.missing", "asam.net:xodr:1.0.0:xml.fileheader_is_present",
      validation::Severity::error, "an OpenDRIVE file has no header"},
     missing_header},
    {{"header.version", "asam.net:xodr:1.0.0:xml.version_is_defined", validation::Severity::error,
      "the header does not say the revision of the standard in whole numbers"},
     undefined_version},
    {{"header.unknown-version", "asam.net:xodr:1.0.0:xml.valid_schema", validation::Severity::error,
      "the header names a revision that the standard does not have"},
     unknown_version},
    {{"crs.several", "asam.net:xodr:1.9.0:header.proj.max_one_proj", validation::Severity::warning,
      "a file has more than one coordinate reference system"},
     several_projections},
    {{"crs.offset", {}, validation::Severity::error, "the header's offset is no number"},
     broken_offset},
    {{"crs.far-from-origin", "asam.net:xodr:1.7.0:header.offset.centered_coords",
      validation::Severity::info, "coordinates are so large that 32-bit floats lose centimetres"},
     far_coordinates},
}};

}  // namespace

std::span<const SourceRule> header_rules() { return kHeaderRules; }

}  // namespace roadbed::map::opendrive::rules
