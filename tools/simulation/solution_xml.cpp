#include "roadbed/tools/simulation/drive.h"

#include <fmt/format.h>

#include <cmath>

#include "roadbed/map/files/xml_characters.h"

namespace roadbed::tools::inline simulation {
namespace {

std::string state_xml(const geometry::TrajectoryPoint& row, long step, double ahead_m) {
  const Eigen::Vector2d centre = row.pose() * Eigen::Vector2d(ahead_m, 0.0);
  return fmt::format(
      "    <ksState>\n      <x>{}</x>\n      <y>{}</y>\n"
      "      <steeringAngle>{}</steeringAngle>\n      <velocity>{}</velocity>\n"
      "      <orientation>{}</orientation>\n      <time>{}</time>\n    </ksState>\n",
      centre.x(), centre.y(), row.steering_rad, row.speed_mps, row.heading_rad, step);
}

}  // namespace

std::string solution_xml(const CommonRoadDrive& problem, const Drive& drive) {
  const geometry::VehicleShape& vehicle = problem.scenario.vehicle;
  const double ahead_m = 0.5 * vehicle.length_m - vehicle.rear_overhang_m;
  const double step_s = problem.world.goal->step_s;
  std::string xml = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<CommonRoadSolution benchmark_id=\"KS2:SM1:{}:{}\">\n"
      "  <ksTrajectory planningProblem=\"{}\">\n",
      map::xml_text(problem.benchmark_id), map::xml_text(problem.version),
      map::xml_text(problem.problem_id));
  // Who is hit within a time step is so at its end.
  const double end = drive.trajectory.end_s() / step_s;
  const auto steps = static_cast<long>(
      drive.verdict.outcome == Outcome::collision ? std::ceil(end - 1e-6) : std::floor(end + 1e-6));
  for (long k = 0; k <= steps; ++k) {
    const auto row = drive.trajectory.at(step_s * static_cast<double>(k));
    xml += state_xml(row, problem.start_step + k, ahead_m);
  }
  return xml + "  </ksTrajectory>\n</CommonRoadSolution>\n";
}

}  // namespace roadbed::tools::simulation
