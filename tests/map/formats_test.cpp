#include "roadbed/map/formats.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/load_map.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::map {
namespace {

std::string_view name_of(const std::string& bytes) {
  const Format* format = format_of(bytes);
  return format == nullptr ? "none" : format->name;
}

TEST(Formats, AreToldByContent) {
  EXPECT_EQ(name_of("<OpenDRIVE/>"), "OpenDRIVE");
  EXPECT_EQ(name_of("<o:OpenDRIVE xmlns:o='http://x'/>"), "OpenDRIVE");
  EXPECT_EQ(name_of("<?xml version='1.0'?>\n<!-- <osm> --> <commonRoad a='1'/>"), "CommonRoad");
  EXPECT_EQ(name_of("<osm>"), "Lanelet2");
  EXPECT_EQ(name_of(" {}"), "GeoJSON");
  EXPECT_EQ(name_of("<gpx/>"), "none");
  EXPECT_EQ(name_of("OpenDRIVE"), "none");
  EXPECT_EQ(name_of(""), "none");
}

TEST(Formats, NamesAndSuffixesAreTheirOwn) {
  std::set<std::string_view> names, suffixes;
  for (const Format& format : formats()) {
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    EXPECT_EQ(format.suffix.empty(), !format.is_written()) << format.name;
    EXPECT_EQ(format.sniff == nullptr, format.read == nullptr) << format.name;
    EXPECT_EQ(format.judge == nullptr, format.rules == nullptr) << format.name;
    if (!format.is_written()) continue;
    EXPECT_TRUE(suffixes.insert(format.suffix).second) << format.name;
  }
}

TEST(Formats, AMapKnowsTheOneThatItWasReadFrom) {
  for (const auto& entry : std::filesystem::directory_iterator(tests::data_folder())) {
    if (entry.path().extension() != ".xodr") continue;
    EXPECT_EQ(format_of(load_map(entry.path())), format_of(entry.path()));
  }
}

TEST(Formats, SavedMapsAreReadAgain) {
  const RoadMap town = load_map(tests::data_folder() / "town.xodr");
  const auto file = std::filesystem::path(::testing::TempDir()) / "saved_town.xml";
  save_map(town, file);
  EXPECT_EQ(format_of(file)->name, "CommonRoad");
  EXPECT_GT(load_map(file).lanes().size(), 0u);
  std::filesystem::remove(file);
  EXPECT_THROW(save_map(town, "town.docx"), InputError);
  EXPECT_THROW(save_map(town, "/no/such/folder/town.xml"), OutputError);
}

}  // namespace
}  // namespace roadbed::map
