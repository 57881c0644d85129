// What only a browser can tell of a map's page.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <string>

#include "roadbed/map/load_map.h"
#include "roadbed/map/page/diff_page.h"
#include "roadbed/map/page/map_page.h"
#include "roadbed/tests/support/browser.h"
#include "roadbed/tests/support/holds.h"
#include "roadbed/tests/support/made_maps.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

using tests::holds;
using tests::page_after_scripts;

/// The page with a script of a test at its end.
std::string with_script(std::string page, const std::string& script) {
  return page.insert(page.rfind("</body>"), "<script>" + script + "</script>");
}

/// What a script left in <html data-NAME>.
std::string data_of(const std::string& page, const std::string& name) {
  const std::string begin = "data-" + name + "=\"";
  const std::size_t from = page.find(begin);
  if (from == std::string::npos) return "";
  const std::size_t at = from + begin.size();
  return page.substr(at, page.find('"', at) - at);
}

// Clicks on the canvas; functions for the other scripts.
constexpr const char* kHand = R"(
const canvas = document.getElementById("map"), frame = canvas.getBoundingClientRect();
function clickAt(x, y) {
  for (const type of ["pointerdown", "pointerup"]) {
    canvas.dispatchEvent(new PointerEvent(type, {clientX: frame.left + x, clientY: frame.top + y, pointerId: 1,
                                                 buttons: type === "pointerdown" ? 1 : 0, bubbles: true}));
  }
}
const rowOf = (name) => [...document.querySelectorAll("#details tr")].find((row) => row.cells[0].textContent === name);
const textOf = (name) => rowOf(name)?.cells[1].textContent ?? "";
const selected = () => document.getElementById("selected").textContent;
function press(key) {
  document.body.dispatchEvent(new KeyboardEvent("keydown", {key, bubbles: true}));
}
const note = (name, value) => (document.documentElement.dataset[name] = value);
)";

// 100 clicks, each with the coordinates that the page tells of it and the lane that it names.
constexpr const char* kClicks = R"(
let seed = 20261125;
const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
const seen = [];
for (let i = 0; i < 100; ++i) {
  clickAt(random() * frame.width, random() * frame.height);
  seen.push(rowOf("x, y").querySelector("code").textContent.replace(",", "") + " " + selected());
}
note("clicks", seen.join(";"));
)";

void expect_clicks_name_what_locate_names(const std::filesystem::path& browser,
                                          const std::filesystem::path& file) {
  const RoadMap road_map = load_map(file);
  const std::string page = page_after_scripts(
      browser, with_script(write_map_page(road_map), std::string(kHand) + kClicks), "");
  std::istringstream clicks(data_of(page, "clicks"));
  int count = 0;
  for (std::string click; std::getline(clicks, click, ';'); ++count) {
    std::istringstream words(click);
    double x_m = 0.0, y_m = 0.0;
    std::string name;
    ASSERT_TRUE(words >> x_m >> y_m >> name) << click;
    const auto found = road_map.locate(road_map.to_map({x_m, y_m}),
                                       std::numeric_limits<double>::infinity(), false);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(name, road_map.lane(found.front().place.lane).name) << x_m << ", " << y_m;
  }
  EXPECT_EQ(count, 100);
  EXPECT_EQ(data_of(page, "error"), "");
}

TEST(MapPageInBrowser, AClickNamesTheLaneThatLocateNames) {
  ROADBED_BROWSER_OR_SKIP(browser);
  expect_clicks_name_what_locate_names(browser, tests::data_folder() / "town.xodr");
}

TEST(MapPageInBrowser, AClickOnRealMapsNamesTheLaneThatLocateNames) {
  ROADBED_BROWSER_OR_SKIP(browser);
  ROADBED_REAL_DATA_OR_SKIP(folder);
  for (const char* file :
       {"opendrive/BerkeleyLearnVerify+Scenic/Town04.xodr",
        "lanelet2/fzi-forschungszentrum-informatik+Lanelet2/mapping_example.osm"}) {
    expect_clicks_name_what_locate_names(browser, folder / file);
  }
}

std::string town_page() {
  return write_map_page(load_map(tests::data_folder() / "town.xodr"), {.title = "town.xodr"});
}

TEST(MapPageInBrowser, AnAddressSelectsWhatIsThere) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const RoadMap road_map = load_map(tests::data_folder() / "town.xodr");
  const auto lane = road_map.locate(road_map.to_map({150, 198}), 50, false).front().place.lane;
  const std::string page = page_after_scripts(browser, town_page(), "#at=150,198");
  EXPECT_TRUE(holds(page, "id=\"selected\">" + road_map.lane(lane).name + "</output>"));
  EXPECT_EQ(data_of(page, "error"), "");
}

TEST(MapPageInBrowser, FindsThingsByIdAndPlacesByCoordinates) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const std::string page =
      page_after_scripts(browser, with_script(town_page(), std::string(kHand) + R"(
const found = [], box = document.getElementById("search");
for (const text of ["7/0/1", "road 7", "junction 1", "150,198", "no such thing"]) {
  box.value = text;
  document.getElementById("search_form").requestSubmit();
  found.push(selected());
}
note("found", found.join(";"));
note("message", document.getElementById("message").textContent);)"),
                         "");
  EXPECT_THAT(data_of(page, "found"), testing::StartsWith("7/0/1;road 7;"));
  EXPECT_THAT(data_of(page, "message"), testing::HasSubstr("nothing is called"));
  EXPECT_EQ(data_of(page, "error"), "");
}

TEST(MapPageInBrowser, FollowsLinksBetweenLanes) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  const std::string page =
      page_after_scripts(browser, with_script(write_map_page(road_map), std::string(kHand) + R"(
const went = [];
for (const way of ["successors", "successors", "predecessors"]) {
  rowOf(way).querySelector("button").click();
  went.push(selected());
}
rowOf("road").querySelector("button").click();
went.push(selected());
note("went", went.join(";"));)"),
                         "#at=10,0");
  EXPECT_EQ(data_of(page, "went"), "2/0/-1;3/0/-1;2/0/-1;road 2");
}

TEST(MapPageInBrowser, TellsPlacesAsCommandsTakeThem) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  const MapPageOptions options{.title = "my map.xodr"};
  const std::string page = page_after_scripts(
      browser, with_script(write_map_page(road_map, options), std::string(kHand) + R"(
note("argument", rowOf("argument").querySelector("code").textContent);
press("r");
clickAt(0.1 * frame.width, frame.height / 2);
clickAt(0.9 * frame.width, frame.height / 2);
note("command", document.getElementById("command").textContent);
press("Escape");
press("m");
clickAt(0, 0);
clickAt(100, 0);
note("measured", document.getElementById("message").textContent);)"),
      "#view=75,0,10&at=10,1");
  EXPECT_EQ(data_of(page, "argument"), "lane:1/0/-1@10.00");
  EXPECT_THAT(data_of(page, "command"),
              testing::MatchesRegex("roadbed route 'my map.xodr' --from lane:[1-3]/0/-1@[0-9.]+ "
                                    "--to lane:[1-3]/0/-1@[0-9.]+"));
  EXPECT_THAT(data_of(page, "measured"), testing::StartsWith("10.000 m over 2 places"));
}

TEST(MapPageInBrowser, WalksThroughFindingsAndKeepsItsViewInTheAddress) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  MapPageOptions options;
  options.remarks = {{"a.b", "error", "lane 2/0/-1", "first", 7, Eigen::Vector2d(60, 0)},
                     {"c.d", "info", "road 3", "second", 0, Eigen::Vector2d(120, 0)}};
  const std::string page = page_after_scripts(
      browser, with_script(write_map_page(road_map, options), std::string(kHand) + R"(
const said = [];
for (const key of ["n", "n", "n", "p"]) {
  press(key);
  said.push(textOf("message") + textOf("line"));
}
note("said", said.join(";"));
press("n");
rowOf("element").querySelector("button").click();
note("went", selected());
press("c");
document.getElementById("layer_signals").click();
setTimeout(() => note("hash", location.hash), 500);)"),
      "");
  EXPECT_EQ(data_of(page, "said"), "first7;second;first7;second");
  EXPECT_EQ(data_of(page, "went"), "2/0/-1");
  EXPECT_THAT(data_of(page, "hash"), testing::ContainsRegex("^#view=.*colour=speed.*hide=signals"));
}

TEST(MapPageInBrowser, ASecondClickSelectsWhatElseIsThere) {
  ROADBED_BROWSER_OR_SKIP(browser);
  tests::MadeMap made = tests::three_roads_in_a_row();
  MapObject object;
  object.source_id = "7";
  object.type = "crosswalk";
  object.in_map = {75, 0};
  object.outline_in_map = {{70, -3}, {80, -3}, {80, 3}, {70, 3}};
  made.parts.objects.push_back(object);
  const std::string page =
      page_after_scripts(browser, with_script(write_map_page(made.build()), std::string(kHand) + R"(
const seen = [];
for (let i = 0; i < 3; ++i) {
  clickAt(frame.width / 2, frame.height / 2 + 10);
  seen.push(selected());
}
note("seen", seen.join(";"));)"),
                         "#view=75,0,10");
  EXPECT_EQ(data_of(page, "seen"), "2/0/-1;object 7;2/0/-1");
}

TEST(MapPageInBrowser, WorksWithKeysAlone) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  const std::string page =
      page_after_scripts(browser, with_script(write_map_page(road_map), std::string(kHand) + R"(
canvas.focus();
canvas.dispatchEvent(new KeyboardEvent("keydown", {key: "Enter", bubbles: true}));
note("centre", selected());
press("ArrowRight");
press("+");
press("c");
note("colours", document.getElementById("colours").value);
press("Escape");
note("cleared", selected());
setTimeout(() => note("hash", location.hash), 500);)"),
                         "#view=75,1,10");
  EXPECT_EQ(data_of(page, "centre"), "2/0/-1");
  EXPECT_EQ(data_of(page, "colours"), "speed");
  EXPECT_EQ(data_of(page, "cleared"), "");
  EXPECT_THAT(data_of(page, "hash"), testing::HasSubstr("view=83.00,1.00,15"));
}

// Two colours of a pixel: with all layers, and without some.
TEST(MapPageInBrowser, DrawsTheLayersThatAreSwitchedOn) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  const std::string page =
      page_after_scripts(browser, with_script(write_map_page(road_map), std::string(kHand) + R"(
const colour = () => [...canvas.getContext("2d").getImageData(frame.width / 2, frame.height / 2 + 5, 1, 1).data].join(" ");
const {dataset} = document.documentElement;
const whenDrawn = (act) => (dataset.drawn === "all" ? act() : setTimeout(whenDrawn, 20, act));
whenDrawn(() => {
  note("with", colour());
  delete dataset.drawn;
  document.getElementById("layer_lanes").click();
  whenDrawn(() => note("without", colour()));
});)"),
                         "#view=75,1,10&hide=arrows");
  EXPECT_EQ(data_of(page, "with"), "136 147 161 255");     // --lane-junction
  EXPECT_EQ(data_of(page, "without"), "238 240 234 255");  // --ground
}

TEST(MapPageInBrowser, ShowsARouteWithItsElevation) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  PageOverlay route;
  route.kind = "route";
  route.name = "Route there";
  route.text = "40 m, 3 s";
  route.pieces = {{*road_map.find_lane("1/0/-1"), 30.0, 50.0},
                  {*road_map.find_lane("2/0/-1"), 0.0, 20.0}};
  MapPageOptions options;
  options.overlays = {route};
  const std::string page = page_after_scripts(
      browser, with_script(write_map_page(road_map, options), std::string(kHand) + R"(
note("named", selected());
note("length", textOf("length"));
note("lanes", textOf("lanes"));
note("profile", document.querySelector("#details figcaption").textContent);
setTimeout(() => note("hash", location.hash), 500);)"),
      "#find=Route%20there");
  EXPECT_EQ(data_of(page, "named"), "Route there");
  EXPECT_EQ(data_of(page, "length"), "40.00 m");
  EXPECT_EQ(data_of(page, "lanes"), "1/0/-12/0/-1");
  EXPECT_EQ(data_of(page, "profile"), "Elevation along the route");
  EXPECT_THAT(data_of(page, "hash"), testing::HasSubstr("find=Route%20there"));
}

TEST(MapPageInBrowser, SaysWhichLineOfTheSourceAThingStandsIn) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const RoadMap road_map = tests::three_roads_in_a_row().build();
  MapPageOptions options;
  options.lines = {{"lane 2/0/-1", 42}, {"road 2", 40}};
  const std::string page = page_after_scripts(
      browser, with_script(write_map_page(road_map, options), std::string(kHand) + R"(
note("lane", textOf("source line"));
rowOf("road").querySelector("button").click();
note("road", textOf("source line"));)"),
      "#lane=2/0/-1");
  EXPECT_EQ(data_of(page, "lane"), "42");
  EXPECT_EQ(data_of(page, "road"), "40");
}

TEST(MapPageInBrowser, ShowsWhatChangedBetweenTwoMaps) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const RoadMap before = tests::three_roads_in_a_row().build();
  tests::MadeMap made = tests::three_roads_in_a_row();
  made.parts.lanes[1].type = LaneType::parking;
  made.parts.lanes[1].speed_limits = {{0.0, 10.0}};
  const RoadMap after = made.build();
  const std::string page = page_after_scripts(
      browser,
      with_script(write_diff_page(before, after, diff(before, after)), std::string(kHand) + R"(
const said = [];
for (let i = 0; i < 2; ++i) {
  press("n");
  said.push(textOf("severity") + " " + textOf("rule") + ": " + textOf("message"));
}
note("said", said.join("|"));
note("overlays", [...document.querySelectorAll("#layers label")].map((one) => one.textContent).filter((one) => /lanes,/.test(one)).join());
rowOf("element").querySelector("button").click();
note("went", selected());)"),
      "");
  EXPECT_EQ(data_of(page, "said"), "changed lane: " + after.lanes()[1].name +
                                       " changed: type; driving before, parking after|"
                                       "changed speed_limit: " +
                                       after.lanes()[1].name +
                                       " changed: 50.04 km/h before, 36 km/h after");
  EXPECT_EQ(data_of(page, "overlays"), "Changed lanes, afterShow");
  EXPECT_EQ(data_of(page, "went"), after.lanes()[1].name);
  EXPECT_EQ(data_of(page, "error"), "");
}

TEST(MapPageInBrowser, DrawsItsTilesAndAsksNoNetwork) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const std::string page = page_after_scripts(browser, with_script(town_page(), R"(
document.documentElement.dataset.requests = performance.getEntriesByType("resource").length;)"),
                                              "");
  EXPECT_EQ(data_of(page, "ready"), "yes");
  EXPECT_EQ(data_of(page, "drawn"), "all");
  EXPECT_EQ(data_of(page, "requests"), "0");
  EXPECT_EQ(data_of(page, "error"), "");
}

TEST(MapPageInBrowser, ComesUpWithNothingToShow) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const std::string page = page_after_scripts(browser, write_map_page(RoadMap(RoadMapParts{})), "");
  EXPECT_EQ(data_of(page, "ready"), "yes");
  EXPECT_EQ(data_of(page, "error"), "");
}

TEST(MapPageInBrowser, RunsNoScriptOutOfANameInItsMap) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const std::string attack = "</script><img src=x onerror='document.title=\"broken in\"'>";
  tests::MadeMap made = tests::three_roads_in_a_row();
  for (Lane& lane : made.parts.lanes) {
    lane.name += attack;
    lane.attributes = {{attack, attack}};
  }
  made.parts.roads[0].name = made.parts.roads[0].source_id = attack;
  MapPageOptions options{.title = attack};
  options.remarks = {{attack, "error", attack, attack, 1, Eigen::Vector2d(60, 0)}};
  const std::string page = page_after_scripts(
      browser,
      with_script(write_map_page(made.build(), options), std::string(kHand) + "press('n');"),
      "#at=10,0");
  EXPECT_EQ(data_of(page, "ready"), "yes");
  EXPECT_FALSE(holds(page, "<title>broken in"));
  EXPECT_FALSE(holds(page, "<img"));
}

}  // namespace
}  // namespace roadbed::map
