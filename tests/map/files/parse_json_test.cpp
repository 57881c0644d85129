#include "roadbed/map/files/parse_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "roadbed/tests/support/refusal_of.h"

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
  return tests::refusal_of([&] { parse_json(text, "a.json", rules); });
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
  EXPECT_EQ(refusal("[[[]]]", rules), "accepted");
  EXPECT_THAT(refusal("[[[[]]]]", rules), HasSubstr("nested too deeply"));
  EXPECT_THAT(refusal(R"([{"a":[{}]}])", rules), HasSubstr("nested too deeply"));
}

// 5 million of them would take 500 MB; numbers that are written out take no more than they may.
TEST(ParseJson, RefusesMoreValuesThanADocumentOfItsSizeHolds) {
  std::string empty_objects = "[", numbers = "[";
  for (int i = 0; i < 5'000'000; ++i) empty_objects += "{},";
  for (int i = 0; i < 1'000'000; ++i) numbers += "123.4567,";
  EXPECT_THAT(refusal(empty_objects + "{}]"), HasSubstr("more values than 188 MB of memory hold"));
  EXPECT_EQ(refusal(numbers + "1]"), "accepted");
}

/// The document, put together from its parts.
Json from_parts(const std::string& text, std::size_t level) {
  Json whole;
  const auto take = [&](std::span<const std::string> keys, Json part) {
    Json* at = &whole;
    for (const std::string& key : keys) {
      if (at->is_null()) *at = Json::object();
      at = &(*at)[key];
    }
    if (at->is_null() || !part.is_object()) *at = std::move(part);
  };
  parse_json_parts(text, "a.json", {}, level, take);
  return whole;
}

TEST(ParseJsonParts, MakeTheDocument) {
  std::mt19937 random(20261125);
  for (int i = 0; i < 2000; ++i) {
    const Json written = random_json(random, 5);
    for (const std::size_t level : {0, 1, 2, 3}) {
      EXPECT_EQ(from_parts(written.dump(), level), written) << written.dump();
    }
  }
}

TEST(ParseJsonParts, AreHandedOverOneByOneInTheFilesOrder) {
  std::vector<std::string> seen;
  const auto take = [&](std::span<const std::string> keys, const Json& part) {
    std::string line;
    for (const std::string& key : keys) line += key + "/";
    seen.push_back(line + part.dump());
  };
  parse_json_parts(R"({"b":{"y":{"n":[1]},"x":2},"a":[{"q":{"r":3}}],"c":4})", "a.json", {}, 2,
                   take);
  EXPECT_THAT(
      seen, testing::ElementsAre(R"(b/y/{"n":[1]})", "b/x/2", R"(b/{"x":null,"y":null})",
                                 R"(a/[{"q":{"r":3}}])", "c/4", R"({"a":null,"b":null,"c":null})"));
}

}  // namespace
}  // namespace roadbed::map
