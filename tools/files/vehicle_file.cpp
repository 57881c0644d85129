#include "roadbed/tools/files/vehicle_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"

namespace roadbed::tools::inline files {
namespace {

using geometry::VehicleShape;

constexpr std::string_view kCommonRoad = "commonroad:";

/// Length, width, distances of the axles from the centre of mass (a before, b behind it), and
/// limits of steering: parameter sets 1 to 4 of CommonRoad's vehicle models [Althoff, Würsching:
/// CommonRoad: Vehicle Models (Version 2020a), and commonroad-vehicle-models 3.0.2], where the
/// centre of mass is the body's centre. They give no heights: these are the default's, that of a
/// Transporter T3 rounded up, and the highest that a lorry may have in Europe (96/53/EC). Set 4 is
/// the tractor of a semi-trailer, here without it; set 2 is the default, rounded to 0.1 µm.
VehicleShape common_road(double length_m, double width_m, double a_m, double b_m, double height_m,
                         double max_steering_rad, double max_steering_rate_radps) {
  return {.length_m = length_m,
          .width_m = width_m,
          .rear_overhang_m = 0.5 * length_m - b_m,
          .wheelbase_m = a_m + b_m,
          .height_m = height_m,
          .max_steering_rad = max_steering_rad,
          .max_steering_rate_radps = max_steering_rate_radps};
}

const VehicleShape kVehicles[] = {
    common_road(4.298, 1.674, 0.88392, 1.50876, 1.5, 0.910, 0.4),            // Ford Escort
    VehicleShape{},                                                          // BMW 320i
    common_road(4.569, 1.844, 1.1507916024, 1.3211363976, 2.0, 1.023, 0.4),  // VW Vanagon
    common_road(5.100, 2.550, 1.8, 1.8, 4.0, 0.550, 0.7103),                 // tractor
};

/// JSON begins with a brace; YAML's parameters with a name or a comment.
bool begins_as_yaml(std::string_view bytes) {
  const std::size_t at = bytes.find_first_not_of(" \t\r\n");
  if (at == std::string_view::npos) return false;
  const std::string_view rest = bytes.substr(at);
  return rest.starts_with('#') || rest.starts_with("---") || rest.starts_with("/") ||
         rest.starts_with("'/") || rest.starts_with("\"/") || rest.starts_with("ros__parameters");
}

}  // namespace

bool is_vehicle_name(std::string_view text) { return text.starts_with(kCommonRoad); }

std::string measures_text(const VehicleShape& shape) {
  return fmt::format("{} {} {} {} {} {} {}", shape.length_m, shape.width_m, shape.rear_overhang_m,
                     shape.wheelbase_m, shape.height_m, shape.max_steering_rad,
                     shape.max_steering_rate_radps);
}

std::optional<Vehicle> named_vehicle(const std::string& text) {
  if (!is_vehicle_name(text)) return std::nullopt;
  const std::string number = text.substr(kCommonRoad.size());
  constexpr std::size_t count = std::size(kVehicles);
  if (number.size() == 1 && number[0] >= '1' && number[0] < static_cast<char>('1' + count)) {
    return Vehicle{.shape = kVehicles[number[0] - '1'], .circles = {}, .more = {}};
  }
  throw map::InputError({.file = text,
                         .found = "is no vehicle of CommonRoad",
                         .needed = "commonroad:1 to commonroad:4",
                         .remedy = "choose one of them, or give a file"});
}

Vehicle read_vehicle(const std::filesystem::path& file) {
  if (auto vehicle = named_vehicle(file.string())) return *std::move(vehicle);
  return parse_vehicle(map::read_file(file), map::input_name(file));
}

Vehicle parse_vehicle(std::string_view bytes, const std::string& name) {
  return begins_as_yaml(bytes) ? parse_autoware_vehicle(bytes, name)
                               : parse_vehicle_json(bytes, name);
}

geometry::VehicleShape read_vehicle_shape(const std::filesystem::path& file) {
  Vehicle vehicle = read_vehicle(file);
  if (vehicle.circles.empty() && vehicle.more.empty()) return vehicle.shape;
  throw map::InputError({.file = map::input_name(file),
                         .found = "has mirrors, circles or parts, which only audits look at",
                         .needed = "a rectangle that holds them",
                         .remedy = "leave them out, and widen width_m and length_m"});
}

}  // namespace roadbed::tools::files
