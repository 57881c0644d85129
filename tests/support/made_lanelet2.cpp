#include "roadbed/tests/support/made_lanelet2.h"

#include <sstream>

namespace roadbed::tests {

std::string MadeLanelet2::tags_text(const Tags& tags) {
  std::string text;
  for (const auto& [key, value] : tags) {
    text += "<tag k=\"" + key + "\" v=\"" + value + "\"/>";
  }
  return text;
}

std::int64_t MadeLanelet2::node(Point local, double elevation_m) {
  std::ostringstream text;
  text.precision(17);
  text << "<node id=\"" << next_ << "\" lat=\"\" lon=\"\"><tag k=\"local_x\" v=\"" << local.first
       << "\"/><tag k=\"local_y\" v=\"" << local.second << "\"/><tag k=\"ele\" v=\"" << elevation_m
       << "\"/></node>\n";
  body_ += text.str();
  return next_++;
}

std::int64_t MadeLanelet2::geographic_node(double latitude_deg, double longitude_deg) {
  std::ostringstream text;
  text.precision(17);
  text << "<node id=\"" << next_ << "\" lat=\"" << latitude_deg << "\" lon=\"" << longitude_deg
       << "\"/>\n";
  body_ += text.str();
  return next_++;
}

std::int64_t MadeLanelet2::way(const std::vector<std::int64_t>& nodes, const Tags& tags) {
  body_ += "<way id=\"" + std::to_string(next_) + "\">";
  for (const std::int64_t id : nodes) body_ += "<nd ref=\"" + std::to_string(id) + "\"/>";
  body_ += tags_text(tags) + "</way>\n";
  return next_++;
}

std::int64_t MadeLanelet2::line(const std::vector<Point>& points, const Tags& tags) {
  std::vector<std::int64_t> nodes;
  for (const Point& point : points) nodes.push_back(node(point));
  return way(nodes, tags);
}

std::int64_t MadeLanelet2::relation(const std::vector<Member>& members, const Tags& tags) {
  body_ += "<relation id=\"" + std::to_string(next_) + "\">";
  for (const auto& [id, role] : members) {
    body_ += std::string("<member type=\"") + (id < 0 ? "relation" : "way") + "\" ref=\"" +
             std::to_string(id < 0 ? -id : id) + "\" role=\"" + role + "\"/>";
  }
  body_ += tags_text(tags) + "</relation>\n";
  return next_++;
}

std::int64_t MadeLanelet2::lanelet(std::int64_t left, std::int64_t right, Tags tags,
                                   const std::vector<Member>& more) {
  tags.emplace_back("type", "lanelet");
  std::vector<Member> members = {{left, "left"}, {right, "right"}};
  members.insert(members.end(), more.begin(), more.end());
  return relation(members, tags);
}

std::string MadeLanelet2::text() const {
  return "<?xml version=\"1.0\"?>\n<osm version=\"0.6\">\n" + body_ + "</osm>\n";
}

}  // namespace roadbed::tests
