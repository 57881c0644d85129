#include "roadbed/map/repair/repair.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/validate_file.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

std::string data(const std::string& name) { return read_file(tests::data_folder() / name); }

FindingCounts judged(const std::string& bytes) {
  return count(validate_bytes(bytes, "a map").findings);
}

double distance_m(const geometry::Polyline& line, const Eigen::Vector2d& point) {
  return std::abs(line.project(point).d_m);
}

/// How far the borders of a lane are from where any border of it was.
double moved_m(const Lane& before, const Lane& after) {
  double most_m = 0.0;
  for (const LaneLine* line : {&after.left, &after.right}) {
    for (const Eigen::Vector2d& point : line->in_map.points()) {
      most_m = std::max(most_m, std::min(distance_m(before.left.in_map, point),
                                         distance_m(before.right.in_map, point)));
    }
  }
  return most_m;
}

/// What holds of every repair, and the repaired file.
RepairedFile expect_sound_repair(const std::string& bytes, const RepairOptions& options = {}) {
  constexpr double sampling_m = 2e-3;
  RepairedFile file = repair_file(bytes, "a map", options);
  const FindingCounts before = judged(bytes), after = judged(file.bytes);
  EXPECT_EQ(file.before, before);
  EXPECT_EQ(file.after, after);
  if (file.repairs.empty()) {
    EXPECT_EQ(file.bytes, bytes);
    return file;
  }
  EXPECT_LT(after, before);
  const RoadMap was = parse_map(bytes, "a map"), is = parse_map(file.bytes, "a map");
  // One that was no lane for its crossing borders may be one again; none is lost.
  EXPECT_LE(was.lanes().size(), is.lanes().size());
  for (const Lane& lane : was.lanes()) {
    const auto found = is.find_lane(lane.name);
    EXPECT_TRUE(found) << lane.name;
    if (!found) continue;
    EXPECT_LE(moved_m(lane, is.lane(*found)), options.tolerance_m + sampling_m) << lane.name;
  }
  for (const Repair& repair : file.repairs) {
    EXPECT_LE(repair.moved_m, options.tolerance_m) << repair.element;
    EXPECT_FALSE(repair.rule.empty() || repair.element.empty() || repair.what.empty());
    EXPECT_GT(repair.line, 0) << repair.element;
  }
  return file;
}

using Random = std::mt19937;

/// One of the places at which the pattern stands; of none the end.
std::smatch pick(const std::string& text, const std::string& pattern, Random& random) {
  const std::regex regex(pattern);
  std::vector<std::smatch> found(std::sregex_iterator(text.begin(), text.end(), regex), {});
  if (found.empty()) return {};
  return found[random() % found.size()];
}

/// Puts a text in the place of one match.
void replace(std::string& text, const std::smatch& match, const std::string& with) {
  if (match.empty()) return;
  text.replace(static_cast<std::size_t>(match.position()), static_cast<std::size_t>(match.length()),
               with);
}

using MakeFault = std::function<void(std::string& text, Random& random)>;

void forget_lane_link(std::string& text, Random& random) {
  replace(text, pick(text, R"re(\n *<(predecessor|successor) id="-?\d+" ?/>)re", random), "");
}

void forget_contact(std::string& text, Random& random) {
  const auto match =
      pick(text, R"re(elementType="road" elementId="(\d+)" contactPoint="(start|end)")re", random);
  if (match.empty()) return;
  replace(text, match,
          "elementType=\"road\" elementId=\"" + match[1].str() + "\" contactPoint=\"" +
              (match[2].str() == "start" ? "end" : "start") + "\"");
}

void stretch_road(std::string& text, Random& random) {
  const auto match = pick(text, R"re((<road [^>]*length=")([\d.]+)")re", random);
  if (match.empty()) return;
  replace(text, match, match[1].str() + std::to_string(std::stod(match[2]) + 0.04) + "\"");
}

void repeat_point(std::string& text, Random& random) {
  const auto match = pick(text, R"re((<geometry [^>]*length=")([^"]*)("[^>]*>))re", random);
  if (match.empty()) return;
  replace(text, match, match[1].str() + "0.0\"><line /></geometry>\n" + match.str());
}

void move_curve(std::string& text, Random& random) {
  const auto match = pick(text, R"re((<geometry s="[1-9][^>]* x=")([-\d.e]+)")re", random);
  if (match.empty()) return;
  replace(text, match, match[1].str() + std::to_string(std::stod(match[2]) + 0.03) + "\"");
}

void forget_link(std::string& text, Random& random) {
  replace(text,
          pick(text, R"re(\n *<(predecessor|successor|adjacentLeft|adjacentRight) ref="[^>]*>)re",
               random),
          "");
}

/// The text of one lanelet of CommonRoad.
std::smatch pick_lanelet(const std::string& text, Random& random) {
  return pick(text, R"re(<lanelet id[\s\S]*?</lanelet>)re", random);
}

std::string with_names_changed(std::string text, const std::string& a, const std::string& b) {
  text = std::regex_replace(text, std::regex(a), "\x01");
  text = std::regex_replace(text, std::regex(b), a);
  return std::regex_replace(text, std::regex("\x01"), b);
}

void swap_bounds(std::string& text, Random& random) {
  const auto match = pick_lanelet(text, random);
  std::string lanelet = match.str();
  // Their contents change places.
  const std::regex bounds(
      R"re(<leftBound>([\s\S]*?)</leftBound>([\s\S]*?)<rightBound>([\s\S]*?)</rightBound>)re");
  lanelet =
      std::regex_replace(lanelet, bounds, "<leftBound>$3</leftBound>$2<rightBound>$1</rightBound>");
  replace(text, match, lanelet);
}

void turn_bound(std::string& text, Random& random) {
  const auto match = pick(text, R"re(<leftBound>\s*((<point>.*</point>\s*)+))re", random);
  const std::string lines = match[1].str();
  const std::regex point("<point>.*</point>");
  std::vector<std::string> points;
  for (std::sregex_iterator i(lines.begin(), lines.end(), point), end; i != end; ++i) {
    points.insert(points.begin(), i->str());
  }
  std::string turned = "<leftBound>";
  for (const std::string& line : points) turned += "\n" + line;
  replace(text, match, turned + "\n");
}

void move_start(std::string& text, Random& random) {
  const auto match = pick(text, R"re(<lanelet id[\s\S]*?</lanelet>)re", random);
  std::string lanelet = match.str();
  if (lanelet.find("<predecessor") == std::string::npos) return;
  for (const char* bound : {"<leftBound>", "<rightBound>"}) {
    const std::size_t at = lanelet.find("<y>", lanelet.find(bound)) + 3;
    const std::size_t end = lanelet.find('<', at);
    lanelet.replace(at, end - at, std::to_string(std::stod(lanelet.substr(at, end - at)) + 0.05));
  }
  replace(text, match, lanelet);
}

void split_node(std::string& text, Random& random) {
  const auto reference = pick(text, "<nd ref=\"(\\d+)\"/>", random);
  const std::string id = reference[1].str(), copy = "9" + id + "9";
  if (text.find("<node id=\"" + copy + "\"") != std::string::npos) return;
  replace(text, reference, "<nd ref=\"" + copy + "\"/>");
  const auto node = pick(text, "<node id=\"" + id + "\"[\\s\\S]*?</node>", random);
  std::string moved =
      std::regex_replace(node.str(), std::regex("node id=\"" + id), "node id=\"" + copy);
  const std::size_t x = moved.find("local_x\" v=\"") + 12;
  const std::size_t end = moved.find('"', x);
  moved.replace(x, end - x, std::to_string(std::stod(moved.substr(x, end - x)) + 0.02));
  replace(text, node, node.str() + "\n  " + moved);
}

void swap_roles(std::string& text, Random& random) {
  const auto match = pick(text, R"re(<relation id[\s\S]*?</relation>)re", random);
  replace(text, match, with_names_changed(match.str(), "role=\"left\"", "role=\"right\""));
}

void forget_type(std::string& text, Random& random) {
  replace(text,
          pick(text, R"re(\n *<tag k="type" v="(line_thin|road_border|virtual)"/>)re", random), "");
}

struct FaultyMaps {
  const char* file;
  std::vector<MakeFault> faults;
};

const std::vector<FaultyMaps> kFaultyMaps = {
    {"town.xodr", {forget_lane_link, forget_contact, stretch_road, repeat_point, move_curve}},
    {"country.xodr", {forget_lane_link, forget_contact, stretch_road, repeat_point, move_curve}},
    {"ramp.xodr", {forget_lane_link, forget_contact, stretch_road, repeat_point, move_curve}},
    {"junction.xml", {forget_link, swap_bounds, turn_bound, move_start}},
    {"crossing.osm", {split_node, swap_roles, forget_type}},
};

TEST(RepairMap, MakesMapsWithMadeFaultsBetterAndMovesNoBorderTooFar) {
  Random random(20261125);
  std::size_t repaired = 0;
  for (const FaultyMaps& maps : kFaultyMaps) {
    const std::string faultless = data(maps.file);
    for (int i = 0; i < 12; ++i) {
      std::string text = faultless;
      for (std::size_t k = 0; k <= random() % 3; ++k) {
        maps.faults[random() % maps.faults.size()](text, random);
      }
      SCOPED_TRACE(maps.file + std::string(" ") + std::to_string(i));
      if (!validate_bytes(text, "a map").road_map) continue;
      repaired += expect_sound_repair(text).repairs.empty() ? 0 : 1;
    }
  }
  EXPECT_GE(repaired, 30u);
}

struct Mended {
  const char* file;
  MakeFault make;
  const char* rule;
};

TEST(RepairMap, UndoesASlipThatLeavesNoChoice) {
  const std::vector<Mended> slips = {
      {"town.xodr", forget_lane_link, "link.lane-one-sided"},
      {"country.xodr", stretch_road, "curve.road-length"},
      {"country.xodr", repeat_point, "curve.zero-length"},
      {"junction.xml", forget_link, ""},
      {"junction.xml", swap_bounds, "import.swapped-borders"},
      {"junction.xml", turn_bound, "geometry.self-intersection"},
      {"crossing.osm", forget_type, "lanelet2.border-without-type"},
  };
  for (const Mended& slip : slips) {
    Random random(7);
    const std::string faultless = data(slip.file);
    const FindingCounts wanted = expect_sound_repair(faultless).after;
    std::size_t mended = 0;
    for (int i = 0; i < 6; ++i) {
      SCOPED_TRACE(slip.rule + std::string(" ") + std::to_string(i));
      std::string text = faultless;
      slip.make(text, random);
      const RepairedFile file = expect_sound_repair(text);
      if (file.repairs.empty()) continue;
      EXPECT_THAT(file.repairs.front().rule, HasSubstr(slip.rule));
      EXPECT_LE(file.after, wanted);
      ++mended;
    }
    EXPECT_GE(mended, 2u) << slip.rule;
  }
}

/// Lanes in a row whose ends lie 5 cm apart; the second one is linked to the first if `links`.
std::string two_lanelets(const std::string& links) {
  const auto lanelet = [](int id, const std::string& x, const std::string& to,
                          const std::string& l) {
    const auto line = [&](const std::string& y) {
      return "<point><x>" + x + "</x><y>" + y + "</y></point><point><x>" + to + "</x><y>" + y +
             "</y></point>";
    };
    return "<lanelet id=\"" + std::to_string(id) + "\"><leftBound>" + line("3") +
           "</leftBound><rightBound>" + line("0") + "</rightBound>" + l +
           "<laneletType>urban</laneletType></lanelet>\n";
  };
  return "<commonRoad commonRoadVersion=\"2020a\" benchmarkID=\"DEU_A-1_1_T-1\">\n<!-- kept -->\n" +
         lanelet(1, "0", "10", links.empty() ? "" : "<successor ref=\"2\"/>") +
         lanelet(2, "10.05", "20", links) + "</commonRoad>\n";
}

TEST(RepairMap, LinksEndsThatCoincideAndClosesGapsWithinTheToleranceOnly) {
  const RepairedFile file = expect_sound_repair(two_lanelets(""));
  EXPECT_THAT(file.bytes, HasSubstr("<successor ref=\"2\"/>"));
  EXPECT_THAT(file.bytes, HasSubstr("<predecessor ref=\"1\"/>"));
  EXPECT_THAT(file.bytes, HasSubstr("<!-- kept -->"));
  EXPECT_THAT(file.bytes, testing::Not(HasSubstr("10.05")));
  EXPECT_TRUE(repair_file(file.bytes, "a map").repairs.empty());
  EXPECT_TRUE(
      expect_sound_repair(two_lanelets(""), {.tolerance_m = 0.04, .validate = {}}).repairs.empty());
  const RepairedFile linked = expect_sound_repair(two_lanelets("<predecessor ref=\"1\"/>"));
  ASSERT_EQ(linked.repairs.size(), 1u);
  EXPECT_EQ(linked.repairs[0].rule, "geometry.gap");
  EXPECT_NEAR(linked.repairs[0].moved_m, 0.05, 1e-9);
}

// Roads of 50 m along the x axis with gaps between them.
TEST(RepairMap, LinksRoadsWhoseEndsAreWithinTheTolerance) {
  const auto roads = [](std::initializer_list<double> starts) {
    std::string bytes = "<OpenDRIVE><header revMajor=\"1\" revMinor=\"7\"/>";
    for (const double x : starts) {
      bytes += fmt::format(
          R"(<road id="{0}" length="50" junction="-1"><planView><geometry s="0" x="{0}" y="0" )"
          R"(hdg="0" length="50"><line/></geometry></planView><lanes><laneSection s="0"><center>)"
          R"(<lane id="0" type="none"/></center><right><lane id="-1" type="driving"><width )"
          R"(sOffset="0" a="3.5" b="0" c="0" d="0"/></lane></right></laneSection></lanes></road>)",
          x);
    }
    return bytes + "</OpenDRIVE>";
  };
  for (const double tolerance_m : {0.05, 0.1, 0.5}) {
    const RepairOptions options{.tolerance_m = tolerance_m, .validate = {}};
    for (const double factor : {0.45, 1.1}) {
      const double gap_m = factor * tolerance_m;
      const std::string bytes = roads({0.0, 50.0 + gap_m, 100.0 + 2.0 * gap_m});
      if (factor > 1.0) {
        EXPECT_TRUE(repair_file(bytes, "a map", options).repairs.empty()) << gap_m;
        continue;
      }
      const RepairedFile file = expect_sound_repair(bytes, options);
      const RoadMap road_map = parse_map(file.bytes, "a map");
      std::size_t links = 0;
      for (const Lane& lane : road_map.lanes()) {
        links += road_map.graph().of(lane.id).successors.size();
      }
      EXPECT_EQ(links, 2u) << gap_m;
    }
  }
}

TEST(RepairMap, LeavesAFaultlessMapAsItIs) {
  for (const char* name : {"town.xodr", "ramp.xodr", "junction.xml", "crossing.osm"}) {
    const std::string bytes = data(name);
    EXPECT_EQ(repair_file(bytes, name).bytes, bytes) << name;
  }
}

TEST(RepairMap, RefusesFormatsThatItDoesNotKnowAndFilesThatAreNoMap) {
  EXPECT_THROW(repair_file(data("surface.geojson"), "a.geojson"), InputError);
  EXPECT_THROW(repair_file("<osm/>", "a.osm"), InputError);
  EXPECT_THROW(repair_file("<OpenDRIVE>", "a.xodr"), InputError);
}

// An id with a line break, by its number, moves what stands behind it in the text that is parsed.
TEST(RepairMap, NamesTheFileWhoseControlCharactersItCannotWriteAround) {
  std::string bytes = data("town.xodr");
  const std::string id = R"(id="1")", type = R"( type="driving")";
  bytes.replace(bytes.find(id), id.size(), R"(id="1&#10;x")");
  bytes.erase(bytes.find(type), type.size());
  EXPECT_THAT(tests::refusal_of([&] { repair_file(bytes, "a.xodr"); }),
              AllOf(HasSubstr("a.xodr: "), HasSubstr("control characters")));
}

TEST(RepairMapReal, MakesRealMapsNoWorse) {
  ROADBED_REAL_DATA_OR_SKIP(folder);
  constexpr std::uintmax_t most_bytes = 200'000;  // each is validated many times
  std::size_t maps = 0, repairs = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string suffix = entry.path().extension().string();
    if (suffix != ".xodr" && suffix != ".osm" && suffix != ".xml") continue;
    if (entry.file_size() > most_bytes) continue;
    const std::string bytes = read_file(entry.path());
    if (!format_of(bytes) || !validate_bytes(bytes, "a map").road_map) continue;
    SCOPED_TRACE(entry.path().filename());
    repairs += expect_sound_repair(bytes).repairs.size();
    ++maps;
  }
  std::cout << repairs << " repairs of " << maps << " real maps\n";
  EXPECT_GE(maps, 50u);
  EXPECT_GE(repairs, 10u);
}

}  // namespace
}  // namespace roadbed::map
