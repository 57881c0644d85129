#include "roadbed/map/edit/merging/osm_seams.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "roadbed/map/edit/merging/lanelet_identities.h"
#include "roadbed/map/edit/merging/near_ends.h"
#include "roadbed/map/lanelet2/centreline.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

using lanelet2::Document;
using Id = std::int64_t;

/// Where a lanelet begins or ends.
struct LaneletEnd {
  std::size_t file;
  Id whole;  ///< what it is, or is a part of, in the merged map
  bool is_start;
  std::uint32_t left, right;  ///< nodes of its file
};

const lanelet2::Way* border(const Document& file, const lanelet2::Relation& lanelet,
                            std::string_view role) {
  for (const lanelet2::Member& member : lanelet.members) {
    if (member.role != role || member.kind != lanelet2::MemberKind::way) continue;
    const auto way = file.way_index.find(member.id);
    if (way && file.ways[*way].nodes.size() >= 2) return &file.ways[*way];
  }
  return nullptr;
}

void add_ends(const Document& file, std::size_t index, const CalledInMerged& called,
              std::vector<LaneletEnd>& ends) {
  for (const lanelet2::Relation& relation : file.relations) {
    if (relation.type != "lanelet") continue;
    const lanelet2::Way *left = border(file, relation, "left"),
                        *right = border(file, relation, "right");
    if (left == nullptr || right == nullptr) continue;
    const Id whole = called(index, LaneletIdentities::whole_of(relation));
    const auto alignment = lanelet2::align(file.points(*left), file.points(*right));
    const auto end = [](const lanelet2::Way& way, bool first) {
      return first ? way.nodes.front() : way.nodes.back();
    };
    for (const bool is_start : {true, false}) {
      ends.push_back({index, whole, is_start, end(*left, is_start != alignment.left_reversed),
                      end(*right, is_start != alignment.right_reversed)});
    }
  }
}

bool has_height(const Document& file, std::uint32_t node) {
  const Attributes tags = file.tags_of(file.nodes[node].at);
  return std::any_of(tags.begin(), tags.end(), [](const auto& tag) { return tag.first == "ele"; });
}

/// A node of one of the files.
struct NodeOfFile {
  const Document& file;
  std::uint32_t node;

  Eigen::Vector2d in_source() const {
    return file.origin_in_source + file.nodes[node].in_map.head<2>();
  }
  double height_m() const { return file.nodes[node].in_map.z(); }
};

// In space where both say how high they are, else in the plane.
double distance_m(const NodeOfFile& a, const NodeOfFile& b) {
  const double in_plane_m = (a.in_source() - b.in_source()).norm();
  const double rise_m = a.height_m() - b.height_m();
  if (rise_m == 0.0 || !has_height(a.file, a.node) || !has_height(b.file, b.node)) {
    return in_plane_m;
  }
  return std::hypot(in_plane_m, rise_m);
}

Id root_of(Id node, const std::map<Id, Id>& one) {
  for (auto next = one.find(node); next != one.end(); next = one.find(node)) node = next->second;
  return node;
}

// The one of the lesser number stays.
void unite(Id a, Id b, std::map<Id, Id>& one) {
  a = root_of(a, one), b = root_of(b, one);
  if (a != b) one.emplace(std::max(a, b), std::min(a, b));
}

}  // namespace

std::map<Id, Id> nodes_to_join(const std::vector<Document>& files, const CalledInMerged& called,
                               const CalledInMerged& lanelet_called, double tolerance_m,
                               std::vector<Seam>& seams) {
  std::vector<LaneletEnd> ends;
  for (std::size_t f = 0; f < files.size(); ++f) add_ends(files[f], f, lanelet_called, ends);
  const auto place = [&](const LaneletEnd& end, std::uint32_t node) {
    return NodeOfFile{files[end.file], node};
  };
  const auto name = [&](const LaneletEnd& end, std::uint32_t node) {
    return called(end.file, files[end.file].nodes[node].id);
  };
  std::vector<Eigen::Vector2d> places;
  for (const LaneletEnd& end : ends) places.push_back(place(end, end.left).in_source());
  NearEnds near(places, tolerance_m);

  std::map<Id, Id> one;
  for (const LaneletEnd& end : ends) {
    if (end.is_start) continue;
    const Eigen::Vector2d left = place(end, end.left).in_source();
    for (const std::size_t i : near.around(left)) {
      const LaneletEnd& next = ends[i];
      if (!next.is_start || next.file == end.file) continue;
      const double gap_m = std::max(distance_m(place(next, next.left), place(end, end.left)),
                                    distance_m(place(next, next.right), place(end, end.right)));
      const Id from_left = name(end, end.left), from_right = name(end, end.right),
               to_left = name(next, next.left), to_right = name(next, next.right);
      if (gap_m > tolerance_m || (from_left == to_left && from_right == to_right)) continue;
      near.add_pair();
      const bool is_one = end.whole == next.whole;  // is put together anyhow
      seams.push_back({fmt::format("end of lanelet {}", end.whole),
                       fmt::format("start of lanelet {}", next.whole), gap_m,
                       is_one ? "joined" : "linked", left.x(), left.y()});
      if (is_one) continue;
      if (from_left != to_left) unite(from_left, to_left, one);
      if (from_right != to_right) unite(from_right, to_right, one);
    }
  }
  for (auto& [from, to] : one) to = root_of(to, one);
  return one;
}

}  // namespace roadbed::map::edit::merging
