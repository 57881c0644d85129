#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>

namespace roadbed::tests {

using Vector2l = Eigen::Matrix<long double, 2, 1>;
using Vector3l = Eigen::Matrix<long double, 3, 1>;

/// A second, slow reading of an OpenDRIVE file: straight from the XML, in long double, by
/// numerical integration of the heading. Shares no code with the program.
class OpenDriveOracle {
 public:
  explicit OpenDriveOracle(const std::string& file);

  /// The same from the file's text.
  static OpenDriveOracle of_text(const std::string& text);

  OpenDriveOracle(OpenDriveOracle&&) noexcept;
  ~OpenDriveOracle();

  /// Inner and outer border of a lane at road station `s_m`, in the file's coordinates; the
  /// records in force just beside s on the side of `inside_s_m` are taken.
  std::pair<Vector2l, Vector2l> borders(const std::string& road, int section, int lane,
                                        long double s_m, long double inside_s_m) const;

  /// The same with heights: elevation, superelevation, lateral shape, cross section surface,
  /// crossfall by side and level lanes. Lane heights (<height>) are not in it.
  std::pair<Vector3l, Vector3l> borders_with_height(const std::string& road, int section, int lane,
                                                    long double s_m, long double inside_s_m) const;

 private:
  OpenDriveOracle();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbed::tests
