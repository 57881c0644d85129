#include "roadbed/tools/report/page_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/files/xml_characters.h"

namespace roadbed::tools::inline report {
namespace {

// "12.5", not "12.500": at most `decimals`, no zeros at the end, no minus zero.
std::string short_number(double value, int decimals) {
  if (!std::isfinite(value)) return value > 0 ? "∞" : (value < 0 ? "−∞" : "–");
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

struct WordLook {
  std::string_view css_class, sign;
};

WordLook look_of(Tone tone) {
  switch (tone) {
    case Tone::good:
      return {"good", "✔"};
    case Tone::open:
      return {"open", "?"};
    case Tone::bad:
      return {"bad", "✖"};
  }
  return {"bad", "✖"};
}

std::string verdict_html(const ReportVerdict& verdict, std::string_view label) {
  const WordLook look = look_of(verdict.tone);
  return fmt::format("<p class=\"verdict {}\"><span class=\"sign\">{}</span><span>{}{}</span></p>",
                     look.css_class, look.sign, label, map::html_text(verdict.text));
}

double driven_m(const geometry::Trajectory& drive) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < drive.points().size(); ++i) {
    const Eigen::Vector2d step =
        drive.points()[i].pose().position() - drive.points()[i - 1].pose().position();
    length_m += step.norm();
  }
  return length_m;
}

struct Fact {
  std::string_view name;
  std::string value;
};

std::vector<Fact> facts_of_drive(const geometry::Trajectory& drive) {
  if (drive.empty()) return {};
  double top_mps = 0.0, strongest_mps2 = 0.0, lateral_mps2 = 0.0;
  for (const auto& p : drive.points()) {
    top_mps = std::max(top_mps, p.speed_mps);
    strongest_mps2 = std::max(strongest_mps2, std::abs(p.acceleration_mps2));
    lateral_mps2 = std::max(lateral_mps2, std::abs(p.speed_mps * p.speed_mps * p.curvature_per_m));
  }
  return {{"duration", fmt::format("{:.1f} s", drive.end_s() - drive.start_s())},
          {"driven", fmt::format("{:.1f} m", driven_m(drive))},
          {"top speed", fmt::format("{:.1f} m/s", top_mps)},
          {"largest acceleration", fmt::format("{:.2f} m/s²", strongest_mps2)},
          {"largest lateral acceleration", fmt::format("{:.2f} m/s²", lateral_mps2)}};
}

bool is_bound(const ReportCheck& check) { return !check.bound.empty(); }

bool has_failed(const ReportCheck& check) { return is_bound(check) && !check.passed; }

std::string facts_html(const ReportInput& input) {
  std::vector<Fact> facts = facts_of_drive(input.drive.trajectory);
  const auto bound = std::ranges::count_if(input.checks, is_bound);
  const auto failed = std::ranges::count_if(input.checks, has_failed);
  if (bound > 0) {
    facts.push_back({"checks passed", fmt::format("{} of {}", bound - failed, bound)});
  }
  std::string html = "<dl class=\"facts\">";
  for (const Fact& fact : facts) {
    html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", fact.name, fact.value);
  }
  return html + "</dl>";
}

std::string moment_link(double t_s) {
  const std::string t = short_number(t_s, 2);
  return fmt::format("<a href=\"#t={0}\" data-t=\"{0}\">{0} s</a>", t);
}

std::string result_cell(const ReportCheck& check) {
  if (!is_bound(check)) return "<td class=\"none\">noted</td>";
  return check.passed ? "<td class=\"passed\">✔ passed</td>" : "<td class=\"failed\">✖ failed</td>";
}

std::string check_row(const ReportCheck& check) {
  const std::string value =
      check.value ? short_number(*check.value, 3) + ' ' + map::html_text(check.unit) : "–";
  return fmt::format(
      "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td>"
      "<td class=\"number\">{}</td>{}</tr>\n",
      map::html_text(check.name), value, map::html_text(check.bound),
      map::html_text(check.bound_from), check.at_s ? moment_link(*check.at_s) : "",
      result_cell(check));
}

std::string_view sign_of(EventLevel level) {
  switch (level) {
    case EventLevel::info:
      return "<span class=\"sign info\" title=\"note\">●</span>";
    case EventLevel::warning:
      return "<span class=\"sign warning\" title=\"warning\">▲</span>";
    case EventLevel::fault:
      return "<span class=\"sign fault\" title=\"fault\">✖</span>";
  }
  return {};
}

std::string foot_entry(std::string_view name, const std::string& html) {
  return html.empty() ? "" : fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, html);
}

std::string code(const std::string& text) {
  return text.empty() ? text : "<code>" + map::html_text(text) + "</code>";
}

// One entry per role, in the order of their first files; many files are folded away.
std::string sources_html(const std::vector<ReportSource>& sources) {
  constexpr std::size_t kMostShown = 4;
  std::vector<std::pair<std::string, std::vector<std::string>>> roles;
  for (const ReportSource& source : sources) {
    auto role = std::ranges::find(roles, source.role, [](const auto& one) { return one.first; });
    if (role == roles.end()) role = roles.insert(role, {source.role, {}});
    role->second.push_back(code(source.name) + " SHA-256 " + code(source.sha256));
  }
  std::string html;
  for (const auto& [role, files] : roles) {
    const std::string list = fmt::format("{}", fmt::join(files, "<br>"));
    html += foot_entry(
        map::html_text(role),
        files.size() <= kMostShown
            ? list
            : fmt::format("<details><summary>{} files</summary>{}</details>", files.size(), list));
  }
  return html;
}

}  // namespace

std::string page_head(const ReportInput& input) {
  std::string html =
      fmt::format("<div class=\"name\"><h1>{}</h1><p class=\"scenario\">{}</p></div>\n",
                  map::html_text(input.title), map::html_text(input.scenario));
  html += facts_html(input);
  html += "<div class=\"verdicts\">" + verdict_html(input.verdict, "");
  if (input.audit) html += verdict_html(*input.audit, "Occupancy: ");
  return html + "</div>";
}

std::string page_checks(const ReportInput& input) {
  std::string html = "<section class=\"card\"><h2>What was checked</h2>\n";
  if (input.checks.empty()) return html + "<p class=\"none\">Nothing.</p></section>";
  html +=
      "<table id=\"checks\"><thead><tr><th>check</th><th class=\"number\">value</th>"
      "<th class=\"number\">bound</th><th>bound from</th><th "
      "class=\"number\">at</th><th>result</th></tr></thead>"
      "<tbody>\n";
  for (const ReportCheck& check : input.checks) html += check_row(check);
  return html + "</tbody></table></section>";
}

std::string page_pictures(const ReportInput& input) {
  if (input.pictures.empty()) return {};
  std::string html = "<section class=\"tables\"><section class=\"card\"><h2>Close-ups</h2>\n";
  html += "<div class=\"pictures\">\n";
  for (const ReportPicture& picture : input.pictures) {
    html += fmt::format("<figure>{}<figcaption>{} <span>{}</span></figcaption></figure>\n",
                        picture.svg, moment_link(picture.t_s), map::html_text(picture.text));
  }
  return html + "</div></section></section>";
}

std::string page_events(const ReportInput& input) {
  std::string html = "<section class=\"card\"><h2>What happened</h2>\n";
  if (input.drive.events.empty()) return html + "<p class=\"none\">Nothing of note.</p></section>";
  html += "<ol class=\"events\">\n";
  for (const DriveEvent& event : input.drive.events) {
    html += fmt::format("<li>{}{}<span>{}</span></li>\n", sign_of(event.level),
                        moment_link(event.t_s), map::html_text(event.text));
  }
  return html + "</ol></section>";
}

std::string page_foot(const ReportInput& input) {
  std::string html = "<dl>\n";
  html += foot_entry("Made by", map::html_text(input.origin.version));
  html += foot_entry("Again with", code(input.origin.command));
  html += foot_entry("Coordinates", input.origin.crs.empty() ? "as in the map; its CRS is unknown"
                                                             : code(input.origin.crs));
  return html + sources_html(input.origin.sources) + "</dl>";
}

}  // namespace roadbed::tools::report
