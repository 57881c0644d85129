#include "roadbed/tools/report/audit_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "roadbed/map/files/xml_characters.h"
#include "roadbed/tools/report/page_parts.h"
#include "roadbed/tools/report/table_script.h"

namespace roadbed::tools::inline report {
namespace {

constexpr std::string_view kIndexCss = R"(
main { display: block; }
pre { white-space: pre-wrap; overflow-wrap: anywhere; }
.index td, .index th { padding: 4px 10px; text-align: left; }
.index .good { color: var(--good); } .index .bad { color: var(--bad); }
.index .open { color: var(--open); }
article { margin: 14px 0; }
)";

std::string_view css_of(Tone tone) {
  constexpr std::array<std::string_view, 3> names{"good", "open", "bad"};
  return names[static_cast<std::size_t>(tone)];
}

std::string row(const IndexedAudit& audit, std::size_t number) {
  return fmt::format(
      "<tr><td class=\"thumb\">{}</td><td><a href=\"#drive-{}\">{}</a></td>"
      "<td class=\"{}\">{}</td><td>{}</td></tr>\n",
      audit.pictures.empty() ? "" : audit.pictures.front().svg, number, map::html_text(audit.name),
      css_of(audit.tone), map::html_text(audit.outcome), map::html_text(audit.least));
}

std::string article(const IndexedAudit& audit, std::size_t number) {
  std::string html =
      fmt::format("<article class=\"card\" id=\"drive-{}\"><h2>{}</h2>\n<pre>{}</pre>\n", number,
                  map::html_text(audit.name), map::html_text(audit.text));
  if (!audit.pictures.empty()) html += "<div class=\"pictures\">\n";
  for (const ReportPicture& picture : audit.pictures) {
    html += fmt::format("<figure>{}<figcaption>{:.2f} s <span>{}</span></figcaption></figure>\n",
                        picture.svg, picture.t_s, map::html_text(picture.text));
  }
  if (!audit.pictures.empty()) html += "</div>\n";
  return html + "</article>\n";
}

// "5 clear, 2 conflict": in order of their first drive.
std::string counts_text(const std::vector<IndexedAudit>& audits) {
  std::vector<std::pair<std::string, std::size_t>> counts;
  for (const IndexedAudit& audit : audits) {
    const auto known =
        std::ranges::find(counts, audit.outcome, &std::pair<std::string, std::size_t>::first);
    if (known == counts.end()) {
      counts.emplace_back(audit.outcome, 1);
    } else {
      ++known->second;
    }
  }
  std::string text;
  for (const auto& [outcome, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, outcome);
  }
  return text;
}

}  // namespace

std::string audit_index_html(const std::vector<IndexedAudit>& audits, const std::string& occupancy,
                             const std::string& version) {
  const std::string title = fmt::format("Audit of {} drives", audits.size());
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>{0}</title>\n"
      "<style>\n{1}{2}{5}</style>\n</head>\n<body>\n<header><div class=\"name\"><h1>{0}</h1>"
      "<p class=\"scenario\">against {3}: {4}</p></div></header>\n<main>\n",
      title, kPageCss, kIndexCss, map::html_text(occupancy), map::html_text(counts_text(audits)),
      kTableCss);
  html +=
      "<section class=\"card\"><table class=\"index sortable\"><thead><tr><th>picture</th>"
      "<th>drive</th><th data-choose>verdict</th><th>least clearance</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < audits.size(); ++i) html += row(audits[i], i + 1);
  html += "</tbody></table></section>\n";
  for (std::size_t i = 0; i < audits.size(); ++i) html += article(audits[i], i + 1);
  return html + fmt::format(
                    "</main>\n<footer><p>Made by {}</p></footer>\n<script>{}</script>\n"
                    "</body>\n</html>\n",
                    map::html_text(version), kTableScript);
}

}  // namespace roadbed::tools::report
