#include "roadbed/planning/route/hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace roadbed::planning::inline route {
namespace {

using Node = std::uint32_t;
constexpr Node kNone = 0xffffffffU;
constexpr double kLeastFraction = 0.25;
constexpr std::size_t kSmall = 3;

/// Neighbours without direction, each once.
CsrLists<Node> undirected(const RouteGraph& graph) {
  CsrLists<Node> rows;
  std::vector<Node> row;
  for (Node node = 0; node < graph.nodes(); ++node) {
    row.clear();
    for (Node i = graph.first_out[node]; i < graph.first_out[node + 1]; ++i) {
      row.push_back(graph.head[i]);
    }
    for (Node i = graph.first_in[node]; i < graph.first_in[node + 1]; ++i) {
      row.push_back(graph.tail[graph.in_arc[i]]);
    }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    std::erase(row, node);
    rows.items.insert(rows.items.end(), row.begin(), row.end());
    rows.end_list();
  }
  return rows;
}

class Dissection {
 public:
  Dissection(const RouteGraph& graph, const std::vector<Eigen::Vector2d>& places)
      : rows_(undirected(graph)),
        places_(places),
        part_(graph.nodes(), 0),
        index_(graph.nodes(), 0),
        match_(graph.nodes(), kNone),
        seen_(graph.nodes(), 0),
        order_(graph.nodes()) {
    for (Node node = 0; node < graph.nodes(); ++node) order_[node] = node;
  }

  std::vector<Node> run() && {
    // Depth first over ranges of the order, so that parts stay beside each other.
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, order_.size()}};
    while (!open.empty()) {
      const auto [first, last] = open.back();
      open.pop_back();
      if (last - first <= kSmall) continue;
      const auto [left_end, right_end] = split(first, last);
      open.push_back({first, left_end});
      open.push_back({left_end, right_end});
    }
    return std::move(order_);
  }

 private:
  struct Cut {
    std::size_t touching = std::numeric_limits<std::size_t>::max();
    std::size_t from_middle = 0;
    std::size_t at = 0;  ///< nodes before it
    std::size_t direction = 0;
  };

  void sort_along(std::span<Node> nodes, std::size_t direction) {
    static constexpr std::array<std::array<float, 2>, 4> kAlong = {
        {{1.0F, 0.0F}, {0.0F, 1.0F}, {0.7071F, 0.7071F}, {0.7071F, -0.7071F}}};
    keys_.clear();
    for (const Node node : nodes) {
      const auto x = static_cast<float>(places_[node].x()),
                 y = static_cast<float>(places_[node].y());
      keys_.push_back({kAlong[direction][0] * x + kAlong[direction][1] * y, node});
    }
    std::sort(keys_.begin(), keys_.end());
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = keys_[i].second;
  }

  // For each place along the sorted nodes, by how many more nodes before it touch one behind than
  // for the place before, and the other way round.
  void count_touching(std::span<const Node> nodes) {
    for (std::size_t i = 0; i < nodes.size(); ++i) index_[nodes[i]] = static_cast<Node>(i);
    from_left_.assign(nodes.size() + 1, 0);
    from_right_.assign(nodes.size() + 1, 0);
    for (Node i = 0; i < nodes.size(); ++i) {
      Node low = i, high = i;
      for (const Node other : rows_.of(nodes[i])) {
        if (part_[other] != round_) continue;
        low = std::min(low, index_[other]);
        high = std::max(high, index_[other]);
      }
      ++from_left_[i + 1];
      --from_left_[high + 1];
      ++from_right_[low + 1];
      --from_right_[i + 1];
    }
  }

  // The place along the sorted nodes at which fewest nodes of one side touch the other one.
  void improve(std::span<const Node> nodes, std::size_t direction, Cut& best) {
    count_touching(nodes);
    const auto low =
        static_cast<std::size_t>(std::max(1.0, kLeastFraction * static_cast<double>(nodes.size())));
    const std::size_t high = nodes.size() - low;
    std::int32_t left = 0, right = 0;
    for (std::size_t i = 0; i < high; ++i) {
      left += from_left_[i];
      right += from_right_[i];
      if (i < low) continue;
      const std::size_t from_middle =
          i > nodes.size() / 2 ? i - nodes.size() / 2 : nodes.size() / 2 - i;
      const auto touching = static_cast<std::size_t>(std::min(left, right));
      if (std::pair(touching, from_middle) < std::pair(best.touching, best.from_middle)) {
        best = {touching, from_middle, i, direction};
      }
    }
  }

  // Orders a range as left side, right side, separator; returns where the sides end.
  std::pair<std::size_t, std::size_t> split(std::size_t first, std::size_t last) {
    const std::span<Node> nodes(order_.data() + first, last - first);
    ++round_;
    for (const Node node : nodes) part_[node] = round_;
    Cut cut;
    for (std::size_t direction = 0; direction < 4; ++direction) {
      sort_along(nodes, direction);
      improve(nodes, direction, cut);
    }
    sort_along(nodes, cut.direction);
    for (std::size_t i = 0; i < nodes.size(); ++i) index_[nodes[i]] = static_cast<Node>(i);
    return separate(nodes, first, cut.at);
  }

  bool crosses(Node left, Node other, std::size_t at) const {
    return part_[other] == round_ && index_[left] < at && index_[other] >= at;
  }

  std::pair<std::size_t, std::size_t> separate(std::span<Node> nodes, std::size_t first,
                                               std::size_t at) {
    std::vector<Node> left;
    for (std::size_t i = 0; i < at; ++i) {
      for (const Node other : rows_.of(nodes[i])) {
        if (!crosses(nodes[i], other, at)) continue;
        left.push_back(nodes[i]);
        break;
      }
    }
    for (const Node node : left) {
      ++mark_;
      augment(node, at);
    }
    const std::vector<Node> cover = least_cover(left, at);
    for (const Node node : left) {
      for (const Node other : rows_.of(node)) {
        if (crosses(node, other, at)) match_[other] = kNone;
      }
      match_[node] = kNone;
    }
    for (const Node node : cover) part_[node] = 0;
    const auto outside = [&](Node node) { return part_[node] == round_; };
    const auto left_end = std::stable_partition(
        nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(at), outside);
    // The left side's part of the separator moves behind the right side.
    const auto right_begin =
        std::rotate(left_end, nodes.begin() + static_cast<std::ptrdiff_t>(at), nodes.end());
    const auto right_end = std::stable_partition(left_end, right_begin, outside);
    return {first + static_cast<std::size_t>(left_end - nodes.begin()),
            first + static_cast<std::size_t>(right_end - nodes.begin())};
  }

  // Kuhn's augmenting path from a node on the left of the cut. Recursion is as deep as the path.
  bool augment(Node node, std::size_t at) {
    for (const Node other : rows_.of(node)) {
      if (!crosses(node, other, at) || seen_[other] == mark_) continue;
      seen_[other] = mark_;
      if (match_[other] != kNone && !augment(match_[other], at)) continue;
      match_[other] = node;
      match_[node] = other;
      return true;
    }
    return false;
  }

  // König: of what alternating paths from unmatched nodes on the left reach, the right nodes, and
  // of the rest the left ones.
  std::vector<Node> least_cover(const std::vector<Node>& left, std::size_t at) {
    ++mark_;
    std::vector<Node> open, cover;
    for (const Node node : left) {
      if (match_[node] == kNone) open.push_back(node);
    }
    for (const Node node : open) seen_[node] = mark_;
    while (!open.empty()) {
      const Node node = open.back();
      open.pop_back();
      for (const Node other : rows_.of(node)) {
        if (!crosses(node, other, at) || seen_[other] == mark_) continue;
        seen_[other] = mark_;
        cover.push_back(other);
        const Node next = match_[other];
        if (next != kNone && seen_[next] != mark_) {
          seen_[next] = mark_;
          open.push_back(next);
        }
      }
    }
    for (const Node node : left) {
      if (seen_[node] != mark_) cover.push_back(node);
    }
    return cover;
  }

  CsrLists<Node> rows_;
  const std::vector<Eigen::Vector2d>& places_;
  std::vector<Node> part_, index_, match_, seen_;
  std::vector<Node> order_;
  std::vector<std::pair<float, Node>> keys_;
  std::vector<std::int32_t> from_left_, from_right_;
  Node round_ = 0, mark_ = 0;
};

}  // namespace

std::vector<std::uint32_t> dissection_order(const RouteGraph& graph,
                                            const std::vector<Eigen::Vector2d>& place_in_map) {
  return Dissection(graph, place_in_map).run();
}

}  // namespace roadbed::planning::route
