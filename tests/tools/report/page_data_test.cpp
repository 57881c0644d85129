#include "roadbed/tools/report/page_parts.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace roadbed::tools {
namespace {

TEST(EscapeJsonForScript, CannotEndTheElementAndMeansTheSame) {
  const nlohmann::json json = {{"name", "</script><!-- & -->"}};
  const std::string escaped = escape_json_for_script(json.dump());
  EXPECT_EQ(escaped.find_first_of("<>&"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(escaped), json);
}

}  // namespace
}  // namespace roadbed::tools
