// What only a browser can tell: the scripts' own tests, and that the page comes up.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/files/read_file.h"
#include "roadbed/tests/support/browser.h"
#include "roadbed/tests/support/holds.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/sample_report.h"
#include "roadbed/tools/report/audit_pages.h"
#include "roadbed/tools/report/page_parts.h"
#include "roadbed/tools/report/report.h"

namespace roadbed::tools {
namespace {

using tests::holds;
using tests::page_after_scripts;

// The page with a script at its end that writes down which files it asked for.
std::string page_that_counts_requests(const ReportInput& input) {
  std::string html = drive_report_html(input);
  const std::string count =
      "<script>document.documentElement.dataset.requests = "
      "performance.getEntriesByType('resource').length;</script>";
  return html.insert(html.rfind("</body>"), count);
}

std::string script_tests_page() {
  const auto file = tests::tests_folder() / "tools/report/page_test.js";
  return "<!DOCTYPE html><meta charset=\"utf-8\"><body><script>" + std::string(kPageJs) +
         map::read_file(file) + "</script></body>";
}

TEST(ReportInBrowser, ItsScriptsKeepTheirLaws) {
  ROADBED_BROWSER_OR_SKIP(browser);
  EXPECT_THAT(page_after_scripts(browser, script_tests_page(), ""),
              testing::ContainsRegex("all [0-9]+ hold"));
}

TEST(ReportInBrowser, ShowsTheMomentOfItsLinkWithoutErrorOrRequest) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const std::string page =
      page_after_scripts(browser, page_that_counts_requests(tests::sample_report()), "#t=9.5");
  EXPECT_TRUE(holds(page, "data-ready=\"yes\""));
  EXPECT_FALSE(holds(page, "data-error"));
  EXPECT_TRUE(holds(page, "data-requests=\"0\""));
  EXPECT_TRUE(holds(page, ">9.50 s</output>"));
  EXPECT_TRUE(holds(page, "<b class=\"\">pass</b> parked-1 narrows the lane"));
}

// Types keys, clicks on a check's moment and writes down the clock after each.
constexpr std::string_view kVisitor = R"(<script>
const times = [], note = () => times.push(document.getElementById("clock").textContent);
for (const [key, shiftKey] of [["ArrowRight", false], ["ArrowRight", true], ["]", false],
                               ["End", false], ["[", false], ["Home", false]]) {
  document.body.dispatchEvent(new KeyboardEvent("keydown", {key, shiftKey, bubbles: true}));
  note();
}
document.querySelector("#checks a[data-t='7.1']").click();
note();
document.documentElement.dataset.times = times.join(", ");
document.documentElement.dataset.hash = location.hash;
</script>)";

TEST(ReportInBrowser, GoesWhereKeysAndLinksSay) {
  ROADBED_BROWSER_OR_SKIP(browser);
  std::string html = drive_report_html(tests::sample_report());
  html.insert(html.rfind("</body>"), kVisitor);
  const std::string page = page_after_scripts(browser, html, "#t=5");
  EXPECT_TRUE(
      holds(page, "data-times=\"5.10 s, 6.10 s, 9.50 s, 40.00 s, 19.00 s, 0.00 s, 7.10 s\""))
      << page.substr(0, 400);
  EXPECT_TRUE(holds(page, "data-hash=\"#t=7.1\""));
}

TEST(ReportInBrowser, SaysWhatBecameOfEachHypothesisAndDrawsItsStPicture) {
  ROADBED_BROWSER_OR_SKIP(browser);
  std::string html = drive_report_html(tests::sample_report());
  html.insert(html.rfind("</body>"), R"(<script>
const rows = [...document.querySelectorAll(".hypotheses tbody tr")].map((row) => [...row.cells].map((cell) => cell.textContent).join("|"));
const canvas = document.querySelector("canvas.st"), pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
document.documentElement.dataset.rows = rows.join(" / ");
document.documentElement.dataset.inks = new Set(new Uint32Array(pixels.buffer)).size > 20;
document.documentElement.dataset.pressed = document.querySelectorAll(".hypotheses button[aria-pressed=true]").length;
</script>)");
  const std::string page = page_after_scripts(browser, html, "#t=5");
  EXPECT_TRUE(holds(page,
                    "data-rows=\"overtake|no path|||oncoming-3 comes: 40 m are missing / "
                    "keep lane|d 0.4 m, l 22.0 m|0.300|1.250|✔ driven\""))
      << page.substr(0, 600);
  EXPECT_TRUE(holds(page, "data-inks=\"true\""));
  EXPECT_TRUE(holds(page, "data-pressed=\"1\""));
}

TEST(ReportInBrowser, NamesTheLaneUnderThePointerAsTheMapDoes) {
  ROADBED_BROWSER_OR_SKIP(browser);
  std::string html = drive_report_html(tests::sample_report());
  html.insert(html.rfind("</body>"), R"(<script>
setTimeout(() => {  // when the view has gone to the vehicle
  const map = document.getElementById("map"), box = map.getBoundingClientRect(), named = new Set();
  for (let y = 2; y < box.height; y += 2) {
    const at = {clientX: box.left + box.width / 2, clientY: box.top + y, bubbles: true};
    map.dispatchEvent(new PointerEvent("pointermove", at));
    named.add(/lane (\S+)/.exec(document.getElementById("place").textContent)?.[1] ?? "none");
  }
  document.documentElement.dataset.named = [...named].sort().join(" ");
}, 500);
</script>)");
  const std::string page = page_after_scripts(browser, html, "#t=5&follow");
  EXPECT_TRUE(holds(page, "data-named=\"12/0/-1 12/0/-2 12/0/1 12/0/2 none\""))
      << page.substr(0, 600);
}

// Whether the map and the last plot end above the bar of time, which ends where the window does.
constexpr std::string_view kMeasure = R"(<script>
const bottomOf = (selector) => Math.max(...[...document.querySelectorAll(selector)].map((one) => one.getBoundingClientRect().bottom));
const player = document.getElementById("player").getBoundingClientRect();
const shown = document.querySelectorAll("#plots figure").length;
document.documentElement.dataset.fits = `${shown} ${bottomOf(".stage, #plots figure") <= player.top} ${player.bottom <= innerHeight}`;
</script>)";

std::string page_that_measures(ReportInput input, std::size_t plots) {
  while (input.plots.size() > plots) input.plots.pop_back();
  while (input.plots.size() < plots) input.plots.push_back(input.plots.front());
  std::string html = drive_report_html(input);
  return html.insert(html.rfind("</body>"), kMeasure);
}

TEST(ReportInBrowser, ShowsTheMapAndAllPlotsOnTheFirstScreen) {
  ROADBED_BROWSER_OR_SKIP(browser);
  for (const std::size_t plots : {2U, 4U, 6U}) {
    const std::string page =
        page_after_scripts(browser, page_that_measures(tests::sample_report(), plots), "");
    EXPECT_TRUE(holds(page, "data-fits=\"" + std::to_string(plots) + " true true\""))
        << plots << " plots: " << page.substr(0, 300);
  }
}

TEST(AuditIndexInBrowser, IsSortedByAHeadAndChosenFromByVerdict) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const std::vector<IndexedAudit> audits{{"b", Tone::good, "clear", "10.5 m", "", {}},
                                         {"c", Tone::bad, "conflict", "0.0 m", "", {}},
                                         {"a", Tone::open, "unusable", "", "", {}},
                                         {"d", Tone::good, "clear", "2.5 m", "", {}}};
  std::string html = audit_index_html(audits, "town.bt", "roadbed");
  html.insert(html.rfind("</body>"), R"(<script>
const order = () => [...document.querySelectorAll("tbody tr")].filter((row) => !row.hidden)
    .map((row) => row.querySelector("a").textContent).join("");
const seen = [order()];
const heads = document.querySelectorAll("th button");
for (const column of [1, 3, 3]) {
  heads[column].click();
  seen.push(order());
}
document.querySelector("fieldset input").click();
seen.push(order());
document.documentElement.dataset.seen = seen.join(" ");
</script>)");
  const std::string page = page_after_scripts(browser, html, "");
  EXPECT_TRUE(holds(page, "data-seen=\"bcad abcd cdba bdca ca\"")) << page.substr(0, 200);
}

TEST(ReportInBrowser, ComesUpWithNothingToShow) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const std::string page = page_after_scripts(browser, drive_report_html({}), "");
  EXPECT_TRUE(holds(page, "data-ready=\"yes\""));
  EXPECT_FALSE(holds(page, "data-error"));
  EXPECT_TRUE(holds(page, "No drive"));
}

TEST(ReportInBrowser, RunsNoScriptOutOfANameInItsInput) {
  ROADBED_BROWSER_OR_SKIP(browser);
  const std::string attack = "</script><img src=x onerror='document.title=\"broken in\"'>";
  ReportInput input = tests::sample_report();
  input.scenario = input.origin.command = input.origin.crs = attack;
  map::RoadMapParts road = tests::sample_road();
  road.lanes[0].name = attack;
  input.scene.road_map = std::make_shared<const map::RoadMap>(std::move(road));
  input.scene.obstacles[0].id = input.drive.cycles[0].plan_reason = attack;
  input.drive.cycles[0].chosen.reset();
  input.decisions[0].state = input.decisions[0].reason = input.drive.events[0].text = attack;
  input.plots[0].title = input.plots[0].series[0].name = input.checks[0].name = attack;
  input.checks[0].bound = input.origin.sources[0].name = input.verdict.text = attack;
  const std::string page = page_after_scripts(browser, drive_report_html(input), "#t=0");
  EXPECT_TRUE(holds(page, "data-ready=\"yes\""));
  EXPECT_FALSE(holds(page, "<title>broken in"));
  EXPECT_FALSE(holds(page, "<img"));
}

}  // namespace
}  // namespace roadbed::tools
