#include "roadbed/map/repair/text_edits.h"

#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <stdexcept>
#include <string>

namespace roadbed::map {
namespace {

const std::string kText =
    "<?xml version='1.0'?>\n"
    "<map>\n"
    "  <!-- <lane> > -->\n"
    "  <lane id = '1' name=\"a > b\">\n"
    "    <point/><![CDATA[</lane>]]>\n"
    "    <lane id=\"2\"/>\n"
    "  </lane>\n"
    "</map>\n";

XmlElementText first_lane() { return {kText, kText.find("lane id")}; }
XmlElementText second_lane() { return {kText, kText.find("lane id=\"2\"")}; }

std::string made(const TextEdit& edit) { return edited(kText, {edit}); }

/// The text without the one part, with the other in its place.
std::string with(const std::string& from, const std::string& to) {
  std::string text = kText;
  return text.replace(text.find(from), from.size(), to);
}

TEST(TextEdits, AreMadeInTheirOrderAndLeaveTheRest) {
  EXPECT_EQ(edited("abcdef", {{4, 1, "E"}, {0, 1, ""}, {2, 0, "x"}, {2, 0, "y"}}), "bxycdEf");
  EXPECT_THROW(edited("abcdef", {{0, 3, ""}, {2, 1, ""}}), std::invalid_argument);
  EXPECT_TRUE(overlap({0, 3, ""}, {2, 1, ""}));
  EXPECT_FALSE(overlap({0, 2, ""}, {2, 1, ""}));
  EXPECT_FALSE(overlap({2, 0, "a"}, {2, 0, "b"}));
}

TEST(XmlElementText, IsFromItsStartTagToItsEndTag) {
  const std::string whole(first_lane().whole());
  EXPECT_TRUE(whole.starts_with("<lane id = '1'"));
  EXPECT_TRUE(whole.ends_with("/>\n  </lane>"));
  EXPECT_EQ(second_lane().whole(), "<lane id=\"2\"/>");
}

TEST(XmlElementText, GetsAttributesChildrenAndSiblings) {
  EXPECT_EQ(made(first_lane().with_attribute("id", "7")), with("'1'", "'7'"));
  EXPECT_EQ(made(first_lane().with_attribute("type", "x")), with("b\">", "b\" type=\"x\">"));
  EXPECT_EQ(made(second_lane().with_attribute("type", "x")), with("\"2\"/", "\"2\" type=\"x\"/"));
  EXPECT_EQ(made(first_lane().with_last_child("<c/>")),
            with("<lane id=\"2\"/>", "<lane id=\"2\"/>\n      <c/>"));
  EXPECT_EQ(made(second_lane().with_last_child("<c/>")),
            with("<lane id=\"2\"/>", "<lane id=\"2\">\n        <c/>\n    </lane>"));
  EXPECT_EQ(made(second_lane().with_sibling_before("<c/>")),
            with("<lane id=\"2\"", "<c/>\n    <lane id=\"2\""));
  EXPECT_EQ(made(second_lane().with_sibling_behind("<c/>")),
            with("<lane id=\"2\"/>", "<lane id=\"2\"/>\n    <c/>"));
  EXPECT_EQ(made(second_lane().without()), with("\n    <lane id=\"2\"/>", ""));
}

TEST(XmlElementText, StaysXml) {
  for (const XmlElementText& lane : {first_lane(), second_lane()}) {
    for (const TextEdit& edit :
         {lane.with_attribute("id", "7"), lane.with_attribute("new", "7"),
          lane.with_last_child("<c/>"), lane.with_sibling_before("<c/>"),
          lane.with_sibling_behind("<c/>"), lane.without(), lane.replaced_by("<c/>")}) {
      pugi::xml_document document;
      EXPECT_TRUE(document.load_string(made(edit).c_str())) << made(edit);
    }
  }
}

}  // namespace
}  // namespace roadbed::map
