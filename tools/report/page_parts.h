#pragma once

#include <string_view>

namespace roadbed::tools::inline report {

// The parts of the report's page, put into the program when it is built (embed.cmake).
extern const std::string_view kPageTemplate;  ///< with {{name}} where text goes
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;
extern const std::string_view kDygraphsCss;
extern const std::string_view kDygraphsJs;
extern const std::string_view kSynchronizerJs;
extern const std::string_view kDygraphsLicence;  ///< plain text

}  // namespace roadbed::tools
