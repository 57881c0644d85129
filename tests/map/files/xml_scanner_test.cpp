#include "roadbed/map/files/xml_scanner.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/files/xml_characters.h"
#include "roadbed/tests/support/refusal_of.h"

namespace roadbed::map {
namespace {

using testing::HasSubstr;
using tests::refusal_of;

const char* const kDocument = R"(<?xml version="1.0"?>
<!-- <a> is no element --><!DOCTYPE osm [<!ENTITY e "]>"> <!-- ' --> ]>
<osm a='1' b = "&lt;&#228;&#x1F600;&unknown;&amp;amp;">
  text &lt; <![CDATA[<b c="d">]]> <?php <x> ?>
  <tag k="x
y"	v='"'/><way><nd ref="7"/><nd ref="8"></nd></way >
  <e.f_g-h:i j=""/></osm>
)";

void read_all(const std::string& text) {
  XmlScanner scanner(text, "f.osm");
  while (scanner.next() != XmlScanner::Event::done) {
  }
  scanner.expect_end();
}

// Elements with their depth, name and the values of given attributes.
using Elements = std::vector<std::string>;

void walk(pugi::xml_node node, int depth, Elements& elements,
          std::vector<std::vector<std::string>>& attributes) {
  std::string line = fmt::format("{} {}", depth, node.name());
  attributes.emplace_back();
  for (const pugi::xml_attribute attribute : node.attributes()) {
    attributes.back().emplace_back(attribute.name());
    line += fmt::format(" [{}]", one_line(node.attribute(attribute.name()).value()));
  }
  elements.push_back(line);
  for (const pugi::xml_node child : node.children()) {
    if (child.type() == pugi::node_element) walk(child, depth + 1, elements, attributes);
  }
}

Elements scanned(const std::string& text, const std::vector<std::vector<std::string>>& attributes) {
  XmlScanner scanner(text, "f.osm");
  Elements elements;
  for (auto event = scanner.next(); event != XmlScanner::Event::done; event = scanner.next()) {
    if (event != XmlScanner::Event::start) continue;
    std::string line = fmt::format("{} {}", scanner.depth(), scanner.name());
    if (elements.size() < attributes.size()) {
      for (const std::string& name : attributes[elements.size()]) {
        line += fmt::format(" [{}]", scanner.value(name));
      }
    }
    elements.push_back(line);
  }
  return elements;
}

TEST(XmlScanner, ReadsTheElementsThatPugixmlReads) {
  std::mt19937 random(20261121);
  const std::string pieces = "<>/=\"'&;! \n\t\rab:]-?#x1[";
  int both = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::string text = kDocument;
    for (int change = round == 0 ? 0 : 1 + round % 3; change > 0; --change) {
      text[random() % text.size()] = pieces[random() % pieces.size()];
    }
    pugi::xml_document document;
    if (!document.load_buffer(text.data(), text.size())) continue;
    if (refusal_of([&] { read_all(text); }) != "accepted") continue;
    Elements expected;
    std::vector<std::vector<std::string>> attributes;
    walk(document.document_element(), 1, expected, attributes);
    ASSERT_EQ(scanned(text, attributes), expected) << text;
    ++both;
  }
  EXPECT_GT(both, 5'000);
}

TEST(XmlScanner, SaysWhereAndWhyATextIsNotWellFormed) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"", "f.osm:1: not well-formed XML (no element)"},
      {"<!-- only -->\n", "f.osm:2: not well-formed XML (no element)"},
      {"<a>\n<b>", "f.osm:2: not well-formed XML (it ends inside <b>)"},
      {"<a>\n</b>", "f.osm:2: not well-formed XML (</b> closes what <a> began)"},
      {"</a>", "</a> closes what <> began"},
      {"<a b>", "attribute b has no value"},
      {"<a b=1/>", "has no quotes"},
      {"<a b=\"1/>", "does not end"},
      {"<a b=\"1\"c=\"2\"/>", "unexpected character"},
      {"<a b=\"1\"", "ends inside a tag"},
      {"<", "ends inside a tag"},
      {"< a/>", "a name is missing"},
      {"<a/><b/>", "another element follows the first"},
      {"<a><!-- </a>", "a comment does not end"},
      {"<a><![CDATA[ </a>", "a CDATA section does not end"},
      {"<?xml", "a processing instruction does not end"},
      {"<!DOCTYPE a [<a>", "the document type does not end"},
      {"<a><!DOCTYPE b></a>", "a tag begins with <!"}};
  for (const auto& [text, reason] : bad) {
    EXPECT_THAT(refusal_of([&text = text] { read_all(text); }), HasSubstr(reason)) << text;
  }
}

TEST(XmlScanner, BoundsWhatATextCanMakeItRemember) {
  std::string deep, wide = "<a";
  for (int i = 0; i < 2'000; ++i) deep += "<a>";
  for (int i = 0; i < 20'000; ++i) wide += " b=''";
  EXPECT_THAT(refusal_of([&] { read_all(deep); }), HasSubstr("nested deeper than 1,000"));
  EXPECT_THAT(refusal_of([&] { read_all(wide + "/>"); }), HasSubstr("more than 10,000 attributes"));
}

TEST(XmlScanner, ReadsOneElementAlone) {
  const std::string text = "<a><b c='1'><d/></b><e/></a>";
  XmlScanner scanner(text, "f.osm", text.find("<b"));
  std::string names;
  while (scanner.next() != XmlScanner::Event::done) names += scanner.name();
  EXPECT_EQ(names, "bddb");
}

// All stretches, if they are whole; "" else.
std::string in_stretches(const std::string& text, const std::vector<std::size_t>& cuts) {
  std::string elements;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    XmlScanner scanner(text, "f.osm",
                       XmlScanner::Stretch{cuts[i], cuts[i + 1], i == 0 ? "" : "osm"});
    auto event = scanner.next();
    for (; event != XmlScanner::Event::done && scanner.depth() > 0; event = scanner.next()) {
      if (event == XmlScanner::Event::start) {
        elements += fmt::format("{} {}\n", scanner.depth(), scanner.name());
      }
    }
    const bool is_last = i + 2 == cuts.size();
    if (is_last != (scanner.depth() == 0)) return "";
    if (is_last) scanner.expect_end();
  }
  return elements;
}

TEST(XmlScanner, StretchesThatAreAllWholeHoldWhatTheTextHolds) {
  std::mt19937 random(20261129);
  const std::vector<std::string> parts{"<a/>", "<b c='<'>", "</b>", "<!-- ",  " -->",  "<![CDATA[",
                                       "]]>",  "<d>",       "</d>", "</osm>", "<osm>", "text"};
  int whole = 0;
  for (int round = 0; round < 200'000; ++round) {
    std::string text = "<osm>";
    const std::size_t count = 2 + random() % 8;
    for (std::size_t i = 0; i < count; ++i) text += parts[random() % parts.size()];
    text += "</osm>";
    std::vector<std::size_t> cuts{0};
    for (int i = 0; i < 2; ++i) {
      const std::size_t at = text.find('<', cuts.back() + 1 + random() % 20);
      if (at != text.npos) cuts.push_back(at);
    }
    cuts.push_back(text.size());
    std::string found;
    if (refusal_of([&] { found = in_stretches(text, cuts); }) != "accepted" || found.empty())
      continue;
    std::string one;
    ASSERT_EQ(refusal_of([&] { one = in_stretches(text, {0, text.size()}); }), "accepted") << text;
    ASSERT_EQ(found, one) << text;
    if (cuts.size() > 2) ++whole;
  }
  EXPECT_GT(whole, 1'000);
}

TEST(XmlScanner, SkipGoesPastTheElementThatStarted) {
  const std::string text = "<a><b><c/><d></d></b><e/></a>";
  XmlScanner scanner(text, "f.osm");
  scanner.next();
  scanner.next();
  EXPECT_EQ(scanner.name(), "b");
  scanner.skip();
  scanner.next();
  EXPECT_EQ(scanner.name(), "e");
  EXPECT_EQ(scanner.depth(), 2u);
}

TEST(XmlScanner, NamesTheRootElementWhereThereIsOne) {
  EXPECT_EQ(root_element("\xef\xbb\xbf<?xml version='1.0'?><!-- --><osm></wrong>"), "osm");
  EXPECT_EQ(root_element("{\"type\": 1}"), "");
  EXPECT_EQ(root_element("<a b"), "a");
  EXPECT_EQ(root_element("<!-- <a> "), "");
}

TEST(XmlCharacters, OtherEncodingsBecomeUtf8OnTheSameLines) {
  const std::string latin = "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n\n<a b=\"\xe4\"/>";
  ASSERT_TRUE(is_other_encoding(latin));
  const std::string text = in_utf8(latin);
  XmlScanner scanner(text, "f.osm");
  scanner.next();
  EXPECT_EQ(scanner.value("b"), "ä");
  EXPECT_THAT(text, HasSubstr("encoding=\"UTF-8\""));
  std::string wide;
  for (const char c : std::string("<a b=\"1\"/>")) wide += {c, '\0'};
  EXPECT_TRUE(is_other_encoding(wide));
  EXPECT_THAT(in_utf8(wide), HasSubstr("<a b=\"1\""));
  EXPECT_FALSE(is_other_encoding("<?xml version='1.0' encoding='UTF-8'?><a/>"));
}

}  // namespace
}  // namespace roadbed::map
