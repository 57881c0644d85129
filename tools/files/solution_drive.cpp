#include <cctype>
#include <cmath>

#include "roadbed/map/files/xml.h"
#include "roadbed/tools/files/drive_formats.h"
#include "roadbed/tools/files/vehicle_file.h"

namespace roadbed::tools::inline files {
namespace {

/// Point-mass states have two speeds and no orientation; commonroad-io calls them xVelocity and
/// yVelocity. At rest they keep the heading that they had before.
DrivePose state_of(const map::XmlDocument& xml, pugi::xml_node state, double step_s,
                   double heading_before_rad) {
  DrivePose pose{.t_s = step_s * xml.text_number(state, "time"),
                 .x_m = xml.text_number(state, "x"),
                 .y_m = xml.text_number(state, "y"),
                 .heading_rad = heading_before_rad};
  if (state.child("orientation")) {
    pose.heading_rad = xml.text_number(state, "orientation");
    if (state.child("velocity")) pose.speed_mps = xml.text_number(state, "velocity");
    return pose;
  }
  const bool is_plain = state.child("velocity");
  const double along_x_mps = xml.text_number(state, is_plain ? "velocity" : "xVelocity");
  const double along_y_mps = xml.text_number(state, is_plain ? "velocityY" : "yVelocity");
  pose.speed_mps = std::hypot(along_x_mps, along_y_mps);
  if (*pose.speed_mps > 0.0) pose.heading_rad = std::atan2(along_y_mps, along_x_mps);
  return pose;
}

/// "KS2:SM1:…": the vehicle 2 of CommonRoad's.
geometry::VehicleShape vehicle_of(const map::XmlDocument& xml) {
  const std::string id = xml.text(xml.root(), "benchmark_id");
  const std::size_t digit = id.find_first_of("0123456789:");
  if (digit == std::string::npos || std::isdigit(static_cast<unsigned char>(id[digit])) == 0) {
    xml.refuse(xml.root(), "benchmark_id \"" + id + "\" names no vehicle", "as in KS2:SM1:…",
               "write the solution anew");
  }
  return read_vehicle_shape("commonroad:" + id.substr(digit, 1));
}

}  // namespace

bool begins_as_solution(std::string_view bytes) {
  return bytes.substr(0, 4096).find("<CommonRoadSolution") != std::string_view::npos;
}

DrivePoses parse_solution(std::string_view bytes, const std::string& name,
                          const DriveOptions& options) {
  const double step_s = needed_step_s(options, name, "a CommonRoad solution");
  const map::XmlDocument xml{std::string(bytes), name};
  DrivePoses read{.unit = "line", .pose_in_vehicle = pose_frame("centre", vehicle_of(xml))};
  pugi::xml_node driven;
  for (const pugi::xml_node trajectory : xml.root().children()) {
    if (!std::string_view(trajectory.name()).ends_with("Trajectory")) continue;
    if (driven) {
      xml.refuse(trajectory, "is a second trajectory", "one", "write each to a file of its own");
    }
    driven = trajectory;
  }
  for (const pugi::xml_node state : driven.children()) {
    if (!std::string_view(state.name()).ends_with("State")) continue;
    const double before_rad = read.poses.empty() ? 0.0 : read.poses.back().heading_rad;
    read.poses.push_back(state_of(xml, state, step_s, before_rad));
    read.places.push_back(static_cast<std::size_t>(xml.line_of(state)));
  }
  return read;
}

}  // namespace roadbed::tools::files
