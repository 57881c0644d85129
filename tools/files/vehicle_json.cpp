#include "roadbed/tools/files/vehicle_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "roadbed/geometry/motion/rectangle.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline files {
namespace {

using geometry::BodyPart;
using geometry::VehicleShape;

struct Key {
  std::string_view name;
  double VehicleShape::*value;
};

constexpr std::array<Key, 7> kKeys{{
    {"length_m", &VehicleShape::length_m},
    {"width_m", &VehicleShape::width_m},
    {"rear_overhang_m", &VehicleShape::rear_overhang_m},
    {"wheelbase_m", &VehicleShape::wheelbase_m},
    {"height_m", &VehicleShape::height_m},
    {"max_steering_rad", &VehicleShape::max_steering_rad},
    {"max_steering_rate_radps", &VehicleShape::max_steering_rate_radps},
}};

constexpr Range kMeasure{0.0, 1000.0}, kPlace_m{-1000.0, 1000.0}, kHeight_m{0.0, 100.0};
constexpr double kTouch_m = 1e-6;
constexpr std::size_t kMostParts = 64;
constexpr double kUnsaid_m = -1.0;  // a height that a circle takes from its vehicle

constexpr std::string_view kRemedy = "mend it or leave it out";

void check_part(const BodyPart& part, const JsonNode& node) {
  try {
    part.check();
  } catch (const std::invalid_argument& error) {
    node.refuse(error.what(), "a box or circle with extent", std::string(kRemedy));
  }
  if (is_height_of_part(part.from_height_m, part.to_height_m)) return;
  node.refuse(fmt::format("is {:.9g} m high", part.to_height_m - part.from_height_m),
              fmt::format("at least {} m", kLeastHeight_m), std::string(kRemedy));
}

BodyPart mirror(const JsonNode& node, const VehicleShape& shape, bool is_left) {
  const double beyond_m = node.at("beyond_m").number(kMeasure);
  const double side_m = 0.5 * shape.width_m;
  BodyPart part{.name = is_left ? "left mirror" : "right mirror",
                .rear_m = node.at("rear_m").number(kPlace_m),
                .front_m = node.at("front_m").number(kPlace_m),
                .right_m = is_left ? side_m : -side_m - beyond_m,
                .left_m = is_left ? side_m + beyond_m : -side_m,
                .from_height_m = node.at("from_height_m").number(kHeight_m),
                .to_height_m = node.at("to_height_m").number(kHeight_m)};
  check_part(part, node);
  return part;
}

std::vector<BodyPart> mirrors(const JsonNode& node, const VehicleShape& shape) {
  node.require_object({"beyond_m", "rear_m", "front_m", "from_height_m", "to_height_m"});
  return {mirror(node, shape, true), mirror(node, shape, false)};
}

BodyPart circle(const JsonNode& node, std::size_t number) {
  node.require_object({"x_m", "y_m", "radius_m", "from_height_m", "to_height_m"});
  constexpr Range radius{1e-3, 500.0};
  const double x_m = node.at("x_m").number(kPlace_m), y_m = node.number_or("y_m", 0.0, kPlace_m);
  BodyPart part{.name = fmt::format("circle {}", number),
                .rear_m = x_m,
                .front_m = x_m,
                .right_m = y_m,
                .left_m = y_m,
                .radius_m = node.at("radius_m").number(radius),
                .from_height_m = node.number_or("from_height_m", kUnsaid_m, kHeight_m),
                .to_height_m = node.number_or("to_height_m", kUnsaid_m, kHeight_m)};
  const bool says_both = part.from_height_m != kUnsaid_m && part.to_height_m != kUnsaid_m;
  if (says_both) check_part(part, node);
  return part;
}

BodyPart other_part(const JsonNode& node) {
  node.require_object(
      {"name", "rear_m", "front_m", "right_m", "left_m", "from_height_m", "to_height_m"});
  BodyPart part{.name = read_part_name(node.at("name")),
                .rear_m = node.at("rear_m").number(kPlace_m),
                .front_m = node.at("front_m").number(kPlace_m),
                .right_m = node.at("right_m").number(kPlace_m),
                .left_m = node.at("left_m").number(kPlace_m),
                .from_height_m = node.at("from_height_m").number(kHeight_m),
                .to_height_m = node.at("to_height_m").number(kHeight_m)};
  check_part(part, node);
  return part;
}

bool touch(const BodyPart& a, const BodyPart& b) {
  const geometry::Pose2 here{0.0, 0.0, 0.0};
  return geometry::distance_m(a.core_at(here), b.core_at(here)) - a.radius_m - b.radius_m <=
         kTouch_m;
}

// A part apart from all others is one whose sign or place is wrong.
std::string part_apart(const std::vector<BodyPart>& parts) {
  std::vector<std::size_t> to_come{0};
  std::vector<bool> is_joined(parts.size());
  is_joined[0] = true;
  while (!to_come.empty()) {
    const BodyPart& part = parts[to_come.back()];
    to_come.pop_back();
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (is_joined[i] || !touch(part, parts[i])) continue;
      is_joined[i] = true;
      to_come.push_back(i);
    }
  }
  const auto apart = std::ranges::find(is_joined, false);
  return apart == is_joined.end() ? ""
                                  : parts[static_cast<std::size_t>(apart - is_joined.begin())].name;
}

bool has_twins(std::vector<BodyPart> parts) {
  std::ranges::sort(parts, {}, &BodyPart::name);
  return std::ranges::adjacent_find(parts, {}, &BodyPart::name) != parts.end();
}

void check_together(const Vehicle& vehicle, const JsonNode& node) {
  std::vector<BodyPart> all = vehicle.circles;
  if (all.empty()) all.push_back(geometry::body_of(vehicle.shape));
  all.insert(all.end(), vehicle.more.begin(), vehicle.more.end());
  if (all.size() > kMostParts) {
    node.refuse(fmt::format("has {} parts", all.size()), fmt::format("at most {}", kMostParts),
                "join some");
  }
  if (has_twins(all)) {
    node.refuse("has two parts of one name", "names that tell them apart", "rename one");
  }
  if (const std::string apart = part_apart(all); !apart.empty()) {
    node.refuse(fmt::format("part \"{}\" is apart from the rest", apart),
                "parts that touch, in the frame of the rear axle, x forward and y left",
                "check its signs");
  }
}

VehicleShape shape_of(const JsonNode& node) {
  VehicleShape shape;
  for (const Key& key : kKeys) {
    shape.*key.value = node.number_or(key.name, shape.*key.value, kMeasure);
  }
  try {
    shape.check();
  } catch (const std::invalid_argument& error) {
    node.refuse(error.what(), "", "change the vehicle's measures");
  }
  return shape;
}

}  // namespace

bool is_height_of_part(double from_m, double to_m) {
  constexpr double rounding_m = 1e-9;
  return to_m - from_m >= kLeastHeight_m - rounding_m;
}

std::string read_part_name(const JsonNode& node) {
  constexpr std::size_t longest = 60;
  std::string name = node.one_line();
  if (name.size() > longest) {
    node.refuse(fmt::format("has {} bytes", name.size()), fmt::format("at most {}", longest),
                "shorten the name");
  }
  return name;
}

std::vector<BodyPart> Vehicle::parts(double from_height_m) const {
  std::vector<BodyPart> all = circles;
  for (BodyPart& part : all) {
    if (part.from_height_m == kUnsaid_m) part.from_height_m = from_height_m;
    if (part.to_height_m == kUnsaid_m) part.to_height_m = shape.height_m;
  }
  if (all.empty()) all.push_back(geometry::body_of(shape, from_height_m));
  for (const BodyPart& part : all) {
    if (is_height_of_part(part.from_height_m, part.to_height_m)) continue;
    throw map::InputError(
        {.file = "vehicle",
         .element = part.name,
         .found = fmt::format("ends {} m above the ground", part.to_height_m),
         .needed = fmt::format("{} m more at least than where it begins, {} m, by --from-height "
                               "or its own",
                               kLeastHeight_m, part.from_height_m),
         .remedy = "lower --from-height"});
  }
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Vehicle parse_vehicle_json(std::string_view bytes, const std::string& name) {
  const nlohmann::json document = parse_json_strictly(bytes, name);
  return vehicle_in(JsonNode(document, name));
}

Vehicle vehicle_in(const JsonNode& node) {
  node.check_version("vehicle");
  node.require_object({"roadbed_vehicle", "length_m", "width_m", "rear_overhang_m", "wheelbase_m",
                       "height_m", "max_steering_rad", "max_steering_rate_radps", "mirrors",
                       "circles", "parts"});
  Vehicle vehicle{.shape = shape_of(node), .circles = {}, .more = {}};
  if (const auto circles = node.find("circles")) {
    for (const JsonNode& one : circles->elements()) {
      vehicle.circles.push_back(circle(one, vehicle.circles.size() + 1));
    }
  }
  if (const auto both = node.find("mirrors")) vehicle.more = mirrors(*both, vehicle.shape);
  if (const auto parts = node.find("parts")) {
    for (const JsonNode& one : parts->elements()) vehicle.more.push_back(other_part(one));
  }
  check_together(vehicle, node);
  return vehicle;
}

VehicleShape vehicle_shape_in(const JsonNode& node) {
  const Vehicle vehicle = vehicle_in(node);
  if (vehicle.circles.empty() && vehicle.more.empty()) return vehicle.shape;
  node.refuse("has mirrors, circles or parts, which only audits look at",
              "a rectangle that holds them", "leave them out, and widen width_m and length_m");
}

}  // namespace roadbed::tools::files
