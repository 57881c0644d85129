#include "roadbed/tools/files/weights_json.h"

#include <gtest/gtest.h>

#include <string>

#include "roadbed/map/files/input_error.h"

namespace roadbed::tools {
namespace {

using planning::CostTerm;

TEST(WeightsJson, NamedTermsAreSetAndOthersKeepTheirDefaults) {
  const auto weights = parse_weights(R"({"offset": 2.5, "time": 0})", "w.json");
  EXPECT_EQ(planning::of(weights, CostTerm::offset), 2.5);
  EXPECT_EQ(planning::of(weights, CostTerm::time), 0.0);
  EXPECT_EQ(planning::of(weights, CostTerm::length),
            planning::of(planning::default_weights(), CostTerm::length));
}

std::string refusal(const std::string& text) {
  try {
    parse_weights(text, "w.json");
  } catch (const map::InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(WeightsJson, RefusesWhatIsNoWeightAndNamesThePlace) {
  EXPECT_NE(refusal(R"({"offset": -1})").find("w.json:/offset"), std::string::npos);
  EXPECT_NE(refusal(R"({"ofset": 1})").find("w.json:/ofset"), std::string::npos);
  EXPECT_NE(refusal(R"({"ofset": 1})").find("longitudinal_jerk"), std::string::npos);
  EXPECT_NE(refusal(R"({"offset": "1"})").find("w.json:/offset"), std::string::npos);
  EXPECT_NE(refusal(R"({"offset": 1e999})").find("w.json"), std::string::npos);
  EXPECT_NE(refusal("[1, 2]").find("w.json"), std::string::npos);
  EXPECT_NE(refusal("").find("w.json"), std::string::npos);
}

}  // namespace
}  // namespace roadbed::tools
