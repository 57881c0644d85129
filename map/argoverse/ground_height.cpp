#include "roadbed/map/argoverse/ground_height.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "roadbed/map/files/files_named.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/parse_json.h"
#include "roadbed/map/files/read_file.h"

namespace roadbed::map::argoverse {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

[[noreturn]] void refuse(const std::string& file, const std::string& found,
                         const std::string& needed) {
  throw InputError({.file = file,
                    .found = found,
                    .needed = needed,
                    .remedy = "get the file again, or move it away from the map"});
}

/// The only file of a folder whose name holds and ends with these; none if there are more.
std::optional<fs::path> only_file(const fs::path& folder, std::string_view part,
                                  std::string_view end) {
  const std::vector<fs::path> files = files_named(folder, part, end);
  return files.size() == 1 ? std::optional(files.front()) : std::nullopt;
}

std::vector<double> numbers(const std::string& file, const Json& root, const char* key,
                            std::size_t count) {
  std::vector<double> found;
  const Json& value = root.is_object() && root.contains(key) ? root[key] : root;
  for (const Json& number : value.is_array() ? value : Json::array({value})) {
    if (number.is_number()) found.push_back(number.get<double>());
  }
  if (found.size() != count) {
    refuse(file, fmt::format("\"{}\" is not {} numbers", key, count),
           "R of 4 numbers, t of 2, and s");
  }
  return found;
}

/// The text between two others in the header of a raster.
std::string_view field(std::string_view header, std::string_view key, std::string_view end) {
  const std::size_t at = header.find(key);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = header.substr(at + key.size());
  return rest.substr(0, rest.find(end));
}

/// The whole numbers of "123, 45".
std::vector<std::size_t> counts(std::string_view text) {
  std::vector<std::size_t> found;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    std::size_t number = 0;
    const auto [after, fault] = std::from_chars(at, end, number);
    if (fault == std::errc()) found.push_back(number);
    at = fault == std::errc() ? after : at + 1;
  }
  return found;
}

template <typename Number>
double number_at(const char* bytes) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), bytes, raw.size());
  return static_cast<double>(Eigen::numext::bit_cast<Number>(raw));
}

}  // namespace

std::optional<GroundHeight> GroundHeight::beside(const fs::path& map_file) {
  std::error_code error;
  if (!fs::is_regular_file(map_file, error)) return {};
  const fs::path folder = map_file.has_parent_path() ? map_file.parent_path() : fs::path(".");
  const auto raster = only_file(folder, "_ground_height_surface____", ".npy");
  const auto transform = only_file(folder, "___img_Sim2_city", ".json");
  if (!raster || !transform) return {};
  GroundHeight ground = parse({input_name(*transform), read_file(*transform)},
                              {input_name(*raster), read_file(*raster)});
  ground.file_ = raster->filename().string();
  return ground;
}

GroundHeight GroundHeight::parse(const File& transform, File raster) {
  GroundHeight ground;
  ground.read_transform(transform);
  ground.read_raster(std::move(raster));
  return ground;
}

void GroundHeight::read_transform(const File& file) {
  try {
    const Json root = parse_json(file.bytes, file.name);
    const std::vector<double> rotation = numbers(file.name, root, "R", 4);
    rotation_ << rotation[0], rotation[1], rotation[2], rotation[3];
    const std::vector<double> translation = numbers(file.name, root, "t", 2);
    translation_ = {translation[0], translation[1]};
    scale_ = numbers(file.name, root, "s", 1).front();
  } catch (const Json::exception& thrown) {
    refuse_json(thrown, file.name);
  }
}

void GroundHeight::read_raster(File file) {
  constexpr std::string_view magic = "\x93NUMPY";
  file_ = std::move(file.name);
  bytes_ = std::move(file.bytes);
  const bool is_short = bytes_.size() < 12 || !bytes_.starts_with(magic);
  const auto byte = [&](std::size_t i) {
    return std::size_t{static_cast<unsigned char>(bytes_[i])};
  };
  const bool is_first = !is_short && byte(6) == 1;  // the size of the header has two bytes
  if (is_short) refuse(file_, "no raster of NumPy", "a .npy file");
  const std::size_t header_begin = is_first ? 10 : 12;
  std::size_t size = byte(8) | byte(9) << 8U;
  if (!is_first) size |= byte(10) << 16U | byte(11) << 24U;
  begin_ = header_begin + size;
  const std::string_view header = std::string_view(bytes_).substr(header_begin, size);
  const std::string_view type = field(header, "'descr': '<f", "'");
  if (type == "2" || type == "4" || type == "8") bytes_per_cell_ = counts(type).front();
  const auto shape = counts(field(header, "'shape': (", ")"));
  const bool is_in_rows = field(header, "'fortran_order': ", ",") == "False";
  if (bytes_per_cell_ == 0 || shape.size() != 2 || !is_in_rows) {
    refuse(file_, "no raster of two dimensions", "float16, float32 or float64 in rows");
  }
  rows_ = shape[0];
  columns_ = shape[1];
  const std::size_t cells = (bytes_.size() - std::min(begin_, bytes_.size())) / bytes_per_cell_;
  if (columns_ == 0 || rows_ > cells / columns_) {
    refuse(file_, fmt::format("{} cells", cells), fmt::format("{} × {}", rows_, columns_));
  }
}

std::optional<double> GroundHeight::at_m(const Eigen::Vector2d& in_city) const {
  const Eigen::Vector2d cell = scale_ * (rotation_ * in_city + translation_);
  const bool is_inside = cell.x() >= 0.0 && cell.y() >= 0.0 &&
                         cell.x() < static_cast<double>(columns_) &&
                         cell.y() < static_cast<double>(rows_);
  if (!is_inside) return {};
  const auto index =
      static_cast<std::size_t>(cell.y()) * columns_ + static_cast<std::size_t>(cell.x());
  const char* at = bytes_.data() + begin_ + index * bytes_per_cell_;
  const double height_m = bytes_per_cell_ == 2   ? number_at<Eigen::half>(at)
                          : bytes_per_cell_ == 4 ? number_at<float>(at)
                                                 : number_at<double>(at);
  if (!std::isfinite(height_m)) return {};
  return height_m;
}

}  // namespace roadbed::map::argoverse
