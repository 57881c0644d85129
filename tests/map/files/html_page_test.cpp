#include "roadbed/map/files/html_page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace roadbed::map {
namespace {

TEST(JsonForScript, CannotEndTheElementAndMeansTheSame) {
  const nlohmann::json json = {{"name", "</script><!-- & -->"}};
  const std::string escaped = json_for_script(json.dump());
  EXPECT_EQ(escaped.find_first_of("<>&"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(escaped), json);
}

TEST(FilledPage, PutsEachPartWhereItsNameStandsAndNeverLooksIntoIt) {
  EXPECT_EQ(filled_page("a {{one}} b {{two}}{{one}}.", {{"one", "{{two}}"}, {"two", "2"}}),
            "a {{two}} b 2{{two}}.");
  EXPECT_EQ(filled_page("nothing {{ open", {}), "nothing {{ open");
  EXPECT_THROW(filled_page("{{three}}", {}), std::out_of_range);
}

}  // namespace
}  // namespace roadbed::map
