#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/geometry/curves/spline_curve.h"
#include "roadbed/planning/reference/reference_line.h"
#include "roadbed/tools/cli/arguments.h"

namespace roadbed::tools::inline commands::inline routes {

/// The options of `reference --waypoints`, and the line that they ask for: smoothed within a
/// tolerance (the line that is planned along), or the cubic spline through the points themselves
/// [paper eq. 1–5].
class WayPointLine {
 public:
  void declare(Arguments& arguments);

  bool asked() const { return !file_.empty(); }

  /// Who is to drive along the line, if that is said.
  /// @throws InputError if the file cannot be read.
  std::optional<geometry::VehicleShape> vehicle() const;

  /// What is wrong with the options together; empty if nothing is.
  std::string fault() const;

  struct Table {
    std::string csv;  ///< columns as those of a line along a route
    double length_m = 0.0;
    double peak_curvature_per_m = 0.0;
    double largest_move_m = 0.0;     ///< of a way-point
    std::vector<std::string> notes;  ///< on corners that cannot be driven as asked
  };

  /// @throws InputError if the file cannot be read, or its points make no line.
  Table table(double step_m, double max_move_m) const;

 private:
  enum class Ends { natural, clamped, periodic };

  // Points and what a table says of them, by arc length.
  struct Line {
    double length_m, largest_move_m;
    std::vector<std::string> notes;
    std::function<planning::ReferencePoint(double)> at;
  };
  static Line spline_line(const geometry::SplineCurve& curve);
  static Line smooth_line(const planning::ReferenceLine& line);

  std::vector<Eigen::Vector2d> way_points() const;
  planning::ReferenceLine smoothed(const std::vector<Eigen::Vector2d>& points,
                                   double max_move_m) const;
  geometry::SplineCurve interpolated(const std::vector<Eigen::Vector2d>& points) const;
  Table rows_of(const Line& made, double step_m) const;

  std::filesystem::path file_, vehicle_file_;
  bool interpolate_ = false;
  Ends ends_ = Ends::natural;
  std::vector<double> headings_deg_;
  double half_width_m_ = 1.75;
  double speed_limit_kmh_ = 50.0;
};

}  // namespace roadbed::tools::commands::routes
