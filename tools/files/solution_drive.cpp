#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/xml.h"
#include "roadbed/tools/files/drive_file.h"
#include "roadbed/tools/files/drive_formats.h"
#include "roadbed/tools/files/vehicle_file.h"

namespace roadbed::tools::inline files {
namespace {

/// What a state says but for its heading, and that where it says one: point-mass states have two
/// speeds, which commonroad-io calls xVelocity and yVelocity, and no direction at rest.
struct SolutionState {
  DrivePose pose;
  std::optional<double> heading_rad = {};
};

SolutionState state_of(const map::XmlDocument& xml, pugi::xml_node state, double step_s) {
  SolutionState read{.pose = {.t_s = step_s * xml.text_number(state, "time"),
                              .x_m = xml.text_number(state, "x"),
                              .y_m = xml.text_number(state, "y"),
                              .heading_rad = 0.0}};
  if (state.child("orientation")) {
    read.heading_rad = xml.text_number(state, "orientation");
    if (state.child("velocity")) read.pose.speed_mps = xml.text_number(state, "velocity");
    return read;
  }
  const bool is_plain = state.child("velocity");
  const double along_x_mps = xml.text_number(state, is_plain ? "velocity" : "xVelocity");
  const double along_y_mps = xml.text_number(state, is_plain ? "velocityY" : "yVelocity");
  read.pose.speed_mps = std::hypot(along_x_mps, along_y_mps);
  if (*read.pose.speed_mps > 0.0) read.heading_rad = std::atan2(along_y_mps, along_x_mps);
  return read;
}

bool has_heading(const SolutionState& state) { return state.heading_rad.has_value(); }

/// Who rests heads where it did before; before it first moves, where it will.
/// @pre a state has a heading.
std::vector<DrivePose> with_held_headings(const std::vector<SolutionState>& states) {
  const auto first = std::ranges::find_if(states, has_heading);
  double held_rad = *first->heading_rad;
  std::vector<DrivePose> poses;
  for (const SolutionState& state : states) {
    held_rad = state.heading_rad.value_or(held_rad);
    poses.push_back(state.pose);
    poses.back().heading_rad = held_rad;
  }
  return poses;
}

/// "KS2:SM1:…": the vehicle 2 of CommonRoad's.
std::string vehicle_of(const map::XmlDocument& xml) {
  const std::string id = xml.text(xml.root(), "benchmark_id");
  const std::size_t digit = id.find_first_of("0123456789:");
  if (digit == std::string::npos || std::isdigit(static_cast<unsigned char>(id[digit])) == 0) {
    xml.refuse(xml.root(), "benchmark_id \"" + id + "\" names no vehicle", "as in KS2:SM1:…",
               "write the solution anew");
  }
  return "commonroad:" + id.substr(digit, 1);
}

}  // namespace

bool begins_as_solution(std::string_view bytes) {
  return bytes.substr(0, 4096).find("<CommonRoadSolution") != std::string_view::npos;
}

std::string vehicle_of_solution(const std::filesystem::path& file) {
  return vehicle_of(map::XmlDocument(map::read_file(file), map::input_name(file)));
}

DrivePoses parse_solution(std::string_view bytes, const std::string& name,
                          const DriveOptions& options) {
  const double step_s = needed_step_s(options, name, "a CommonRoad solution");
  const map::XmlDocument xml{std::string(bytes), name};
  DrivePoses read{.unit = "line",
                  .pose_in_vehicle =
                      pose_frame("centre", read_vehicle_shape(vehicle_of(xml)))->pose_in_vehicle};
  if (is_of_camera(options)) {
    xml.refuse(xml.root(), "has poses in the plane, and no camera's", "another --pose-frame",
               "leave it out: they are of the middle of its vehicle's body");
  }
  pugi::xml_node driven;
  for (const pugi::xml_node trajectory : xml.root().children()) {
    if (!std::string_view(trajectory.name()).ends_with("Trajectory")) continue;
    if (driven) {
      xml.refuse(trajectory, "is a second trajectory", "one", "write each to a file of its own");
    }
    driven = trajectory;
  }
  std::vector<SolutionState> states;
  for (const pugi::xml_node state : driven.children()) {
    if (!std::string_view(state.name()).ends_with("State")) continue;
    states.push_back(state_of(xml, state, step_s));
    read.places.push_back(static_cast<std::size_t>(xml.line_of(state)));
  }
  if (states.empty()) return read;
  if (std::ranges::none_of(states, has_heading)) {
    xml.refuse(driven, "is of a point mass at rest all along", "a state that moves: its heading",
               "give the drive as a table, which has headings");
  }
  read.poses = with_held_headings(states);
  return read;
}

}  // namespace roadbed::tools::files
