#include "roadbed/tools/batch/batch_results.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tools/cli/build_id.h"
#include "roadbed/tools/files/streamed_output.h"
#include "roadbed/tools/report/table_script.h"

namespace roadbed::tools::inline batch {
namespace {

constexpr std::size_t kMostListed = 500;  // of each kind

// The colours are those of the report of a drive.
constexpr std::string_view kHead = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src 'self' file:">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<style>
:root {{
  --page: #f6f7f9; --card: #ffffff; --line: #d9dde3; --text: #1b2029; --quiet: #5d6673;
  --accent: #0072b2; --good: #00785a; --good-soft: #e0f3ec; --bad: #b83d00; --bad-soft: #fce9df;
  --open: #7a5600; --open-soft: #fbf0d2;
}}
@media (prefers-color-scheme: dark) {{
  :root {{
    --page: #12151a; --card: #1a1e25; --line: #323944; --text: #e7eaee; --quiet: #9aa4b1;
    --accent: #56b4e9; --good: #4cc9a0; --good-soft: #12322a; --bad: #ff9b66; --bad-soft: #3a2115;
    --open: #f0c45c; --open-soft: #332a12;
  }}
}}
* {{ box-sizing: border-box; }}
body {{
  margin: 0 auto; padding: 14px 20px; max-width: 1400px; background: var(--page);
  color: var(--text); font: 14px/1.45 system-ui, "Segoe UI", "DejaVu Sans", sans-serif;
  font-variant-numeric: tabular-nums;
}}
h1 {{ font-size: 20px; margin: 0 0 10px; overflow-wrap: anywhere; }}
h2 {{ font-size: 15px; margin: 26px 0 8px; }}
.counts {{ display: flex; flex-wrap: wrap; gap: 8px; margin: 0; padding: 0; list-style: none; }}
.counts li {{ padding: 8px 14px; border-radius: 8px; font-weight: 600; background: var(--card); }}
.counts .done, td.done {{ background: var(--good-soft); color: var(--good); }}
.counts .no, td.no {{ background: var(--open-soft); color: var(--open); }}
.counts .failed, td.failed {{ background: var(--bad-soft); color: var(--bad); }}
table {{
  width: 100%; min-width: 760px; table-layout: fixed; border-collapse: collapse;
  background: var(--card);
}}
th, td {{
  padding: 5px 10px; border: 1px solid var(--line); text-align: left; vertical-align: top;
  overflow-wrap: anywhere;
}}
th {{ color: var(--quiet); font-weight: 600; font-size: 12px; }}
th:nth-child(1) {{ width: 5.5em; }}
th:nth-child(2) {{ width: 8.5em; }}
th:nth-child(4) {{ width: 30%; }}
th:nth-child(5) {{ width: 24%; }}
td.line {{ text-align: right; white-space: nowrap; }}
td.status {{ white-space: nowrap; font-weight: 600; }}
td.about {{ color: var(--quiet); font-size: 12.5px; }}
td.files {{ font-size: 12.5px; }}
th, td.files a {{ white-space: nowrap; }}
td.files a {{ display: inline-block; margin-right: 0.8em; }}
a {{ color: var(--accent); }}
{table_css}.note, footer {{ color: var(--quiet); }}
footer {{ margin-top: 26px; }}
</style>
</head>
<body>
<h1>{title}</h1>
)";

struct Look {
  std::string_view css_class, sign, word;
};

Look look_of(JobStatus status) {
  switch (status) {
    case JobStatus::done:
      return {"done", "✔", "done"};
    case JobStatus::no:
      return {"no", "?", "no"};
    case JobStatus::failed:
      return {"failed", "✖", "failed"};
  }
  return {"failed", "✖", "failed"};
}

std::string count_item(const BatchSummary& summary, JobStatus status) {
  const Look look = look_of(status);
  return fmt::format("<li class=\"{}\">{} {} {}</li>\n", look.css_class, look.sign,
                     with_commas(summary.count(status)), look.word);
}

// A path as a link holds it, so that no sign of a name has a meaning of its own.
std::string percent_encoded(std::string_view path) {
  constexpr std::string_view plain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~/";
  std::string encoded;
  for (const char sign : path) {
    if (plain.find(sign) != std::string_view::npos) {
      encoded += sign;
    } else {
      encoded += fmt::format("%{:02X}", static_cast<unsigned char>(sign));
    }
  }
  return encoded;
}

// What follows the hash and a sign; the whole name where others have named it.
std::string shown_name(const std::string& file, const std::string& hash) {
  const std::size_t begin = file.rfind(hash);
  const std::size_t skipped = begin + hash.size() + 1;
  return begin == std::string::npos || skipped >= file.size() ? file : file.substr(skipped);
}

// A report first: it is what a reader wants to see.
std::string links(const WorstCase& job) {
  std::string pictures, reports, others;
  for (const std::string& file : job.files) {
    if (file.ends_with("drive.svg")) {
      pictures += fmt::format("<img loading=\"lazy\" src=\"{}\" alt=\"\">", percent_encoded(file));
    }
    const bool is_page = file.ends_with(".html");
    const std::string shown = is_page ? "report" : shown_name(file, job.hash);
    (is_page ? reports : others) +=
        fmt::format("<a href=\"{}\">{}</a> ", percent_encoded(file), map::html_text(shown));
  }
  return pictures + reports + others;
}

std::string row(const WorstCase& job) {
  const Look look = look_of(job.status);
  return fmt::format(
      "<tr><td class=\"line\">{}</td><td class=\"status {}\">{} {}</td><td>{}</td>"
      "<td class=\"about\">{}</td><td class=\"files thumb\">{}</td></tr>\n",
      job.line, look.css_class, look.sign, look.word, map::html_text(map::one_line(job.text)),
      map::html_text(map::one_line(job.about)), links(job));
}

std::string section(const std::string& kind, const KindSummary& summary) {
  const std::vector<WorstCase> worst = summary.worst();
  std::string html = fmt::format(
      "<h2>{}</h2>\n<p class=\"note\">{} done, {} no, {} failed{}</p>\n"
      "<table class=\"sortable\">\n<thead><tr><th>line</th><th data-choose>status</th>"
      "<th>what came out</th><th>job</th><th>files</th></tr></thead>\n<tbody>\n",
      kind.empty() ? "lines that are no jobs" : map::html_text(kind),
      with_commas(summary.count(JobStatus::done)), with_commas(summary.count(JobStatus::no)),
      with_commas(summary.count(JobStatus::failed)),
      worst.size() < summary.count()
          ? fmt::format("; the worst {} are listed, all are in results.jsonl",
                        with_commas(worst.size()))
          : "; worst first");
  for (const WorstCase& job : worst) html += row(job);
  return html + "</tbody></table>\n";
}

// One page of a batch that works offline: counts, then of each kind the worst cases first, each
// with links to its files beside the page; in the light or the dark, as the reader's system is.
std::string batch_page(const BatchSummary& summary, const std::string& title) {
  std::string html = fmt::format(fmt::runtime(kHead), fmt::arg("title", map::html_text(title)),
                                 fmt::arg("table_css", kTableCss));
  html += fmt::format("<ul class=\"counts\">\n<li>{} jobs</li>\n", with_commas(summary.count()));
  for (const JobStatus status : {JobStatus::failed, JobStatus::no, JobStatus::done}) {
    html += count_item(summary, status);
  }
  html += "</ul>\n";
  for (const auto& [kind, of_kind] : summary.kinds()) html += section(kind, of_kind);
  return html + "<footer>" + name_and_version() +
         ": all results are in <a href=\"results.jsonl\">results.jsonl</a>, counts in "
         "<a href=\"summary.json\">summary.json</a></footer>\n<script>" +
         std::string(kTableScript) + "</script>\n</body>\n</html>\n";
}

}  // namespace

BatchSummary write_results(const ResultStore& store, const std::vector<LineResult>& order,
                           const std::filesystem::path& folder) {
  BatchSummary summary(kMostListed);
  BufferedOutput results(folder / "results.jsonl", true);
  for (const LineResult& job : order) {
    const std::string line = store.line(job.hash);
    results.add(fmt::format("{{\"line\":{},", job.line));
    results.add(std::string_view(line).substr(1));
    results.add("\n");
    summary.add(job.line, line);
  }
  results.commit();
  map::write_output(folder / "summary.json", summary.document(kMostInSummary), true);
  map::write_output(folder / "index.html",
                    batch_page(summary, fmt::format("{} jobs", with_commas(order.size()))), true);
  return summary;
}

}  // namespace roadbed::tools::batch
