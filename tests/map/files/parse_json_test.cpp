#include "roadbed/map/files/parse_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "roadbed/map/files/input_error.h"

namespace roadbed::map {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

Json random_json(std::mt19937& random, int depth) {
  const auto pick = [&](int of) { return static_cast<int>(random() % static_cast<unsigned>(of)); };
  switch (pick(depth > 0 ? 8 : 6)) {
    case 0:
      return nullptr;
    case 1:
      return pick(2) == 0;
    case 2:
      return pick(2000) - 1000;
    case 3:
      return 0.1 * pick(2000);
    case 4:
      return std::string(static_cast<std::size_t>(pick(40)), 'x') + "\"\\\n\u00e9";
    case 5:
      return static_cast<std::uint64_t>(random()) << 32;
    case 6: {
      Json list = Json::array();
      for (int i = pick(6); i > 0; --i) list.push_back(random_json(random, depth - 1));
      return list;
    }
    default: {
      Json object = Json::object();
      for (int i = pick(6); i > 0; --i) {
        object["k" + std::to_string(pick(100))] = random_json(random, depth - 1);
      }
      return object;
    }
  }
}

std::string refusal(const std::string& text, const JsonRules& rules = {}) {
  try {
    parse_json(text, "a.json", rules);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ParseJson, ReadsWhatWasWritten) {
  std::mt19937 random(20261125);
  for (int i = 0; i < 2000; ++i) {
    const Json written = random_json(random, 5);
    EXPECT_EQ(parse_json(written.dump(i % 3), "a.json"), written);
  }
}

TEST(ParseJson, LeavesFaultsOfTheTextToTheLibrary) {
  EXPECT_THROW(parse_json("{\"a\":1", "a.json"), Json::parse_error);
  EXPECT_THROW(parse_json("[1] 2", "a.json"), Json::parse_error);
  EXPECT_THROW(parse_json("", "a.json"), Json::parse_error);
  EXPECT_THROW(parse_json("[1e999]", "a.json"), Json::out_of_range);
}

TEST(ParseJson, RefusesAKeyThatStandsTwiceOrTakesTheLastOne) {
  const std::string text = R"({"b":{"a":1},"c":{"a":2,"a":3}})";
  EXPECT_THAT(refusal(text), HasSubstr("key \"a\": stands twice in one object"));
  EXPECT_EQ(parse_json(text, "a.json", {.keys_stand_once = false})["c"]["a"], 3);
}

TEST(ParseJson, RefusesListsInEachOtherBeyondTheMost) {
  const JsonRules rules{.most_levels = 3};
  EXPECT_EQ(refusal("[[[]]]", rules), "");
  EXPECT_THAT(refusal("[[[[]]]]", rules), HasSubstr("nested too deeply"));
  EXPECT_THAT(refusal(R"([{"a":[{}]}])", rules), HasSubstr("nested too deeply"));
}

// 5 million of them would take 500 MB; numbers that are written out take no more than they may.
TEST(ParseJson, RefusesMoreValuesThanADocumentOfItsSizeHolds) {
  std::string empty_objects = "[", numbers = "[";
  for (int i = 0; i < 5'000'000; ++i) empty_objects += "{},";
  for (int i = 0; i < 1'000'000; ++i) numbers += "123.4567,";
  EXPECT_THAT(refusal(empty_objects + "{}]"), HasSubstr("more values than 188 MB of memory hold"));
  EXPECT_EQ(refusal(numbers + "1]"), "");
}

}  // namespace
}  // namespace roadbed::map
