#include "roadbed/map/files/csv_field.h"

#include <gtest/gtest.h>

namespace roadbed::map {
namespace {

TEST(CsvField, NumbersAndPlacesStayAsTheyAre) {
  for (const char* text : {"-12", "+4.5", "-1e-3", "-12.5,7", "-1,-2,-3.14", "lane:1/0/-1@3.5"}) {
    const std::string field = csv_field(text);
    EXPECT_EQ(field.find('\''), std::string::npos) << text;
  }
  EXPECT_EQ(csv_field("-12.5,7"), "\"-12.5,7\"");
}

TEST(CsvField, WhatASpreadsheetWouldComputeIsText) {
  EXPECT_EQ(csv_field("=1+1"), "'=1+1");
  EXPECT_EQ(csv_field("-2+3"), "'-2+3");
  EXPECT_EQ(csv_field("+1+1"), "'+1+1");
  EXPECT_EQ(csv_field("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(csv_field("-"), "'-");
  EXPECT_EQ(csv_field(" =1"), "' =1");
  EXPECT_EQ(csv_field("\t=1"), "' =1");
  EXPECT_EQ(csv_field("=cmd|'/c calc'!A1,\"x\""), "\"'=cmd|'/c calc'!A1,\"\"x\"\"\"");
}

TEST(CsvField, IsOneLineOfVisibleText) {
  EXPECT_EQ(csv_field("a\r\nb\x1b[31m\xc2\x9b\xe2\x80\xae"), "a  b\\u001b[31m\\u009b\\u202e");
}

}  // namespace
}  // namespace roadbed::map
