#include "roadbed/tests/support/made_road.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "roadbed/map/load_map.h"

namespace roadbed::tests {

std::string made_road(const MadeRoad& road) {
  const std::string line =
      fmt::format(R"(<geometry s="0" x="{}" y="0" hdg="0" length="{}"><line/></geometry>)",
                  road.x_m, road.length_m);
  return fmt::format(R"(<road id="{}" length="{}" junction="-1" {}>
<link>{}</link>{}
<planView>{}</planView>
<elevationProfile>{}</elevationProfile><lateralProfile>{}</lateralProfile>
<lanes>{}</lanes>
{}</road>
)",
                     road.id, road.length_m, road.attributes, road.link, road.type,
                     road.plan_view.empty() ? line : road.plan_view, road.elevation, road.lateral,
                     road.lanes.empty() ? made_section(0, made_lane(1), made_lane(-1)) : road.lanes,
                     road.rest);
}

std::string made_lane(int id, const std::string& inside, const std::string& type, double width_m) {
  return fmt::format(
      R"(<lane id="{}" type="{}"><width sOffset="0" a="{}" b="0" c="0" d="0"/>{}</lane>)", id, type,
      width_m, inside);
}

std::string made_section(double s_m, const std::string& left, const std::string& right,
                         const std::string& middle, const std::string& attributes) {
  return fmt::format(
      R"(<laneSection s="{}" {}><left>{}</left><center><lane id="0" type="none">{}</lane></center>)"
      R"(<right>{}</right></laneSection>)",
      s_m, attributes, left, middle, right);
}

std::string made_document(const std::string& body, const std::string& header) {
  return R"(<OpenDRIVE><header revMajor="1" revMinor="8">)" + header + "</header>" + body +
         "</OpenDRIVE>";
}

std::filesystem::path made_file(const std::string& name, const MadeRoad& road) {
  const auto file =
      std::filesystem::path(testing::TempDir()) / fmt::format("{}_{}.xodr", name, ::getpid());
  std::ofstream(file) << made_document(made_road(road));
  return file;
}

map::RoadMap made_map(const std::string& body, const std::string& header) {
  return map::parse_map(made_document(body, header), "made.xodr");
}

const map::Lane& lane_of(const map::RoadMap& road_map, const std::string& name) {
  return road_map.lane(road_map.find_lane(name).value());
}

std::vector<std::string> successors_of(const map::RoadMap& road_map, const std::string& name) {
  std::vector<std::string> names;
  for (const map::LaneId id : road_map.graph().of(road_map.find_lane(name).value()).successors) {
    names.push_back(road_map.lane(id).name);
  }
  return names;
}

std::vector<std::string> remarks_of(const map::RoadMap& road_map, const std::string& rule) {
  std::vector<std::string> messages;
  for (const map::ImportDiagnostic& remark : road_map.import_diagnostics()) {
    if (remark.rule == rule) messages.push_back(remark.element + ": " + remark.message);
  }
  return messages;
}

}  // namespace roadbed::tests
