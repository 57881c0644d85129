#include "roadbed/tools/report/report.h"

#include <map>
#include <string>
#include <string_view>

#include "roadbed/map/files/xml_characters.h"
#include "roadbed/tools/report/page_parts.h"

namespace roadbed::tools::inline report {
namespace {

using Parts = std::map<std::string_view, std::string>;

// Puts each part where the template says {{name}}. What is put in is not searched again, so that
// no text of the input can name a part.
std::string filled(std::string_view page, const Parts& parts) {
  std::string result;
  for (;;) {
    const std::size_t open = page.find("{{"), close = page.find("}}", open);
    if (open == std::string_view::npos || close == std::string_view::npos) break;
    result += page.substr(0, open);
    result += parts.at(page.substr(open + 2, close - open - 2));
    page.remove_prefix(close + 2);
  }
  result += page;
  return result;
}

}  // namespace

std::string drive_report_html(const ReportInput& input) {
  return filled(kPageTemplate, {{"title", map::html_text(input.title)},
                                {"head", page_head(input)},
                                {"checks", page_checks(input)},
                                {"events", page_events(input)},
                                {"pictures", page_pictures(input)},
                                {"foot", page_foot(input)},
                                {"data", escape_json_for_script(page_data_json(input))},
                                {"page_css", std::string(kPageCss)},
                                {"page_js", std::string(kPageJs)},
                                {"dygraphs_css", std::string(kDygraphsCss)},
                                {"dygraphs_js", std::string(kDygraphsJs)},
                                {"synchronizer_js", std::string(kSynchronizerJs)},
                                {"dygraphs_licence", map::html_text(kDygraphsLicence)}});
}

}  // namespace roadbed::tools::report
