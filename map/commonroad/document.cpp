#include "roadbed/map/commonroad/document.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "roadbed/map/elements/lane_lines.h"
#include "roadbed/map/files/coordinate_limits.h"
#include "roadbed/map/files/visible_text.h"

namespace roadbed::map::commonroad {
namespace {

std::string_view reference(pugi::xml_node node) { return node.attribute("ref").value(); }

ElementsById by_id(const XmlDocument& xml, const char* kind) {
  ElementsById elements;
  for (const pugi::xml_node node : xml.root().children(kind)) {
    elements.emplace(node.attribute("id").value(), node);
  }
  return elements;
}

}  // namespace

Document::Document(std::string bytes, std::string name)
    : xml(std::move(bytes), std::move(name)),
      lanelet_by_id(by_id(xml, "lanelet")),
      sign_by_id(by_id(xml, "trafficSign")),
      light_by_id(by_id(xml, "trafficLight")) {}

bool is_same_direction(pugi::xml_node adjacent) {
  return std::string_view(adjacent.attribute("drivingDir").value()) == "same";
}

const char* counterpart(pugi::xml_node link) {
  const std::string_view name = link.name();
  if (name == "successor") return "predecessor";
  if (name == "predecessor") return "successor";
  return (name == "adjacentLeft") == is_same_direction(link) ? "adjacentRight" : "adjacentLeft";
}

bool is_answered(pugi::xml_node lanelet, pugi::xml_node link, pugi::xml_node other) {
  const std::string_view id = lanelet.attribute("id").value();
  const char* name = counterpart(link);
  if (std::string_view(name).starts_with("adjacent")) {
    const pugi::xml_node back = other.child(name);
    return reference(back) == id && is_same_direction(back) == is_same_direction(link);
  }
  const auto links = other.children(name);
  return std::any_of(links.begin(), links.end(),
                     [&](pugi::xml_node back) { return reference(back) == id; });
}

Eigen::Vector2d find_origin(const XmlDocument& xml) {
  const pugi::xml_node first = xml.root().child("lanelet").child("leftBound").child("point");
  if (!first) return {0.0, 0.0};
  return origin_near(read_point(xml, first, {0.0, 0.0}).head<2>());
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
  return one_line(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

std::vector<std::string> texts(pugi::xml_node parent, const char* child) {
  std::vector<std::string> found;
  for (const pugi::xml_node node : parent.children(child)) found.push_back(text_of(node));
  return found;
}

}  // namespace roadbed::map::commonroad
