#include "roadbed/map/commonroad/elements.h"

#include <cmath>

namespace roadbed::map::commonroad {
namespace {

constexpr double kFarthestM = 1e8, kHighestM = 1e5;  // beyond any road: a slip

}  // namespace

Eigen::Vector2d find_origin(const XmlDocument& xml) {
  constexpr double far_m = 20'000.0, grid_m = 1'000.0;
  const pugi::xml_node first = xml.root().child("lanelet").child("leftBound").child("point");
  if (!first) return {0.0, 0.0};
  const Eigen::Vector2d at = read_point(xml, first, {0.0, 0.0}).head<2>();
  if (at.cwiseAbs().maxCoeff() <= far_m) return {0.0, 0.0};
  return {grid_m * std::round(at.x() / grid_m), grid_m * std::round(at.y() / grid_m)};
}

Eigen::Vector3d read_point(const XmlDocument& xml, pugi::xml_node point,
                           const Eigen::Vector2d& origin_in_source) {
  const double x_m = xml.text_number(point, "x"), y_m = xml.text_number(point, "y");
  const double z_m = point.child("z") ? xml.text_number(point, "z") : 0.0;
  if (std::abs(x_m) > kFarthestM || std::abs(y_m) > kFarthestM || std::abs(z_m) > kHighestM) {
    xml.refuse(point, "a place beyond that of any road", "|x|, |y| ≤ 1e8 m and |z| ≤ 1e5 m",
               "correct the values");
  }
  return {x_m - origin_in_source.x(), y_m - origin_in_source.y(), z_m};
}

std::vector<Eigen::Vector3d> read_points(const XmlDocument& xml, pugi::xml_node parent,
                                         const Eigen::Vector2d& origin_in_source) {
  std::vector<Eigen::Vector3d> points;
  for (const pugi::xml_node point : parent.children("point")) {
    points.push_back(read_point(xml, point, origin_in_source));
  }
  return points;
}

std::vector<std::string> references(pugi::xml_node parent, const char* child) {
  std::vector<std::string> found;
  for (const pugi::xml_node node : parent.children(child)) {
    found.emplace_back(node.attribute("ref").value());
  }
  return found;
}

std::string text_of(pugi::xml_node node) {
  const std::string text = node.child_value();
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::vector<std::string> texts(pugi::xml_node parent, const char* child) {
  std::vector<std::string> found;
  for (const pugi::xml_node node : parent.children(child)) found.push_back(text_of(node));
  return found;
}

}  // namespace roadbed::map::commonroad
