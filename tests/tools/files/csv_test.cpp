#include "roadbed/tools/files/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "roadbed/map/files/csv_field.h"
#include "roadbed/map/files/input_error.h"

namespace roadbed::tools {
namespace {

using testing::ElementsAre;

TEST(Csv, FieldsInQuotesKeepCommasSpacesAndQuotes) {
  EXPECT_THAT(csv_fields(R"(a, b ,"c, d"  ," ""e"" ",)"),
              ElementsAre("a", "b", "c, d", " \"e\" ", ""));
  EXPECT_THAT(csv_fields(R"(5" pipe,"open, to the end)"),
              ElementsAre("5\" pipe", "open, to the end"));
  EXPECT_THAT(csv_fields(""), ElementsAre(""));
  EXPECT_THAT(csv_fields(","), ElementsAre("", ""));
}

TEST(Csv, WhatAFieldIsWrittenAsReadsBackTheSame) {
  for (const std::string text : {"plain", "with, comma", "\"quoted\"", ",\"", "lane:1/0/-1@3.5"}) {
    EXPECT_THAT(csv_fields("x," + map::csv_field(text) + ",y"), ElementsAre("x", text, "y"));
  }
}

TEST(Csv, GoesThroughRowsOverEmptyLinesByteOrderMarkAndCarriageReturns) {
  CsvReader table("\xef\xbb\xbf\"t_s\",x\r\n\r\n1,2\r\n \n3,+4.5", "a.csv");
  const std::size_t t = table.column("t_s", "t_s,x"), x = table.column("x", "t_s,x");
  ASSERT_TRUE(table.next_row());
  EXPECT_EQ(table.line(), 3u);
  EXPECT_EQ(table.number(t, 0, 9), 1.0);
  ASSERT_TRUE(table.next_row());
  EXPECT_EQ(table.line(), 5u);
  EXPECT_EQ(table.number(x, 0, 9), 4.5);
  EXPECT_FALSE(table.next_row());
}

TEST(Csv, NumbersHaveToBeWholeFieldsWithinTheirBounds) {
  CsvReader table("x\n4\n-1\n10\nnan\n1x\n\"\"\n", "a.csv");
  ASSERT_TRUE(table.next_row());
  EXPECT_EQ(table.number(0, 0, 9), 4.0);
  int refused = 0;
  while (table.next_row()) {
    EXPECT_THROW(table.number(0, 0, 9), map::InputError) << table.line();
    ++refused;
  }
  EXPECT_EQ(refused, 5);
}

TEST(Csv, SaysWhichColumnIsMissingOrTwiceAndWhichRowIsTooShort) {
  CsvReader table("x,y,y\n1,2\n", "a.csv");
  EXPECT_THROW(table.find_column("y"), map::InputError);
  EXPECT_EQ(table.find_column("z"), std::nullopt);
  EXPECT_THROW(table.column("z", "x,z"), map::InputError);
  ASSERT_TRUE(table.next_row());
  EXPECT_THROW(table.check_width(), map::InputError);
}

}  // namespace
}  // namespace roadbed::tools
