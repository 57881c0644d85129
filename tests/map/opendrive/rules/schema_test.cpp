// What the schema of a file's revision asks for: files with every element and attribute of 1.4 to
// 1.8, and what is found where they are broken. That ASAM's own schemas find the same was measured
// for each of the attributes.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <string_view>

#include "roadbed/map/opendrive/rules/source.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/slips.h"

namespace roadbed::map::opendrive::rules {
namespace {

std::string file_with_everything(int minor) {
  return tests::bytes_of(tests::tests_folder() /
                         fmt::format("map/opendrive/rules/schema/every_1_{}.xodr", minor));
}

/// "invalid-value <offset> hdg="east" is no finite number; correct it", a line each.
std::string told(const std::string& text) {
  const XmlDocument xml(text, "made.xodr");
  std::string all;
  for (const SchemaFault& fault : find_schema_faults(xml)) {
    const char* names[] = {"missing-element", "missing-attribute", "not-a-number",
                           "unknown-value",   "incomplete",        "invalid-value"};
    all += fmt::format("{}{} <{}> {}", all.empty() ? "" : "\n", names[static_cast<int>(fault.kind)],
                       fault.node.name(), fault.message);
  }
  return all;
}

/// The file with each attribute, but for its revision, set to one value; without them for none.
std::string with_all_attributes(const std::string& text, const char* value) {
  pugi::xml_document document;
  document.load_string(text.c_str());
  struct Setter : pugi::xml_tree_walker {
    const char* value = nullptr;
    bool for_each(pugi::xml_node& node) override {
      for (auto attribute = node.first_attribute(); attribute;) {
        const auto next = attribute.next_attribute();
        if (!std::string_view(attribute.name()).starts_with("rev")) {
          value ? static_cast<void>(attribute.set_value(value))
                : static_cast<void>(node.remove_attribute(attribute));
        }
        attribute = next;
      }
      return true;
    }
  } setter;
  setter.value = value;
  document.traverse(setter);
  std::ostringstream out;
  document.save(out);
  return out.str();
}

class OpenDriveSchema : public ::testing::TestWithParam<int> {};

TEST_P(OpenDriveSchema, FindsNothingInAFileWithEveryElementAndAttribute) {
  EXPECT_EQ(told(file_with_everything(GetParam())), "");
}

INSTANTIATE_TEST_SUITE_P(Revisions, OpenDriveSchema, ::testing::Values(4, 5, 6, 7, 8));

struct Count {
  int minor;
  const char* value;  ///< none: the attributes are not there
  std::size_t faults;
};

// ASAM's schemas find as many, but for a few things: a file of 1.4 may leave out every attribute,
// its speed limits are whole numbers, lengths and contact points are any text in 1.6, s and t of a
// signal may be missing in 1.8; and what unit a speed has is a rule of its own here.
constexpr Count kCounts[] = {
    {4, nullptr, 115}, {4, "banana", 303}, {4, "", 306},      {4, "-1", 60},
    {4, "0.5", 86},    {4, "0", 59},       {5, nullptr, 407}, {5, "banana", 448},
    {5, "", 451},      {5, "-1", 248},     {5, "0.5", 140},   {5, "0", 104},
    {6, nullptr, 348}, {6, "banana", 425}, {6, "", 429},      {6, "-1", 225},
    {6, "0.5", 139},   {6, "0", 104},      {7, nullptr, 348}, {7, "banana", 447},
    {7, "", 451},      {7, "-1", 266},     {7, "0.5", 144},   {7, "0", 132},
    {8, nullptr, 427}, {8, "banana", 685}, {8, "", 688},      {8, "-1", 373},
    {8, "0.5", 241},   {8, "0", 214},
};

TEST(OpenDriveSchemas, FindEveryAttributeThatMayNotHaveAValue) {
  for (const Count& count : kCounts) {
    const std::string text = with_all_attributes(file_with_everything(count.minor), count.value);
    const XmlDocument xml(text, "made.xodr");
    EXPECT_EQ(find_schema_faults(xml).size(), count.faults)
        << "1." << count.minor << ' ' << (count.value ? count.value : "without");
  }
}

struct Broken {
  int minor;
  std::string from, to, told;
};

std::ostream& operator<<(std::ostream& out, const Broken& broken) { return out << broken.to; }

const Broken kBroken[] = {
    {4, R"(<lane id="2" type="none")", R"(<lane id="2" type="curb")",
     R"(unknown-value <lane> type="curb" is no value of revision 1.4; correct it)"},
    {7, R"(<offset hdg="1")", R"(<offset hdg="east")",
     R"(invalid-value <offset> hdg="east" is no finite number; correct it)"},
    {4, R"( north="1")", R"( north="far")",
     R"(invalid-value <header> north="far" is no finite number; correct it)"},
    {5, R"( version="1.00")", R"( version="1.0")",
     R"(unknown-value <header> version="1.0" is no value of the standard; correct it)"},
    {5, R"(<bridge s="1")", R"(<bridge)",
     R"(incomplete <bridge> has no attribute s, which revision 1.5 asks for; add it)"},
    {5, R"(validLength="1" )", R"()",
     R"(incomplete <object> has no attribute validLength, which revision 1.5 asks for; add it)"},
    {6, R"(color="standard" )", R"()",
     R"(incomplete <roadMark> has no attribute color, which revision 1.6 asks for; add it)"},
    {6, R"(color="standard")", R"(color="violet")",
     R"(unknown-value <roadMark> color="violet" is no value of revision 1.6; correct it)"},
    {7, R"( junction="-1")", R"()",
     R"(incomplete <road> has no attribute junction, which revision 1.7 asks for; add it)"},
    {7, R"(<arc curvature="1"/>)", R"(<arc curvature="x"/>)",
     R"(not-a-number <arc> curvature="x" is no finite number; correct it)"},
    {7, R"(country="OpenDRIVE")", R"(country="Deutschland")",
     R"(unknown-value <type> country="Deutschland" is no value of the standard; correct it)"},
    {7, R"(country="OpenDRIVE")", R"(country="DE")", R"()"},
    {7, R"(dynamic="yes")", R"(dynamic="false")",
     R"(unknown-value <object> dynamic="false" is no value of the standard; correct it)"},
    {7, R"(lighting="1")", R"(lighting="1.2")",
     R"(invalid-value <tunnel> lighting="1.2" is not between 0 and 1; correct it)"},
    {7, R"(sequence="1")", R"(sequence="-1")",
     R"(invalid-value <controller> sequence="-1" is less than 0; correct it)"},
    {7, R"(id="-1")", R"(id="1")", R"(invalid-value <lane> id="1" is not less than 0; correct it)"},
    {7, R"(<control )", R"(<kontrol )",
     R"(incomplete <controller> has no <control>, which revision 1.7 asks for; add one)"},
    {7, R"(mode="global")", R"(mode="attached")",
     R"(unknown-value <CRG> mode="attached" is no value of revision 1.7; correct it)"},
    {8, R"(type="direct")", R"(type="common")",
     R"(unknown-value <junction> type="common" is no value of revision 1.8; correct it)"},
    {8, R"(overlapZone="1")", R"(overlapZone="0")",
     R"(invalid-value <laneLink> overlapZone="0" is not greater than 0; correct it)"},
    {8, R"(mode="independent")", R"(mode="alone")",
     R"(unknown-value <strip> mode="alone" is no value of the standard; correct it)"},
    {8, R"(<geometry hdg="1" length="1")", R"(<geometry hdg="1" length="0")",
     R"(invalid-value <geometry> length="0" is not greater than 0; correct it)"},
    {8, R"(displayType="LED")", R"(displayType="paper")",
     R"(unknown-value <vmsBoard> displayType="paper" is no value of the standard; correct it)"},
    {8, R"(orientation="+")", R"(orientation="left")",
     R"(unknown-value <object> orientation="left" is no value of the standard; correct it)"},
    {8, R"(max="1" sOffset="1" unit="m/s")", R"(max="1" sOffset="1" unit="")",
     R"(invalid-value <speed> unit="" is empty; correct it)"},
};

class OpenDriveSchemaFaults : public ::testing::TestWithParam<Broken> {};

TEST_P(OpenDriveSchemaFaults, AreToldAsWhatTheyAre) {
  const Broken& broken = GetParam();
  const std::string text = file_with_everything(broken.minor);
  EXPECT_EQ(told(tests::with_slip(text, {"", broken.from, broken.to})), broken.told);
}

INSTANTIATE_TEST_SUITE_P(Table, OpenDriveSchemaFaults, ::testing::ValuesIn(kBroken));

// A revision that has no schema here is another rule's business.
TEST(OpenDriveSchemas, AskFilesOfOtherRevisionsOnlyForWhatTheProgramNeeds) {
  for (const char* revision : {"0", "3", "9", "none"}) {
    const std::string text = tests::with_slip(
        file_with_everything(8), {"", R"(revMinor="8")", fmt::format("revMinor=\"{}\"", revision)});
    EXPECT_EQ(told(text), "");
    EXPECT_EQ(told(tests::with_slip(text, {"", R"(<offset hdg="1")", R"(<offset hdg="east")"})),
              "");
    EXPECT_EQ(told(tests::with_slip(text, {"", R"(<arc curvature="1"/>)", "<arc/>"})),
              "missing-attribute <arc> has no attribute curvature; add it");
    EXPECT_EQ(told(tests::with_slip(text, {"", R"(rule="RHT")", R"(rule="right")"})),
              R"(unknown-value <road> rule="right" is no value of the standard; correct it)");
  }
}

TEST(OpenDriveSchemas, LeaveForeignElementsAndAttributesAlone) {
  const std::string text = tests::with_slip(
      file_with_everything(7),
      {"", "<planView>",
       R"(<fence s="x"><lane id="x"/></fence><userData><lane/></userData><planView by="me">)"});
  EXPECT_EQ(told(text), "");
}

TEST(OpenDriveSchemas, LetNoMapFailForWhatTheProgramDoesWithout) {
  for (const SourceRule& rule : schema_rules()) {
    const bool is_lenient = rule.info.id == "schema.incomplete" ||
                            rule.info.id == "schema.invalid-value" ||
                            rule.info.id == "schema.unknown-value";
    EXPECT_EQ(rule.info.severity == validation::Severity::warning, is_lenient) << rule.info.id;
  }
}

}  // namespace
}  // namespace roadbed::map::opendrive::rules
