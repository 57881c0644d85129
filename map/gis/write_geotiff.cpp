#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <new>
#include <stdexcept>
#include <utility>

#include "roadbed/map/gis/geo_tiff.h"

namespace roadbed::map::inline gis {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class FieldType : std::uint16_t { text = 2, two_bytes = 3, four_bytes = 4, real = 12 };

template <typename Number>
std::string bytes_of(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

template <typename Number>
void append(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// The fields of a TIFF file's one directory, by their tags.
class Directory {
 public:
  void add(int tag, std::vector<std::uint16_t> values) {
    put(tag, FieldType::two_bytes, values.size(), bytes_of(values));
  }
  void add(int tag, std::vector<std::uint32_t> values) {
    put(tag, FieldType::four_bytes, values.size(), bytes_of(values));
  }
  void add(int tag, std::vector<double> values) {
    put(tag, FieldType::real, values.size(), bytes_of(values));
  }
  void add(int tag, std::string text) {
    text += '\0';
    const std::size_t count = text.size();
    put(tag, FieldType::text, count, std::move(text));
  }

  /// What it takes, with the values that stand behind it.
  std::uint32_t size() const { return static_cast<std::uint32_t>(bytes(0).size()); }

  /// @param at  its place in the file, for those values.
  std::string bytes(std::uint32_t at) const {
    std::string entries, values;
    const std::size_t behind = at + sizeof(std::uint16_t) + 12 * fields_.size() + 4;
    append(entries, static_cast<std::uint16_t>(fields_.size()));
    for (const auto& [tag, field] : fields_) {
      append(entries, static_cast<std::uint16_t>(tag));
      append(entries, static_cast<std::uint16_t>(field.type));
      append(entries, field.count);
      std::string value = field.bytes;
      value.resize((value.size() + 3) / 4 * 4);
      if (value.size() == 4) {
        entries += value;
        continue;
      }
      append(entries, static_cast<std::uint32_t>(behind + values.size()));
      values += value;
    }
    append(entries, std::uint32_t{0});  // there is no other directory
    return entries + values;
  }

 private:
  struct Field {
    FieldType type;
    std::uint32_t count;
    std::string bytes;
  };
  void put(int tag, FieldType type, std::size_t count, std::string bytes) {
    fields_[tag] = {type, static_cast<std::uint32_t>(count), std::move(bytes)};
  }

  std::map<int, Field> fields_;  // readers expect them in this order
};

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                Z_DEFAULT_COMPRESSION) != Z_OK) {
    throw std::bad_alloc();  // the only fault that zlib can have here
  }
  packed.resize(size);
  return packed;
}

/// Packed strips of whole rows, from the north, band after band.
struct Strips {
  std::uint32_t rows_each;
  std::vector<std::string> packed;
};

Strips strips_of(const Raster& raster) {
  constexpr std::size_t kBytes = 1 << 18;
  const std::size_t row_bytes = sizeof(float) * raster.columns;
  const std::size_t rows_each = std::clamp<std::size_t>(kBytes / row_bytes, 1, raster.rows);
  Strips strips{static_cast<std::uint32_t>(rows_each), {}};
  for (const RasterBand& band : raster.bands) {
    for (std::size_t first = 0; first < raster.rows; first += rows_each) {
      std::string bytes;
      for (std::size_t row = first; row < std::min(first + rows_each, raster.rows); ++row) {
        const float* values = &band.values[(raster.rows - 1 - row) * raster.columns];
        bytes.append(reinterpret_cast<const char*>(values), row_bytes);
      }
      strips.packed.push_back(deflated(bytes));
    }
  }
  return strips;
}

void add_picture(Directory& directory, const Raster& raster) {
  const std::size_t bands = raster.bands.size();
  const auto each = [&](std::uint16_t value) { return std::vector<std::uint16_t>(bands, value); };
  constexpr std::uint16_t deflate = 8, dark_is_low = 1, band_after_band = 2, floats = 3;
  directory.add(256, std::vector{static_cast<std::uint32_t>(raster.columns)});
  directory.add(257, std::vector{static_cast<std::uint32_t>(raster.rows)});
  directory.add(258, each(32));  // bits
  directory.add(259, std::vector{deflate});
  directory.add(262, std::vector{dark_is_low});
  directory.add(277, std::vector{static_cast<std::uint16_t>(bands)});
  directory.add(284, std::vector{band_after_band});
  if (bands > 1) directory.add(338, std::vector<std::uint16_t>(bands - 1, 0));  // no colours
  directory.add(339, each(floats));
}

void add_names(Directory& directory, const Raster& raster) {
  std::string items;
  for (std::size_t i = 0; i < raster.bands.size(); ++i) {
    items += fmt::format("<Item name=\"DESCRIPTION\" sample=\"{}\" role=\"description\">{}</Item>",
                         i, raster.bands[i].name);
  }
  directory.add(42112, "<GDALMetadata>" + items + "</GDALMetadata>");
  directory.add(42113, std::string("nan"));
}

// Keys are in the order of their numbers.
void add_system(Directory& directory, const std::optional<int>& epsg) {
  constexpr std::uint16_t model = 1024, projected = 1, raster = 1025, squares = 1, system = 3072;
  std::vector<std::uint16_t> keys;
  const auto add_key = [&](std::uint16_t key, std::uint16_t value) {
    keys.insert(keys.end(), {key, 0, 1, value});
  };
  if (epsg) add_key(model, projected);
  add_key(raster, squares);
  if (epsg) add_key(system, static_cast<std::uint16_t>(*epsg));
  std::vector<std::uint16_t> all{1, 1, 1, static_cast<std::uint16_t>(keys.size() / 4)};
  all.insert(all.end(), keys.begin(), keys.end());
  directory.add(34735, std::move(all));
}

void add_place(Directory& directory, const Raster& raster) {
  const double north = raster.corner.y() + raster.cell_m * static_cast<double>(raster.rows);
  directory.add(33550, std::vector{raster.cell_m, raster.cell_m, 0.0});
  directory.add(33922, std::vector{0.0, 0.0, 0.0, raster.corner.x(), north, 0.0});
}

void check(const Raster& raster) {
  const std::size_t squares = raster.columns * raster.rows;
  constexpr std::size_t most_bytes = 4'000'000'000;
  const bool fit = std::ranges::all_of(
      raster.bands, [&](const RasterBand& band) { return band.values.size() == squares; });
  if (squares > 0 && !raster.bands.empty() && fit &&
      squares * raster.bands.size() * sizeof(float) <= most_bytes) {
    return;
  }
  throw std::invalid_argument(fmt::format("write_geotiff: {} bands of {} by {} squares",
                                          raster.bands.size(), raster.columns, raster.rows));
}

}  // namespace

std::string write_geotiff(const Raster& raster, const std::optional<int>& epsg) {
  check(raster);
  const Strips strips = strips_of(raster);
  Directory directory;
  add_picture(directory, raster);
  add_names(directory, raster);
  add_place(directory, raster);
  add_system(directory, epsg);
  directory.add(278, std::vector{strips.rows_each});
  std::vector<std::uint32_t> places(strips.packed.size()), sizes;
  for (const std::string& strip : strips.packed) {
    sizes.push_back(static_cast<std::uint32_t>(strip.size()));
  }
  directory.add(279, sizes);
  directory.add(273, places);  // as many as there will be, so that the size is known
  constexpr std::uint32_t head = 8;
  std::uint32_t place = head + directory.size();
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = place;
    place += sizes[i];
  }
  directory.add(273, places);
  std::string file = "II";
  append(file, std::uint16_t{42});
  append(file, head);
  file += directory.bytes(head);
  for (const std::string& strip : strips.packed) file += strip;
  return file;
}

}  // namespace roadbed::map::gis
