#include "roadbed/tests/support/made_vector_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace roadbed::tests {
namespace {

std::string tags_text(const MadeVectorMap::Tags& tags) {
  std::string text;
  for (const auto& [key, value] : tags) {
    text += fmt::format("    <tag k=\"{}\" v=\"{}\"/>\n", key, value);
  }
  return text;
}

}  // namespace

void MadeVectorMap::Relation::drop(const std::string& role) {
  std::erase_if(members, [&](const Member& member) { return member.role == role; });
}

MadeVectorMap::Id MadeVectorMap::node(double x_m, double y_m, double z_m) {
  for (const auto& [id, made] : nodes) {
    if (made.x_m == x_m && made.y_m == y_m && made.z_m == z_m) return id;
  }
  nodes[next_node_] = {x_m, y_m, z_m};
  return next_node_++;
}

MadeVectorMap::Id MadeVectorMap::line(Id id, const std::vector<std::pair<double, double>>& points,
                                      const Tags& tags) {
  Way way{{}, tags};
  for (const auto& [x_m, y_m] : points) way.nodes.push_back(node(x_m, y_m));
  ways[id] = way;
  return id;
}

MadeVectorMap::Id MadeVectorMap::area(Id id, const std::vector<std::pair<double, double>>& points,
                                      const Tags& tags) {
  line(id, points, tags);
  ways[id].tags["area"] = "yes";
  return id;
}

MadeVectorMap::Id MadeVectorMap::border_between(Id from, Id to, const std::string& type) {
  const std::vector<Id> along{from, to};
  for (const auto& [id, way] : ways) {
    if (way.nodes == along && !way.tags.contains("area")) return id;
  }
  ways[next_way_] = {along, {{"type", type}}};
  return next_way_++;
}

void MadeVectorMap::eastwards(Id id, std::pair<double, double> x_m, std::pair<double, double> y_m,
                              const Tags& tags, const std::string& border_type) {
  const Id left =
      border_between(node(x_m.first, y_m.second), node(x_m.second, y_m.second), border_type);
  const Id right =
      border_between(node(x_m.first, y_m.first), node(x_m.second, y_m.first), border_type);
  lanelet(id, left, right, tags);
}

void MadeVectorMap::northwards(Id id, std::pair<double, double> x_m, std::pair<double, double> y_m,
                               const Tags& tags, const std::string& border_type) {
  const Id left =
      border_between(node(x_m.first, y_m.first), node(x_m.first, y_m.second), border_type);
  const Id right =
      border_between(node(x_m.second, y_m.first), node(x_m.second, y_m.second), border_type);
  lanelet(id, left, right, tags);
}

void MadeVectorMap::lanelet(Id id, Id left, Id right, const Tags& tags) {
  Relation made{{{"way", left, "left"}, {"way", right, "right"}}, tags};
  made.tags["type"] = "lanelet";
  relations[id] = made;
}

void MadeVectorMap::regulation(Id id, const std::string& subtype,
                               const std::vector<Member>& members,
                               const std::vector<Id>& lanelets) {
  relations[id] = {members, {{"type", "regulatory_element"}, {"subtype", subtype}}};
  for (const Id user : lanelets) {
    relations.at(user).members.push_back({"relation", id, "regulatory_element"});
  }
}

MadeVectorMap::Id MadeVectorMap::border(Id lanelet, const std::string& side) const {
  for (const Member& member : relations.at(lanelet).members) {
    if (member.role == side) return member.id;
  }
  throw std::invalid_argument("MadeVectorMap::border: no such side");
}

std::string MadeVectorMap::text() const {
  std::string text = "<?xml version=\"1.0\"?>\n<osm version=\"0.6\">\n";
  for (const auto& [id, made] : nodes) {
    text += fmt::format("  <node id=\"{}\" lat=\"\" lon=\"\">\n", id);
    if (made.has_x) text += tags_text({{"local_x", fmt::format("{}", made.x_m)}});
    if (made.has_y) text += tags_text({{"local_y", fmt::format("{}", made.y_m)}});
    text += tags_text({{"ele", fmt::format("{}", made.z_m)}}) + tags_text(made.tags);
    text += "  </node>\n";
  }
  for (const auto& [id, way] : ways) {
    text += fmt::format("  <way id=\"{}\">\n", id);
    for (const Id node : way.nodes) text += fmt::format("    <nd ref=\"{}\"/>\n", node);
    text += tags_text(way.tags) + "  </way>\n";
  }
  for (const auto& [id, relation] : relations) {
    text += fmt::format("  <relation id=\"{}\">\n", id);
    for (const Member& member : relation.members) {
      text += fmt::format("    <member type=\"{}\" ref=\"{}\" role=\"{}\"/>\n", member.kind,
                          member.id, member.role);
    }
    text += tags_text(relation.tags) + "  </relation>\n";
  }
  return text + "</osm>\n";
}

MadeVectorMap::Tags road_tags(const MadeVectorMap::Tags& more) {
  MadeVectorMap::Tags tags = {
      {"subtype", "road"}, {"location", "urban"}, {"one_way", "yes"}, {"speed_limit", "30"}};
  for (const auto& [key, value] : more) tags[key] = value;
  return tags;
}

}  // namespace roadbed::tests
