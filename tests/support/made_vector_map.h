#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace roadbed::tests {

/// Writes small Lanelet2 maps for Autoware whose parts can be changed before they are written.
/// Nodes at one place are one node, and borders between two nodes one way, so that lanelets that
/// touch share them.
class MadeVectorMap {
 public:
  using Tags = std::map<std::string, std::string>;
  using Id = std::int64_t;

  struct Node {
    double x_m = 0.0, y_m = 0.0, z_m = 0.0;
    Tags tags = {};
    bool has_x = true, has_y = true;  ///< local_x and local_y are written
  };
  struct Way {
    std::vector<Id> nodes;
    Tags tags;
  };
  struct Member {
    std::string kind;  ///< "way", "relation"
    Id id = 0;
    std::string role;
  };
  struct Relation {
    std::vector<Member> members;
    Tags tags;

    void drop(const std::string& role);  ///< all members with it
  };

  /// The node there, a new one if there is none.
  Id node(double x_m, double y_m, double z_m = 0.0);
  /// A line through such nodes.
  Id line(Id id, const std::vector<std::pair<double, double>>& points, const Tags& tags);
  /// The same, closed and with area=yes.
  Id area(Id id, const std::vector<std::pair<double, double>>& points, const Tags& tags);

  /// A lanelet that fills a box and leads to the east, or to the north. Borders that are not there
  /// yet are of the type.
  void eastwards(Id id, std::pair<double, double> x_m, std::pair<double, double> y_m,
                 const Tags& tags, const std::string& border_type = "line_thin");
  void northwards(Id id, std::pair<double, double> x_m, std::pair<double, double> y_m,
                  const Tags& tags, const std::string& border_type = "line_thin");
  /// A lanelet between two ways.
  void lanelet(Id id, Id left, Id right, const Tags& tags);

  /// A regulatory element that these lanelets name.
  void regulation(Id id, const std::string& subtype, const std::vector<Member>& members,
                  const std::vector<Id>& lanelets);

  /// The way that is a lanelet's border.
  Id border(Id lanelet, const std::string& side) const;

  std::string text() const;

  std::map<Id, Node> nodes;
  std::map<Id, Way> ways;
  std::map<Id, Relation> relations;

 private:
  Id border_between(Id from, Id to, const std::string& type);

  Id next_node_ = 100'000, next_way_ = 200'000;
};

/// What a road lanelet has to say of itself.
MadeVectorMap::Tags road_tags(const MadeVectorMap::Tags& more = {});

}  // namespace roadbed::tests
