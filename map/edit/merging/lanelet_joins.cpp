#include "roadbed/map/edit/merging/lanelet_joins.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "roadbed/map/edit/lanelet_parts.h"
#include "roadbed/map/edit/merging/lanelet_ends.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

using Eigen::Vector2d;

constexpr double kSameRow = 1e-6, kSamePlaceM = 1e-3;
constexpr std::array<const char*, 2> kBounds = {"leftBound", "rightBound"};
// Different lanelets that have parts of one id; there are as many as maps of different places.
constexpr std::size_t kMostKinds = 8;

Vector2d place_of(pugi::xml_node point) {
  return {point.child("x").text().as_double(), point.child("y").text().as_double()};
}

bool is_of_part(pugi::xml_node node) {
  const std::string_view name = node.name();
  return node.type() == pugi::node_pi || node.type() == pugi::node_comment || name == "point" ||
         name == "predecessor" || name == "successor" || name == "adjacentLeft" ||
         name == "adjacentRight" || name == "stopLine";
}

/// A part of a lanelet, and then all parts that go on from it.
struct Chain {
  std::vector<SourcedLanelet> parts;
  LaneletSpan span;
  std::array<std::vector<pugi::xml_node>, 2> points;  ///< of both bounds, see LaneletSpan

  /// Where a row is, on the left or on the right.
  Vector2d at(std::size_t side, double row) const {
    const double begin = std::floor(span.from),
                 from = std::clamp(std::floor(row), span.from, span.to),
                 to = std::clamp(std::floor(row) + 1.0, span.from, span.to);
    const auto i = static_cast<std::size_t>(std::floor(row) - begin);
    const Vector2d a = place_of(points[side][std::min(i, points[side].size() - 1)]),
                   b = place_of(points[side][std::min(i + 1, points[side].size() - 1)]);
    return to > from ? Vector2d(a + (row - from) / (to - from) * (b - a)) : a;
  }
};

/// What two parts say but for their points and links.
bool are_alike(const Chain& a, const Chain& b) {
  const auto said = [](const Chain& chain) {
    std::vector<pugi::xml_node> all;
    for (const pugi::xml_node child : chain.parts.front().node.children()) {
      if (!is_of_part(child)) all.push_back(child);
    }
    return all;
  };
  return a.span.rows == b.span.rows &&
         std::ranges::equal(said(a), said(b), [](pugi::xml_node one, pugi::xml_node other) {
           return say_the_same(one, other, is_of_part);
         });
}

bool is_apart(const Chain& chain, const Chain& part) {
  return part.span.from > chain.span.to + kSameRow;
}

/// Whether a part, which begins no earlier than a chain and before its end, is where the chain is:
/// at the first and the last row that both have.
bool is_in_place(const Chain& chain, const Chain& part) {
  const double to = std::min(chain.span.to, part.span.to), from = std::min(part.span.from, to);
  for (const std::size_t side : {0u, 1u}) {
    for (const double row : {from, to}) {
      const Vector2d there = part.at(side, std::max(row, part.span.from));
      if (!((chain.at(side, row) - there).norm() <= kSamePlaceM)) return false;
    }
  }
  return true;
}

void append(Chain& chain, const Chain& part, std::vector<Seam>& seams) {
  chain.parts.push_back(part.parts.front());
  if (part.span.to <= chain.span.to) return;
  const Vector2d at = 0.5 * (part.at(0, part.span.from) + part.at(1, part.span.from));
  seams.push_back({"end of lanelet " + text(chain.parts[chain.parts.size() - 2].node, "id"),
                   "start of lanelet " + text(part.parts.front().node, "id"), 0.0, "joined", at.x(),
                   at.y()});
  for (const std::size_t side : {0u, 1u}) {
    std::vector<pugi::xml_node>& points = chain.points[side];
    if (std::floor(chain.span.to) < chain.span.to) points.pop_back();
    // Rows of the part that the chain has, and where the part begins between two.
    const double known = std::floor(chain.span.to) + 1.0 - std::floor(part.span.from);
    const auto& more = part.points[side];
    points.insert(points.end(), more.begin() + static_cast<std::ptrdiff_t>(known), more.end());
  }
  chain.span.to = part.span.to;
}

void write_bound(pugi::xml_node bound, const std::vector<pugi::xml_node>& points) {
  const std::vector<pugi::xml_node> old = children(bound, "point");
  for (const pugi::xml_node point : points) bound.insert_copy_before(point, old.front());
  for (const pugi::xml_node point : old) bound.remove_child(point);
}

/// Chains of parts of one lanelet, from its start on.
using Kind = std::vector<Chain>;

class LaneletJoiner {
 public:
  LaneletJoiner(const std::deque<commonroad::Document>& files, FreshIds& fresh, Merged& result)
      : files_(files), fresh_(fresh), result_(result) {}

  void join(std::vector<Chain> parts) {
    std::ranges::stable_sort(parts, {}, [](const Chain& part) { return part.span.from; });
    std::vector<Kind> kinds;
    for (const Chain& part : parts) {
      const auto kind = std::ranges::find_if(kinds, [&](Kind& one) { return take_in(one, part); });
      if (kind == kinds.end() && kinds.size() < kMostKinds) kinds.push_back({part});
    }
    for (const Kind& kind : kinds) settle(kind);
  }

  std::vector<JoinedLanelet> take() { return std::move(joined_); }

 private:
  bool take_in(Kind& kind, const Chain& part) {
    if (!are_alike(kind.front(), part)) return false;
    if (is_apart(kind.back(), part)) {
      kind.push_back(part);
      return true;
    }
    if (!is_in_place(kind.back(), part)) return false;
    append(kind.back(), part, result_.seams);
    return true;
  }

  void settle(const Kind& kind) {
    JoinedLanelet joined{kind.front().span.whole, {}};
    bool is_named = false;
    for (const Chain& chain : kind) {
      const auto has_id = [&](const SourcedLanelet& part) {
        return text(part.node, "id") == joined.id;
      };
      const bool has_name = std::ranges::any_of(chain.parts, has_id);
      auto [node, file] = *std::ranges::min_element(chain.parts, {}, &SourcedLanelet::source);
      if (has_name && !is_named) {
        set_text(node, "id", joined.id);
      } else if (text(node, "id") == joined.id) {
        set_text(node, "id", fresh_.fresh());
        result_.renamed.push_back(
            {files_[file].xml.name(), "lanelet", joined.id, text(node, "id")});
      }
      is_named = is_named || has_name;
      for (const SourcedLanelet& part : chain.parts) joined.files.insert(part.source);
      put_into(node, chain);
    }
    if (joined.files.size() > 1) joined_.push_back(std::move(joined));
  }

  static void put_into(pugi::xml_node node, const Chain& chain) {
    if (chain.parts.size() == 1) return;
    for (const std::size_t side : {0u, 1u})
      write_bound(node.child(kBounds[side]), chain.points[side]);
    remember_span(node, chain.span);
    for (const SourcedLanelet& part : chain.parts) {
      if (part.node != node) part.node.parent().remove_child(part.node);
    }
  }

  const std::deque<commonroad::Document>& files_;
  FreshIds& fresh_;
  Merged& result_;
  std::vector<JoinedLanelet> joined_;
};

}  // namespace

std::vector<JoinedLanelet> join_lanelets(const std::deque<commonroad::Document>& files,
                                         FreshIds& fresh, Merged& result) {
  std::map<std::string, std::vector<Chain>> parts;  // of lanelets that were cut
  for (const commonroad::Document& file : files) {
    for (const auto lanelet : file.lanelets()) {
      if (const auto span = remembered_span(lanelet)) parts[span->whole];
    }
  }
  if (parts.empty()) return {};
  for (std::size_t f = 0; f < files.size(); ++f) {
    for (const auto lanelet : files[f].lanelets()) {
      const LaneletSpan span = remembered_span(lanelet).value_or(all_rows(lanelet));
      const auto found = parts.find(span.whole);
      if (found == parts.end()) continue;
      Chain chain{{{lanelet, f}}, span, {}};
      for (const std::size_t side : {0u, 1u}) {
        chain.points[side] = children(lanelet.child(kBounds[side]), "point");
      }
      const auto& [left, right] = chain.points;
      if (left.size() >= 2 && left.size() == right.size())
        found->second.push_back(std::move(chain));
    }
  }
  LaneletJoiner joiner(files, fresh, result);
  for (auto& [whole, chains] : parts) joiner.join(std::move(chains));
  return joiner.take();
}

}  // namespace roadbed::map::edit::merging
