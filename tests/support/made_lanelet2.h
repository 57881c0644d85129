#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace roadbed::tests {

/// Writes small Lanelet2 files, element by element, for tests that know every point.
class MadeLanelet2 {
 public:
  using Tags = std::vector<std::pair<std::string, std::string>>;
  using Point = std::pair<double, double>;
  using Member = std::pair<std::int64_t, std::string>;  ///< way (or relation, if negated), role

  /// A node with local_x and local_y; its id.
  std::int64_t node(Point local, double elevation_m = 0.0);
  /// A node with latitude and longitude only.
  std::int64_t geographic_node(double latitude_deg, double longitude_deg);
  std::int64_t way(const std::vector<std::int64_t>& nodes, const Tags& tags = {});
  /// A way through new nodes.
  std::int64_t line(const std::vector<Point>& points, const Tags& tags = {});
  /// Members with a negative number are relations.
  std::int64_t relation(const std::vector<Member>& members, const Tags& tags);
  std::int64_t lanelet(std::int64_t left, std::int64_t right, Tags tags = {{"subtype", "road"}},
                       const std::vector<Member>& more = {});
  void raw(const std::string& xml) { body_ += xml; }

  std::string text() const;

 private:
  static std::string tags_text(const Tags& tags);

  std::int64_t next_ = 1;
  std::string body_;
};

}  // namespace roadbed::tests
