#include "roadbed/map/gis/geo_tiff.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "roadbed/tests/support/number_at.h"

namespace roadbed::map {
namespace {

using testing::ElementsAre;
using tests::number_at;

/// The fields of a TIFF file's first directory, each as its numbers, or a text as its bytes.
std::map<int, std::vector<double>> tiff_fields(const std::string& file) {
  EXPECT_EQ(file.substr(0, 4), std::string("II*\0", 4));
  std::map<int, std::vector<double>> fields;
  const auto directory = number_at<std::uint32_t>(file, 4);
  int last = 0;
  for (std::size_t i = 0; i < number_at<std::uint16_t>(file, directory); ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    const int tag = number_at<std::uint16_t>(file, entry),
              type = number_at<std::uint16_t>(file, entry + 2);
    const auto count = number_at<std::uint32_t>(file, entry + 4);
    EXPECT_GT(tag, last) << "fields stand in order";
    last = tag;
    const std::size_t size = type == 2 ? 1 : type == 3 ? 2 : type == 4 ? 4 : 8;
    const std::size_t from =
        size * count <= 4 ? entry + 8 : number_at<std::uint32_t>(file, entry + 8);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t place = from + size * k;
      fields[tag].push_back(type == 2   ? static_cast<double>(file[place])
                            : type == 3 ? number_at<std::uint16_t>(file, place)
                            : type == 4 ? number_at<std::uint32_t>(file, place)
                                        : number_at<double>(file, place));
    }
  }
  return fields;
}

/// The numbers of all bands, row by row from the north, band after band.
std::vector<float> numbers_of(const std::string& file) {
  const auto fields = tiff_fields(file);
  std::string all;
  for (std::size_t i = 0; i < fields.at(273).size(); ++i) {
    std::string strip(1 << 20, '\0');
    uLongf size = strip.size();
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(strip.data()), &size,
                         reinterpret_cast<const Bytef*>(
                             file.data() + static_cast<std::size_t>(fields.at(273)[i])),
                         static_cast<uLong>(fields.at(279)[i])),
              Z_OK);
    all += strip.substr(0, size);
  }
  std::vector<float> numbers(all.size() / sizeof(float));
  std::memcpy(numbers.data(), all.data(), all.size());
  return numbers;
}

Raster random_raster(std::size_t columns, std::size_t rows, std::size_t bands) {
  std::mt19937 random(20261126);
  std::uniform_real_distribution<float> value(-5.0f, 5.0f);
  Raster raster{
      .cell_m = 0.5, .corner = {1000.0, 2000.0}, .columns = columns, .rows = rows, .bands = {}};
  for (std::size_t band = 0; band < bands; ++band) {
    raster.bands.push_back({"band_" + std::to_string(band), {}});
    for (std::size_t i = 0; i < columns * rows; ++i)
      raster.bands[band].values.push_back(value(random));
  }
  return raster;
}

TEST(GeoTiff, HoldsTheNumbersWithTheNorthFirst) {
  for (const auto& [columns, rows] :
       {std::pair<std::size_t, std::size_t>{3, 2}, {700, 501}, {1, 1}}) {
    const Raster raster = random_raster(columns, rows, 3);
    const std::vector<float> found = numbers_of(write_geotiff(raster, {}));
    ASSERT_EQ(found.size(), 3 * columns * rows);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const std::size_t band = i / (columns * rows), row = i / columns % rows;
      EXPECT_EQ(found[i], raster.bands[band].values[(rows - 1 - row) * columns + i % columns]);
    }
  }
}

TEST(GeoTiff, SaysWhereItLiesAndInWhichSystem) {
  const auto fields = tiff_fields(write_geotiff(random_raster(3, 2, 1), 25832));
  EXPECT_THAT(fields.at(256), ElementsAre(3));
  EXPECT_THAT(fields.at(257), ElementsAre(2));
  EXPECT_THAT(fields.at(33550), ElementsAre(0.5, 0.5, 0.0));
  EXPECT_THAT(fields.at(33922), ElementsAre(0, 0, 0, 1000.0, 2001.0, 0));  // the north-west corner
  EXPECT_THAT(fields.at(34735), ElementsAre(1, 1, 1, 3, 1024, 0, 1, 1, 1025, 0, 1, 1,  //
                                            3072, 0, 1, 25832));
  const auto unknown = tiff_fields(write_geotiff(random_raster(3, 2, 1), {}));
  EXPECT_THAT(unknown.at(34735), ElementsAre(1, 1, 1, 1, 1025, 0, 1, 1));
}

TEST(GeoTiff, RefusesARasterWithoutSquaresOrWithABandOfAnotherSize) {
  EXPECT_THROW(write_geotiff(random_raster(0, 3, 1), {}), std::invalid_argument);
  EXPECT_THROW(write_geotiff(random_raster(2, 2, 0), {}), std::invalid_argument);
  Raster raster = random_raster(2, 2, 2);
  raster.bands[1].values.pop_back();
  EXPECT_THROW(write_geotiff(raster, {}), std::invalid_argument);
}

}  // namespace
}  // namespace roadbed::map
