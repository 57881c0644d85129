#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/lanelet2/document.h"
#include "roadbed/map/lanelet2/element_lists.h"

namespace roadbed::map::lanelet2 {
namespace {

constexpr std::size_t kWaysInARun = 4096;

class DocumentReader {
 public:
  DocumentReader(std::string bytes, const std::string& name, int threads)
      : threads_(threads), document_(std::move(bytes), name) {}

  Document read() {
    lists_ = read_elements(document_, threads_);
    document_.nodes = std::move(lists_.nodes);
    document_.places = std::move(lists_.places);
    document_.ways = std::move(lists_.ways);
    document_.relations = std::move(lists_.relations);
    document_.tags = std::move(lists_.tags);
    document_.members = std::move(lists_.members);
    document_.remarks = std::move(lists_.remarks);
    document_.unused = std::move(lists_.unused);
    place_nodes();
    make_indices();
    remark_repeated(document_.node_index, "node");
    add_way_nodes();
    remark_repeated(document_.way_index, "way");
    remark_repeated(document_.relation_index, "relation");
    return std::move(document_);
  }

 private:
  void make_indices() {
    in_threads(3, threads_, [&](std::size_t task) {
      if (task == 0) document_.node_index = index_of(document_.nodes);
      if (task == 1) {
        hand_out(document_.ways, lists_.way_tags);
        document_.way_index = index_of(document_.ways);
      }
      if (task == 2) {
        hand_out(document_.relations, lists_.relation_tags);
        hand_out_members();
        document_.relation_index = index_of(document_.relations);
      }
    });
  }

  // Gives elements their tags, when the list of all tags grows no more.
  template <typename Element>
  void hand_out(std::vector<Element>& elements, const std::vector<ElementLists::Range>& ranges) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      elements[i].tags =
          Tags(document_.tags).subspan(ranges[i].from, ranges[i].to - ranges[i].from);
    }
  }

  void hand_out_members() {
    for (std::size_t i = 0; i < document_.relations.size(); ++i) {
      const auto [from, to] = lists_.relation_members[i];
      document_.relations[i].members =
          std::span<const Member>(document_.members).subspan(from, to - from);
    }
  }

  // Positions relative to a local origin, a whole number of kilometres in the file's coordinates.
  void place_nodes() {
    const std::vector<NodePlace>& places = document_.places;
    const Frame frame(places, lists_.mgrs_code, threads_);
    // A file that roadbed wrote says in its root what the local coordinates are.
    document_.crs = frame.is_local() && !lists_.crs.empty() ? lists_.crs : frame.crs();
    if (document_.crs.empty() && !frame.doubt().empty()) {
      document_.remarks.push_back(
          {"import.crs-unknown", false, "file", 0, frame.doubt() + "; its CRS is unknown"});
    }
    for (const NodePlace& place : places) {
      const auto position = frame.place(place);
      if (!position) continue;
      document_.origin_in_source = (*position / 1000.0).array().round() * 1000.0;
      break;
    }
    in_threads_by_runs(places.size(), threads_, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) {
        const auto position = frame.place(places[i]);
        if (!position) continue;
        document_.nodes[i].in_map.head<2>() = *position - document_.origin_in_source;
        document_.nodes[i].placed = true;
      }
    });
    remark_lost_nodes();
    if (lists_.bad_elevations > 0) {
      document_.fault(lists_.first_bad_elevation_at, "import.elevation",
                      fmt::format("{} nodes, this one first, have an elevation that is no height "
                                  "on earth; 0 is used",
                                  lists_.bad_elevations));
    }
  }

  void remark_lost_nodes() {
    const std::vector<Node>& nodes = document_.nodes;
    const auto first = std::ranges::find(nodes, false, &Node::placed);
    if (first == nodes.end()) return;
    const auto lost =
        std::count_if(first, nodes.end(), [](const Node& node) { return !node.placed; });
    document_
        .fault(first->at, "import.node-position",
               fmt::format("{} nodes, this one first, have no usable coordinates", lost))
        .in_text = !document_.places[static_cast<std::size_t>(first - nodes.begin())].is_on_earth();
  }

  /// What could not be found of a way's nodes.
  struct Lost {
    std::size_t way, first;
  };

  void add_way_nodes() {
    document_.way_nodes.resize(lists_.refs.size());
    const std::size_t ways = document_.ways.size();
    std::vector<std::vector<Lost>> lost((ways + kWaysInARun - 1) / kWaysInARun);
    in_threads(lost.size(), threads_, [&](std::size_t run) {
      std::size_t near = 0;  // where the last node was found
      const std::size_t end = std::min(ways, (run + 1) * kWaysInARun);
      for (std::size_t i = run * kWaysInARun; i < end; ++i) {
        if (const auto first = add_nodes_of(i, near)) lost[run].push_back({i, *first});
      }
    });
    for (const std::vector<Lost>& run : lost) {
      for (const Lost& one : run) remark(one);
    }
  }

  // Returns which of its references is the first that leads nowhere.
  std::optional<std::size_t> add_nodes_of(std::size_t index, std::size_t& near) {
    Way& way = document_.ways[index];
    const auto [begin, end] = lists_.way_refs[index];
    std::optional<std::size_t> first_lost;
    way.references = static_cast<std::uint32_t>(end - begin);
    std::size_t found = begin;
    for (std::size_t i = begin; i < end; ++i) {
      const std::int64_t ref = lists_.refs[i];
      const auto place =
          ref == ElementLists::kNoId ? std::nullopt : document_.node_index.find_near(ref, near);
      if (place && document_.nodes[*place].placed) {
        document_.way_nodes[found++] = *place;
        continue;
      }
      if (!first_lost) first_lost = i - begin;
      if (!place && way.missing++ == 0) way.first_missing = static_cast<std::uint32_t>(i - begin);
    }
    way.nodes = std::span<const std::uint32_t>(document_.way_nodes).subspan(begin, found - begin);
    return first_lost;
  }

  void remark(const Lost& lost) {
    const Way& way = document_.ways[lost.way];
    spend(ElementCost::fault, lists_.left_bytes, document_.name);
    document_
        .fault(way.at, "import.reference",
               fmt::format("{} of its nodes, first {}, are not there or have no place",
                           way.references - way.nodes.size(),
                           document_.written_reference(way, lost.first)))
        .in_text = way.missing > 0;
  }

  template <typename Element>
  static IdIndex index_of(const std::vector<Element>& elements) {
    std::vector<std::pair<std::int64_t, std::uint32_t>> ids;
    ids.reserve(elements.size());
    for (const Element& element : elements) {
      ids.emplace_back(element.id, static_cast<std::uint32_t>(ids.size()));
    }
    return IdIndex(std::move(ids));
  }

  void remark_repeated(const IdIndex& index, const char* kind) {
    if (index.repeated() == 0) return;
    document_.remarks.push_back(
        {"import.duplicate-id", true, "file", 0,
         fmt::format("{} {}s have an id that came before; the first of each is used",
                     index.repeated(), kind)});
  }

  int threads_;
  Document document_;
  ElementLists lists_;
};

}  // namespace

Document read_document(std::string bytes, const std::string& name, int threads) {
  return DocumentReader(std::move(bytes), name, threads).read();
}

}  // namespace roadbed::map::lanelet2
