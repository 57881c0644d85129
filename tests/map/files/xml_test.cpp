#include "roadbed/map/files/xml.h"

#include <gtest/gtest.h>

namespace roadbed::map {
namespace {

TEST(XmlDocument, ElementsHaveTheirLine) {
  const XmlDocument document("<a>\n<b/>\n\n<c/></a>", "f.xml");
  EXPECT_EQ(document.line_of(document.root()), 1);
  EXPECT_EQ(document.line_of(document.root().child("b")), 2);
  EXPECT_EQ(document.line_of(document.root().child("c")), 4);
}

TEST(XmlDocument, PrefixOfTheRootIsTakenOffAllNamesThatAreMore) {
  const XmlDocument document("<o:a>\n<o:b/>\n<o:/><p:c/></o:a>", "f.xml");
  EXPECT_STREQ(document.root().name(), "a");
  EXPECT_EQ(document.line_of(document.root().child("b")), 2);
  EXPECT_EQ(document.line_of(document.root().child("o:")), 3);
  EXPECT_EQ(document.line_of(document.root().child("p:c")), 3);
}

}  // namespace
}  // namespace roadbed::map
