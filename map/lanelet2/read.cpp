#include "roadbed/map/lanelet2/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "roadbed/map/files/in_threads.h"

namespace roadbed::map::lanelet2 {
namespace {

bool is_known(std::string_view relation_type) {
  return relation_type == "lanelet" || relation_type == "multipolygon" ||
         relation_type == "regulatory_element";
}

// Lines that nothing refers to, and relations of other kinds.
void count_unused(Document& document) {
  for (const Way& way : document.ways) {
    if (!way.used) ++document.unused["way/" + std::string(way.type)];
  }
  for (const Relation& relation : document.relations) {
    if (!is_known(relation.type)) ++document.unused["relation/" + std::string(relation.type)];
  }
}

void remark_unknown_limits(const std::vector<Lane>& lanes, std::vector<ImportDiagnostic>& remarks) {
  const auto unknown = std::count_if(lanes.begin(), lanes.end(), [](const Lane& lane) {
    return is_drivable(lane.type) && lane.speed_limits.empty();
  });
  if (unknown == 0) return;
  remarks.push_back({"import.speed-limit-unknown", false, "file", 0,
                     fmt::format("{} drivable lanelets have no speed limit", unknown), true});
}

}  // namespace

RoadMapParts read(std::string bytes, const std::string& file, int threads) {
  Document document = read_document(std::move(bytes), file, threads);
  document.places = {};  // only rules about the text ask for them
  BuiltLanes built = build_lanes(document, threads);
  return read(std::move(document), std::move(built), threads);
}

RoadMapParts read(Document document, BuiltLanes built, int threads) {
  RoadMapParts parts;
  parts.format = "Lanelet2";
  parts.crs = document.crs;
  parts.origin_in_source = document.origin_in_source;
  LinkedLanes linked;
  const auto remarks_before = std::ssize(document.remarks);
  in_threads(2, threads, [&](std::size_t task) {
    if (task == 0) {
      linked = link_lanes(document, built);
      return;
    }
    add_regulations(document, built, parts);
    add_areas(document, parts);
    add_objects(document, parts);
    count_unused(document);
  });
  parts.links = std::move(linked.links);
  document.remarks.insert(document.remarks.begin() + remarks_before, linked.remarks.begin(),
                          linked.remarks.end());
  remark_unknown_limits(built.lanes, document.remarks);
  parts.lanes = std::move(built.lanes);
  parts.remarks = std::move(document.remarks);
  for (const auto& [name, count] : document.unused) parts.unused.push_back({name, count});
  return parts;
}

}  // namespace roadbed::map::lanelet2
