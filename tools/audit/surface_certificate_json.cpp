#include "roadbed/tools/audit/surface_certificate_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/planning/audit/check/surface_check.h"
#include "roadbed/tools/audit/certificate_values.h"

namespace roadbed::tools::inline audit {
namespace {

using geometry::BodyPart;
using planning::ProvenSpan;
using planning::SurfaceCertificate;
using planning::Verdict;

constexpr double kSameMeasure_m = 1e-9;

Json on_surface_json(const SurfaceCertificate& certificate) {
  const BodyPart& part = certificate.part;
  return {{"name", part.name},
          {"rear_m", part.rear_m},
          {"front_m", part.front_m},
          {"right_m", part.right_m},
          {"left_m", part.left_m},
          {"radius_m", part.radius_m},
          {"off", stretches_json(certificate.off)},
          {"undecided", stretches_json(certificate.undecided)},
          {"from_edge", spans_json(certificate.from_edge)}};
}

SurfaceCertificate read_on_surface(const JsonNode& node) {
  node.require_object({"name", "rear_m", "front_m", "right_m", "left_m", "radius_m", "off",
                       "undecided", "from_edge"});
  constexpr Range place{-1000.0, 1000.0};
  SurfaceCertificate certificate;
  certificate.part = {.name = node.at("name").one_line(),
                      .rear_m = node.at("rear_m").number(place),
                      .front_m = node.at("front_m").number(place),
                      .right_m = node.at("right_m").number(place),
                      .left_m = node.at("left_m").number(place),
                      .radius_m = node.at("radius_m").number({0.0, 1000.0})};
  certificate.off = read_stretches(node.at("off"));
  certificate.undecided = read_stretches(node.at("undecided"));
  certificate.from_edge = read_spans(node.at("from_edge"));
  return certificate;
}

std::string measures_fault(const BodyPart& claimed, const BodyPart& part) {
  const auto is_same = [](double a, double b) { return std::abs(a - b) <= kSameMeasure_m; };
  if (claimed.name == part.name && is_same(claimed.rear_m, part.rear_m) &&
      is_same(claimed.front_m, part.front_m) && is_same(claimed.right_m, part.right_m) &&
      is_same(claimed.left_m, part.left_m) && is_same(claimed.radius_m, part.radius_m)) {
    return {};
  }
  return fmt::format("on the surface: {} is not as long, wide or placed as the vehicle's",
                     part.name);
}

}  // namespace

Verdict CertifiedSurface::verdict() const {
  Verdict verdict = Verdict::clear;
  for (const SurfaceCertificate& part : parts) {
    if (!part.off.empty()) return Verdict::conflict;
    if (!part.undecided.empty()) verdict = Verdict::undecided;
  }
  return verdict;
}

double CertifiedSurface::certified_margin_m() const {
  if (verdict() != Verdict::clear) return 0.0;
  double least_m = planning::kSurfaceHorizon_m;
  for (const SurfaceCertificate& part : parts) {
    for (const ProvenSpan& span : part.from_edge) least_m = std::min(least_m, span.at_least_m);
  }
  return least_m;
}

CertifiedSurface certified_surface(const RoadAudit& road, double inflate_m) {
  CertifiedSurface surface{.on = road.on,
                           .margin_m = road.margin_m,
                           .seam_m = road.seam_m,
                           .inflate_m = inflate_m,
                           .parts = road.certificates};
  const SurfaceWords words = surface_words(road.on);
  if (!words.file.empty()) surface.file = certified_file(words.file);
  return surface;
}

Json surface_certificate_json(const CertifiedSurface& surface) {
  Json parts = Json::array();
  for (const SurfaceCertificate& part : surface.parts) parts.push_back(on_surface_json(part));
  Json json{{"on", surface.on},
            {"verdict", planning::to_string(surface.verdict())},
            {"certified_margin_m", surface.certified_margin_m()},
            {"margin_m", surface.margin_m},
            {"seam_m", surface.seam_m},
            {"inflate_m", surface.inflate_m}};
  if (surface.file) {
    json["file"] = {{"file", surface.file->name}, {"sha256", surface.file->sha256}};
  }
  json["parts"] = std::move(parts);
  return json;
}

CertifiedSurface read_surface_certificate(const JsonNode& node) {
  node.require_object(
      {"on", "verdict", "certified_margin_m", "margin_m", "seam_m", "inflate_m", "file", "parts"});
  CertifiedSurface surface{.on = node.at("on").one_line(),
                           .margin_m = node.at("margin_m").number(kLength_m),
                           .seam_m = node.at("seam_m").number({0.0, 0.1}),
                           .inflate_m = node.at("inflate_m").number(kLength_m),
                           .parts = {}};
  if (const std::string fault = surface_words_fault(surface.on); !fault.empty()) {
    node.at("on").refuse(fault, "words of --on", "write the certificate anew");
  }
  if (const auto file = node.find("file")) {
    file->require_object({"file", "sha256"});
    surface.file = {file->at("file").one_line(), file->at("sha256").one_line()};
  }
  for (const JsonNode& part : node.at("parts").elements())
    surface.parts.push_back(read_on_surface(part));
  if (surface.parts.empty()) {
    node.at("parts").refuse("is empty", "a part at least", "write the certificate anew");
  }
  // What a reader takes from the file has to be what its stretches say.
  if (node.at("verdict").text() != planning::to_string(surface.verdict())) {
    node.at("verdict").refuse("is not that of its stretches",
                              std::string(planning::to_string(surface.verdict())),
                              "write the certificate anew");
  }
  return surface;
}

std::vector<std::string> surface_faults(const CertifiedSurface& surface,
                                        const std::vector<BodyPart>& parts_of_vehicle,
                                        const map::RoadMap* road_map,
                                        const geometry::Trajectory& drive) {
  const SurfaceWords words = surface_words(surface.on);
  if (words.kind != planning::SurfaceRule::Kind::area && road_map == nullptr) {
    return {"it is about the surface of a map, and none is named"};
  }
  if (!words.file.empty() && !surface.file) return {"the file of its surface is not named"};
  if (parts_of_vehicle.size() != surface.parts.size()) {
    return {fmt::format("on the surface: it is about {} parts, and the vehicle has {}",
                        surface.parts.size(), parts_of_vehicle.size())};
  }
  std::vector<std::string> faults;
  double reach_m = 0.0;
  for (std::size_t i = 0; i < parts_of_vehicle.size(); ++i) {
    const BodyPart part = geometry::inflated(parts_of_vehicle[i], surface.inflate_m);
    reach_m = std::max(reach_m, part.reach_m());
    if (auto fault = measures_fault(surface.parts[i].part, part); !fault.empty()) {
      faults.push_back(std::move(fault));
    }
  }
  if (!faults.empty()) return faults;
  const auto polygons =
      planning::surface_polygons(surface_rule(surface.on, road_map), drive, reach_m);
  for (const SurfaceCertificate& part : surface.parts) {
    for (const std::string& fault : planning::check_surface_certificate(
             part, polygons, surface.seam_m, surface.margin_m, drive)) {
      faults.push_back(fmt::format("on the surface, {}: {}", part.part.name, fault));
    }
  }
  return faults;
}

}  // namespace roadbed::tools::audit
