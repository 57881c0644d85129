#include <map>
#include <utility>

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/edit/elevation/elevate.h"
#include "roadbed/map/edit/elevation/point_heights.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit::inline elevation {
namespace {

using Eigen::Vector3d;

/// Lines of a file's lanelets: points at one place are one.
class Borders {
 public:
  explicit Borders(const commonroad::Document& document) : xml_(document.xml) {
    for (const auto lanelet : document.lanelets()) {
      const Line left = read(lanelet.child("leftBound")), right = read(lanelet.child("rightBound"));
      read(lanelet.child("stopLine"));
      if (left.empty() || right.empty()) continue;
      sides_.emplace_back(left.front(), right.front());
      sides_.emplace_back(left.back(), right.back());
    }
  }

  HeightNetwork lines() const {
    HeightNetwork network(points_.size());
    for (const auto* list : {&steps_, &sides_}) {
      for (const auto& [a, b] : *list) {
        network.connect(a, b, (points_[a] - points_[b]).head<2>().norm());
      }
    }
    return network;
  }

  const std::vector<Vector3d>& points() const { return points_; }

  /// All points that the file has of its lines, each with the place that it is at.
  const std::vector<std::pair<pugi::xml_node, std::size_t>>& elements() const { return elements_; }

 private:
  using Line = std::vector<std::size_t>;

  Line read(pugi::xml_node parent) {
    Line line;
    for (const auto point : parent.children("point")) {
      const Vector3d at = commonroad::read_point(xml_, point, {0.0, 0.0});
      const auto [place, is_new] = places_.try_emplace({at.x(), at.y()}, points_.size());
      if (is_new) points_.push_back(at);
      if (!line.empty()) steps_.emplace_back(line.back(), place->second);
      line.push_back(place->second);
      elements_.emplace_back(point, place->second);
    }
    return line;
  }

  const XmlDocument& xml_;
  std::map<std::pair<double, double>, std::size_t> places_;
  std::vector<Vector3d> points_;
  std::vector<std::pair<std::size_t, std::size_t>> steps_, sides_;
  std::vector<std::pair<pugi::xml_node, std::size_t>> elements_;
};

void set_height(pugi::xml_node point, double height_m) {
  pugi::xml_node z = point.child("z");
  if (!z) z = point.insert_child_after("z", point.child("y"));
  z.text().set(height_text(height_m).c_str());
}

}  // namespace

Edited elevate_common_road(std::string bytes, const std::string& name,
                           const GroundHeights& ground) {
  const std::string indent = indent_of(bytes);
  const commonroad::Document document(std::move(bytes), name);
  const Borders borders(document);
  Edited result;
  const auto heights_m =
      heights_on(borders.points(), borders.lines(), ground, "points of lanelets", result);
  for (const auto& [element, place] : borders.elements()) {
    set_height(element, heights_m[place].value_or(borders.points()[place].z()));
  }
  result.bytes = text_of(document.xml, indent);
  return result;
}

}  // namespace roadbed::map::edit::elevation
