#include "roadbed/tools/report/report.h"

#include <string>

#include "roadbed/map/files/html_page.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/tools/report/page_parts.h"

namespace roadbed::tools::inline report {
std::string drive_report_html(const ReportInput& input) {
  return map::filled_page(kPageTemplate, {{"title", map::html_text(input.title)},
                                          {"head", page_head(input)},
                                          {"checks", page_checks(input)},
                                          {"events", page_events(input)},
                                          {"pictures", page_pictures(input)},
                                          {"foot", page_foot(input)},
                                          {"map_data", page_map_json(input)},
                                          {"data", map::json_for_script(page_data_json(input))},
                                          {"page_css", std::string(kPageCss)},
                                          {"page_js", std::string(kPageJs)},
                                          {"dygraphs_css", std::string(kDygraphsCss)},
                                          {"dygraphs_js", std::string(kDygraphsJs)},
                                          {"synchronizer_js", std::string(kSynchronizerJs)},
                                          {"dygraphs_licence", map::html_text(kDygraphsLicence)}});
}

}  // namespace roadbed::tools::report
