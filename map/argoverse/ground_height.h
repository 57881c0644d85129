#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace roadbed::map::argoverse {

/// The height of the ground on a grid of cells, as Argoverse 2 has it beside the maps of its sensor
/// logs: `*_ground_height_surface____*.npy`, floating-point numbers of NumPy's format in rows, and
/// `*___img_Sim2_city.json`, which says where they are:
///
///     (column, row) = s (R p + t)     of the city's point p
class GroundHeight {
 public:
  /// The one in the folder of a map file; none if there are not just these two files.
  /// @throws InputError if one of them is unusable.
  static std::optional<GroundHeight> beside(const std::filesystem::path& map_file);

  /// A file's name and bytes.
  struct File {
    std::string name, bytes;
  };
  /// That of these two.
  /// @throws InputError if one of them is unusable.
  static GroundHeight parse(const File& transform, File raster);

  /// That of the cell around a point [m]; none where there is no cell, or it has none.
  std::optional<double> at_m(const Eigen::Vector2d& in_city) const;

  const std::string& file() const { return file_; }  ///< name of the raster

 private:
  void read_transform(const File& file);
  void read_raster(File file);

  std::string file_, bytes_;
  std::size_t begin_ = 0, bytes_per_cell_ = 0, rows_ = 0, columns_ = 0;
  Eigen::Matrix2d rotation_;
  Eigen::Vector2d translation_;
  double scale_ = 1.0;
};

}  // namespace roadbed::map::argoverse
