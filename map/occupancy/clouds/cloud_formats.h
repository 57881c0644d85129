#pragma once

// Private to map/occupancy: what the readers of the single formats share.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "roadbed/map/occupancy/clouds/cloud_filter.h"
#include "roadbed/map/occupancy/clouds/point_cloud.h"

namespace roadbed::map::inline occupancy::inline clouds {

/// Points as a file holds them, before the local origin is chosen.
struct RawCloud {
  static constexpr double kBeyondEarth = 1e9;  // no coordinate of any Earth frame

  std::vector<Eigen::Vector3d> points_in_source;
  /// Instead of these, where the file holds floats.
  std::vector<Eigen::Vector3f> float_points_in_source = {};
  std::size_t dropped_not_finite = 0;
  std::size_t filtered_out = 0;
  std::string format;
  std::string crs;
  LengthUnit unit = LengthUnit::unknown;
  std::optional<Eigen::Vector3d> sensor_in_source;
  std::vector<ScanStart> scans = {};  ///< of the points that were kept
  bool is_around_sensor = false;      ///< as `PointCloud` says it
  std::size_t without_sensor = 0;     ///< points whose sensor position is not finite
  std::vector<std::string> notes;

  bool empty() const { return points_in_source.empty() && float_points_in_source.empty(); }

  /// Keeps the point, or counts it where a coordinate is not finite or beyond any Earth frame.
  void add(const Eigen::Vector3d& point);

  /// The same for a point that was measured from `sensor`, finite or not.
  void add(const Eigen::Vector3d& point, const Eigen::Vector3d& sensor);
};

/// Records of one size that hold x, y and z as floats in the order of this machine's bytes.
struct FloatRecords {
  const char* first;
  std::size_t count, size;                   ///< records, and bytes of each
  std::size_t x_offset, y_offset, z_offset;  ///< bytes before them in a record
};

/// Takes the points of records into a cloud, as `RawCloud::add` does one by one, but some thousands
/// at a time: copied, then judged all together.
void add_float_points(const FloatRecords& records, RawCloud& cloud);

/// The local origin that `PointCloud` names, for points in a box.
Eigen::Vector3d local_origin(const Box3& box);

/// The cloud of what a file holds, with the local origin that `PointCloud` names; its own name is
/// not set.
PointCloud relative_to_origin(RawCloud raw);

/// Places of three fields in a point.
using FieldColumns = std::array<std::size_t, 3>;

/// Which fields have these names; none if one of them is missing.
std::optional<FieldColumns> columns_named(const std::vector<std::string>& fields,
                                          const std::array<std::string_view, 3>& names);

/// Which fields say where a point was measured from, by the names that are in use: sensor_x, vp_x
/// (PCL), x_origin (Paris-Lille-3D), BeamOriginX (PDAL). Adds a note where some of three are
/// missing.
/// @param fields  lower-case names.
std::optional<FieldColumns> sensor_columns(const std::vector<std::string>& fields,
                                           std::vector<std::string>& notes);

/// @throws InputError, all of them: place is a line number or "byte N", element may be empty.
[[noreturn]] void refuse_cloud(const std::string& file, const std::string& place,
                               const std::string& element, const std::string& found,
                               const std::string& needed, const std::string& remedy);

// One file each: read_NAME.cpp.
RawCloud parse_pcd(std::string_view bytes, const std::string& name, const CloudFilter& filter);
RawCloud parse_ply(std::string_view bytes, const std::string& name, const CloudFilter& filter);
RawCloud parse_las(std::string_view bytes, const std::string& name, const CloudFilter& filter);
RawCloud parse_xyz(std::string_view bytes, const std::string& name, const CloudFilter& filter);
RawCloud parse_kitti(std::string_view bytes, const std::string& name, const CloudFilter& filter);

/// Whether the first line that is no comment begins with three numbers, or names x, y and z.
bool begins_as_xyz(std::string_view bytes);

/// A scalar of a binary record.
enum class ScalarType { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };
std::size_t size_of(ScalarType type);

/// The scalar at `bytes`, which must hold it.
double read_scalar(const char* bytes, ScalarType type, bool big_endian = false);

/// Little-endian unsigned integer of `size` ≤ 8 bytes at `offset`.
/// @throws std::out_of_range if the bytes end before it.
std::uint64_t read_unsigned(std::string_view bytes, std::size_t offset, std::size_t size);

/// Takes lines and words off a text.
class TextScanner {
 public:
  explicit TextScanner(std::string_view text) : rest_(text) {}

  bool done() const { return rest_.empty(); }
  std::size_t line_number() const { return line_; }  ///< of the line last taken, from 1
  std::string_view rest() const { return rest_; }    ///< what follows it
  std::string_view next_line();                      ///< without its end

 private:
  std::string_view rest_;
  std::size_t line_ = 0;
};

/// Takes the next word, up to space, tab or carriage return, off a line; empty at its end.
std::string_view next_word(std::string_view& line);

/// A word as a number; "nan", "inf" and what overflows a double count as not finite. None if the
/// word is not a number.
std::optional<double> parse_number(std::string_view word);

/// A word as a whole number without sign; none if it is not one or does not fit.
std::optional<std::uint64_t> parse_count(std::string_view word);

/// Lower-case letters for capitals of ASCII.
std::string lower(std::string_view text);

}  // namespace roadbed::map::occupancy::clouds
