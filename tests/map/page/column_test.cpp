#include "roadbed/map/page/column.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace roadbed::map {
namespace {

TEST(Base64, IsThatOfItsStandard) {  // RFC 4648, section 10
  const std::vector<std::string> plain = {"", "f", "fo", "foo", "foob", "fooba", "foobar"};
  const std::vector<std::string> coded = {"",         "Zg==",     "Zm8=",    "Zm9v",
                                          "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"};
  for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_EQ(base64(plain[i]), coded[i]);
}

std::string column_of(const std::vector<std::int64_t>& numbers) {
  Column column;
  for (const std::int64_t number : numbers) column.add(number);
  return column.text();
}

TEST(Column, FoldsTheSignIntoTheLowestBitAndKeepsSevenBitsAByte) {
  EXPECT_EQ(column_of({0, -1, 1, -2, 63}), base64(std::string("\0\1\2\3\x7e", 5)));
  EXPECT_EQ(column_of({64, -65}), base64("\x80\x01\x81\x01"));
  const std::string least = "\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01";
  EXPECT_EQ(column_of({std::numeric_limits<std::int64_t>::min()}), base64(least));
}

TEST(Column, StepsAreDifferences) {
  Column column;
  for (const std::int64_t number : {10, 12, 12, 5}) column.add_step(number);
  EXPECT_EQ(column.text(), column_of({10, 2, 0, -7}));
}

}  // namespace
}  // namespace roadbed::map
