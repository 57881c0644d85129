// LAS 1.0 to 1.4: ASPRS, "LAS Specification 1.4 - R15", 2019. GeoTIFF keys: OGC 19-008r4. LAZ is
// the same with its points packed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "roadbed/map/files/wkt_units.h"
#include "roadbed/map/occupancy/clouds/attribute_filter.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"
#include "roadbed/map/occupancy/laz/laz_points.h"

namespace roadbed::map::inline occupancy::inline clouds {
namespace {

// Least bytes of a record of point data format 0 … 10.
constexpr std::array<std::size_t, 11> kRecordBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

// Offsets in the public header block.
namespace at {
constexpr std::size_t minor_version = 25, header_size = 94, points = 96, records = 100,
                      format = 104, record_length = 105, legacy_count = 107, scale = 131,
                      offset = 155, count = 247;
}  // namespace at

constexpr std::size_t kLeastHeader = 227, kHeader14 = 375, kRecordHeader = 54;
constexpr std::uint64_t kPackedFlag = 0x80, kOldPackedFlag = 0x40;
// Packed points take more than half a byte each; of fewer, memory is no concern.
constexpr std::uint64_t kMostPointsPerByte = 2, kFewPoints = 5'000'000;

struct GeoKeys {
  unsigned projected_crs = 0, geographic_crs = 0, linear_unit = 0;
  std::string citation, wkt;
};

class LasParser {
 public:
  LasParser(std::string_view bytes, const std::string& name, const CloudFilter& filter)
      : bytes_(bytes), name_(name), asked_(filter) {}

  RawCloud parse() {
    check_header();
    read_variable_records();
    name_crs();
    read_scale();
    filter_ = AttributeFilter(
        asked_, {"intensity", "classification", "return_number", "number_of_returns"}, name_);
    is_packed_ ? read_packed_points() : read_plain_points();
    return std::move(cloud_);
  }

 private:
  [[noreturn]] void refuse(std::size_t byte, const std::string& element, const std::string& found,
                           const std::string& needed, const std::string& remedy) const {
    refuse_cloud(name_, fmt::format("byte {}", byte), element, found, needed, remedy);
  }

  std::uint64_t number(std::size_t offset, std::size_t size) const {
    return read_unsigned(bytes_, offset, size);
  }

  double real(std::size_t offset) const {
    return read_scalar(bytes_.data() + offset, ScalarType::f64);
  }

  void check_header() {
    if (bytes_.size() < kLeastHeader || !bytes_.starts_with("LASF")) {
      refuse(0, "header", "is cut or does not begin with LASF",
             fmt::format("{} bytes", kLeastHeader), "get the whole file");
    }
    const auto major = number(at::minor_version - 1, 1), minor = number(at::minor_version, 1);
    if (major != 1 || minor > 4) {
      refuse(at::minor_version - 1, "version", fmt::format("{}.{}", major, minor), "1.0 to 1.4",
             "convert the file");
    }
    if (minor == 4 && bytes_.size() < kHeader14) {
      refuse(0, "header", fmt::format("{} bytes", bytes_.size()),
             fmt::format("{} in LAS 1.4", kHeader14), "get the whole file");
    }
    cloud_.format = fmt::format("LAS {}.{}", major, minor);
    check_records();
    check_count(minor);
  }

  void check_records() {
    const auto flags = number(at::format, 1);
    is_packed_ = (flags & kPackedFlag) != 0;
    if ((flags & kOldPackedFlag) != 0) {
      refuse(at::format, "points", "are packed by a trial version of LASzip", "LAS or LAZ",
             "unpack the file with the program that made it");
    }
    const auto format = flags & ~kPackedFlag;
    record_length_ = number(at::record_length, 2);
    if (format >= kRecordBytes.size() || record_length_ < kRecordBytes[format]) {
      refuse(at::format, "point data format",
             fmt::format("{} with records of {} bytes", format, record_length_),
             "format 0 to 10 with its record length", "check that the file is whole");
    }
  }

  void check_count(std::uint64_t minor) {
    count_ = number(at::legacy_count, 4);
    if (minor == 4 && count_ == 0) count_ = number(at::count, 8);
    body_offset_ = number(at::points, 4);
    if (body_offset_ < kLeastHeader || body_offset_ > bytes_.size()) {
      refuse(at::points, "offset to the points", fmt::format("{}", body_offset_),
             fmt::format("{} to {}", kLeastHeader, bytes_.size()), "get the whole file");
    }
    const std::size_t body = bytes_.size() - body_offset_;
    const std::size_t fit =
        is_packed_ ? kFewPoints + kMostPointsPerByte * body : body / record_length_;
    if (count_ > fit) {
      refuse(at::legacy_count, "number of points",
             is_packed_ ? fmt::format("{} in {} bytes", count_, body)
                        : fmt::format("{}, but the file ends after {}", count_, fit),
             is_packed_ ? fmt::format("at most {}", fit) : "all of them", "get the whole file");
    }
  }

  void read_variable_records() {
    std::size_t offset = number(at::header_size, 2);
    const auto records = number(at::records, 4);
    for (std::uint64_t i = 0; i < records; ++i) {
      if (offset > body_offset_ || body_offset_ - offset < kRecordHeader) return note_cut_records();
      const std::size_t length = number(offset + 20, 2), begin = offset + kRecordHeader;
      if (length > body_offset_ - begin) return note_cut_records();
      if (bytes_.substr(offset + 2, 15) == "LASF_Projection") {
        read_projection(number(offset + 18, 2), bytes_.substr(begin, length));
      } else if (is_packed_ && bytes_.substr(offset + 2, 14) == "laszip encoded") {
        layout_ = parse_laz_layout(bytes_.substr(begin, length), name_);
      }
      offset = begin + length;
    }
  }

  void note_cut_records() {
    cloud_.notes.emplace_back("a variable length record is cut; the rest of them are ignored");
  }

  void read_projection(std::uint64_t record, std::string_view body) {
    if (record == 34735) {
      read_geo_keys(body);
    } else if (record == 34737) {
      geo_.citation = body.substr(0, body.find_first_of(std::string_view("|\0", 2)));
    } else if (record == 2112) {
      geo_.wkt = body.substr(0, body.find('\0'));
    }
  }

  // Rows of four: key, where its value is (0: here), count, value; the first row is a header.
  void read_geo_keys(std::string_view body) {
    for (std::size_t row = 8; row + 8 <= body.size(); row += 8) {
      if (read_unsigned(body, row + 2, 2) != 0) continue;
      const auto value = static_cast<unsigned>(read_unsigned(body, row + 6, 2));
      switch (read_unsigned(body, row, 2)) {
        case 2048:
          geo_.geographic_crs = value;
          break;
        case 3072:
          geo_.projected_crs = value;
          break;
        case 3076:
          geo_.linear_unit = value;
          break;
        default:
          break;
      }
    }
  }

  void name_crs() {
    constexpr unsigned user_defined = 32767;
    const CrsUnits units = units_of_wkt(geo_.wkt);
    const bool projected = geo_.projected_crs != 0 || units.horizontal_m.has_value();
    const unsigned code = projected ? geo_.projected_crs : geo_.geographic_crs;
    if (code != 0 && code != user_defined) {
      cloud_.crs = fmt::format("EPSG:{}", code);
    } else {
      cloud_.crs = geo_.wkt.empty() ? geo_.citation : geo_.wkt;
    }
    if (geo_.linear_unit == 9001) cloud_.unit = LengthUnit::metre;
    if (geo_.linear_unit == 9002) cloud_.unit = LengthUnit::foot;
    if (geo_.linear_unit == 9003) cloud_.unit = LengthUnit::us_survey_foot;
    const bool geographic = geo_.geographic_crs != 0 || units.is_in_degrees;
    if (!projected && geographic) cloud_.unit = LengthUnit::degree;
    if (units.horizontal_m) cloud_.unit = unit_of(*units.horizontal_m);
    if (units.vertical_m && units.horizontal_m && *units.vertical_m != *units.horizontal_m) {
      cloud_.notes.push_back(fmt::format(
          "heights are in {}, x and y in {}; all count as the latter",
          to_string(unit_of(*units.vertical_m)), to_string(unit_of(*units.horizontal_m))));
    }
  }

  static LengthUnit unit_of(double metres) {
    constexpr double same = 1e-8;  // feet differ by 6e-7
    if (std::abs(metres - 1.0) < same) return LengthUnit::metre;
    if (std::abs(metres - 0.3048) < same) return LengthUnit::foot;
    if (std::abs(metres - 1200.0 / 3937.0) < same) return LengthUnit::us_survey_foot;
    return LengthUnit::unknown;
  }

  void read_scale() {
    scale_ = {real(at::scale), real(at::scale + 8), real(at::scale + 16)};
    offset_ = {real(at::offset), real(at::offset + 8), real(at::offset + 16)};
    if (!scale_.allFinite() || !offset_.allFinite() || (scale_.array() == 0.0).any()) {
      refuse(at::scale, "scale and offset", "a value is 0 or not finite", "finite scales, not 0",
             "save the cloud again");
    }
  }

  void add(const LazPoint& point) {
    const std::array<unsigned, 4> values{point.intensity, point.classification, point.return_number,
                                         point.returns};
    if (!filter_.keeps([&](std::size_t i) { return static_cast<double>(values[i]); })) {
      ++cloud_.filtered_out;
      return;
    }
    const Eigen::Vector3d at(point.steps[0], point.steps[1], point.steps[2]);
    cloud_.add(at.cwiseProduct(scale_) + offset_);
  }

  // A record of any of the formats, of which two have bits in other places.
  LazPoint point_at(std::string_view record) const {
    LazPoint point{.steps = steps_at(record), .intensity = integer_at<std::uint16_t>(record, 12)};
    const auto returns = static_cast<unsigned char>(record[14]);
    const bool is_new = (number(at::format, 1) & ~kPackedFlag) >= 6;
    point.return_number = returns & (is_new ? 15u : 7u);
    point.returns = static_cast<std::uint8_t>(returns >> (is_new ? 4 : 3) & (is_new ? 15u : 7u));
    point.classification =
        is_new ? static_cast<std::uint8_t>(record[16])
               : static_cast<std::uint8_t>(static_cast<unsigned char>(record[15]) & 31u);
    return point;
  }

  void read_plain_points() {
    cloud_.points_in_source.reserve(count_);
    for (std::uint64_t i = 0; i < count_; ++i) {
      add(point_at(bytes_.substr(body_offset_ + i * record_length_, record_length_)));
    }
  }

  void read_packed_points() {
    if (!layout_ || layout_->point_bytes() != record_length_) {
      refuse(at::record_length, "packed points",
             layout_ ? fmt::format("of {} bytes in records of {}", layout_->point_bytes(),
                                   record_length_)
                     : "without a record \"laszip encoded\"",
             "how they are packed", "get the whole file");
    }
    cloud_.format += ", packed (LAZ)";
    // No more than the file can pay for: the count is its own word.
    cloud_.points_in_source.reserve(std::min<std::uint64_t>(count_, bytes_.size()));
    unpack_laz(bytes_, body_offset_, count_, *layout_, !filter_.keeps_all(), name_,
               [&](std::span<const LazPoint> some) {
                 for (const LazPoint& point : some) add(point);
               });
  }

  std::string_view bytes_;
  const std::string& name_;
  const CloudFilter& asked_;
  AttributeFilter filter_;
  std::size_t record_length_ = 0;
  std::size_t body_offset_ = 0;
  std::uint64_t count_ = 0;
  bool is_packed_ = false;
  std::optional<LazLayout> layout_;  // of packed points
  Eigen::Vector3d scale_{0, 0, 0}, offset_{0, 0, 0};
  GeoKeys geo_;
  RawCloud cloud_;
};

}  // namespace

RawCloud parse_las(std::string_view bytes, const std::string& name, const CloudFilter& filter) {
  return LasParser(bytes, name, filter).parse();
}

}  // namespace roadbed::map::occupancy::clouds
