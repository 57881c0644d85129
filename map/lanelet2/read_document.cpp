#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lanelet2/document.h"

namespace roadbed::map::lanelet2 {
namespace {

constexpr std::int64_t kNoId = std::numeric_limits<std::int64_t>::min();
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// What memory is spent on, besides the text [bytes]: at worst, while a list grows.
struct Cost {
  static constexpr std::size_t node = 3 * sizeof(Node) + 3 * sizeof(NodePlace) + 16;
  static constexpr std::size_t other = 3 * std::max(sizeof(Way), sizeof(Relation)) + 16;
  static constexpr std::size_t child = 100;
  static constexpr std::size_t fault = 400;
};

// Whether a text is a literal; its length is known to the compiler, unlike that of a view.
template <std::size_t kSize>
bool equals(std::string_view text, const char (&literal)[kSize]) {
  return text.size() == kSize - 1 && std::memcmp(text.data(), literal, kSize - 1) == 0;
}

std::optional<MemberKind> member_kind(std::string_view name) {
  if (equals(name, "node")) return MemberKind::node;
  if (equals(name, "way")) return MemberKind::way;
  if (equals(name, "relation")) return MemberKind::relation;
  return {};
}

// Texts that came before stand for those that say the same: what is compared again and again stays
// in the cache, which the file does not.
class RepeatedTexts {
 public:
  std::string_view first_of(std::string_view text) {
    if (text.empty()) return text;
    std::uint64_t head = 0;
    std::memcpy(&head, text.data(), std::min(text.size(), sizeof head));
    std::string_view& known = known_[((head ^ text.size()) * 0x9E37'79B9'7F4A'7C15u) >> 54];
    if (known != text) known = text;
    return known;
  }

 private:
  std::array<std::string_view, 1024> known_{};
};

// Places in a list: the first one, and that behind the last.
struct Range {
  std::size_t from, to;
};

// A node before its place in the map is known.
struct RawNode {
  NodePlace place{kNothing, kNothing, kNothing, kNothing};
  double elevation_m = 0.0;
};

class DocumentReader {
 public:
  DocumentReader(std::string bytes, const std::string& name, int threads)
      : threads_(threads),
        document_(std::move(bytes), name),
        scanner_(document_.scanner),
        budget_(128'000'000 + 6 * document_.text.size()) {
    if (document_.text.size() > 0xffff'ffff) refuse("more than 4 GB");
  }

  Document read() {
    scanner_.next();
    crs_ = scanner_.value("crs");
    make_room();
    each_child([&] { add(); });
    scanner_.expect_end();
    place_nodes();
    document_.node_index = index_of(document_.nodes, "node");
    document_.way_nodes.reserve(refs_.size());
    for (std::size_t i = 0; i < document_.ways.size(); ++i) add_way_nodes(i);
    hand_out(document_.ways, way_tags_);
    hand_out(document_.relations, relation_tags_);
    hand_out_members();
    document_.way_index = index_of(document_.ways, "way");
    document_.relation_index = index_of(document_.relations, "relation");
    return std::move(document_);
  }

 private:
  [[noreturn]] void refuse(const char* found) const {
    throw InputError({.file = document_.name,
                      .found = found,
                      .needed = "a map with content of its size",
                      .remedy = "check whether it is the right file"});
  }

  // For as many elements as files of that size have; what is not used is never touched.
  void make_room() {
    const std::size_t size = document_.text.size();
    document_.nodes.reserve(size / 160);
    document_.places.reserve(size / 160);
    refs_.reserve(size / 80);
    document_.tags.reserve(size / 160);
  }

  // Calls `f` at the start of each child of the element that has just started, goes to its end.
  template <typename F>
  void each_child(const F& f) {
    const std::size_t depth = scanner_.depth();
    while (scanner_.next() == XmlScanner::Event::start) {
      f();
      if (scanner_.depth() > depth) scanner_.skip();
    }
  }

  void spend(std::size_t bytes) {
    if (bytes > budget_) refuse("next to nothing but empty elements");
    budget_ -= bytes;
  }

  ImportDiagnostic& fault(std::size_t at, const char* rule, std::string message) {
    spend(Cost::fault);
    return document_.fault(at, rule, std::move(message));
  }

  void add() {
    if (scanner_.value("action") == "delete") return;  // so editors (JOSM) mark what is gone
    const std::string_view name = scanner_.name();
    const std::optional<MemberKind> kind = member_kind(name);
    if (!kind) {
      if (name != "bounds") ++document_.unused["osm/" + std::string(name)];
      return;
    }
    const std::optional<std::int64_t> id = id_in(scanner_.value("id"));
    spend(kind == MemberKind::node ? Cost::node : Cost::other);
    if (!id) {
      fault(scanner_.offset(), "import.id", "its id is not a whole number and it is left out");
    } else if (kind == MemberKind::node) {
      add_node(*id);
    } else if (kind == MemberKind::way) {
      add_way(*id);
    } else {
      add_relation(*id);
    }
  }

  void add_node(std::int64_t id) {
    const std::size_t at = scanner_.offset();
    RawNode raw;
    raw.place.latitude_deg = number_in(scanner_.value("lat"));
    raw.place.longitude_deg = number_in(scanner_.value("lon"));
    each_child([&] { read_node_tag(raw); });
    if (!(std::abs(raw.elevation_m) < 1e5)) {
      if (bad_elevations_++ == 0) first_bad_elevation_ = at;
      raw.elevation_m = 0.0;
    }
    document_.nodes.push_back({id, {0, 0, raw.elevation_m}, false, at});
    document_.places.push_back(raw.place);
  }

  void read_node_tag(RawNode& raw) {
    const std::string_view key = scanner_.value("k"), value = scanner_.value("v");
    if (equals(key, "local_x")) {
      raw.place.local_x_m = number_in(value);
    } else if (equals(key, "local_y")) {
      raw.place.local_y_m = number_in(value);
    } else if (equals(key, "ele")) {
      raw.elevation_m = number_in(value);
    } else if (equals(key, "mgrs_code") && mgrs_code_.empty()) {
      mgrs_code_ = value;
    }
  }

  void add_way(std::int64_t id) {
    Way way;
    way.id = id;
    way.at = scanner_.offset();
    refs_begin_.push_back(refs_.size());
    const std::size_t tags_begin = document_.tags.size();
    each_child([&] {
      if (equals(scanner_.name(), "nd")) {
        refs_.push_back(id_in(scanner_.value("ref")).value_or(kNoId));
      } else if (equals(scanner_.name(), "tag")) {
        add_tag(way);
      }
    });
    way_tags_.push_back({tags_begin, document_.tags.size()});
    document_.ways.push_back(way);
  }

  // Keeps it, and the first `type` and `subtype` once more.
  template <typename Element>
  void add_tag(Element& element) {
    spend(Cost::child);
    const std::string_view key = texts_.first_of(scanner_.value("k")),
                           value = texts_.first_of(scanner_.value("v"));
    if (equals(key, "type") && element.type.data() == nullptr) element.type = value;
    if (equals(key, "subtype") && element.subtype.data() == nullptr) element.subtype = value;
    document_.tags.emplace_back(key, value);
  }

  void add_relation(std::int64_t id) {
    Relation relation{id, {}, {}, {}, {}, scanner_.offset()};
    const std::size_t tags_begin = document_.tags.size();
    each_child([&] {
      if (equals(scanner_.name(), "member")) {
        add_member();
      } else if (equals(scanner_.name(), "tag")) {
        add_tag(relation);
      }
    });
    relation_tags_.push_back({tags_begin, document_.tags.size()});
    members_end_.push_back(document_.members.size());
    document_.relations.push_back(relation);
  }

  void add_member() {
    spend(Cost::child);
    const std::optional<MemberKind> kind = member_kind(scanner_.value("type"));
    const std::optional<std::int64_t> ref = id_in(scanner_.value("ref"));
    if (!kind || !ref) {
      fault(scanner_.offset(), "import.reference", "names no node, way or relation");
      return;
    }
    document_.members.push_back({*kind, *ref, texts_.first_of(scanner_.value("role"))});
  }

  // Gives elements their tags, when the list of all tags grows no more.
  template <typename Element>
  void hand_out(std::vector<Element>& elements, const std::vector<Range>& ranges) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      elements[i].tags =
          Tags(document_.tags).subspan(ranges[i].from, ranges[i].to - ranges[i].from);
    }
  }

  void hand_out_members() {
    std::size_t from = 0;
    for (std::size_t i = 0; i < members_end_.size(); ++i) {
      document_.relations[i].members =
          std::span<const Member>(document_.members).subspan(from, members_end_[i] - from);
      from = members_end_[i];
    }
  }

  // Positions relative to a local origin, a whole number of kilometres in the file's coordinates.
  void place_nodes() {
    const std::vector<NodePlace>& places = document_.places;
    const Frame frame(places, mgrs_code_, threads_);
    // A file that roadbed wrote says in its root what the local coordinates are.
    document_.crs = frame.is_local() && !crs_.empty() ? crs_ : frame.crs();
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
    if (bad_elevations_ > 0) {
      document_.fault(first_bad_elevation_, "import.elevation",
                      fmt::format("{} nodes, this one first, have an elevation that is no height "
                                  "on earth; 0 is used",
                                  bad_elevations_));
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

  void add_way_nodes(std::size_t index) {
    Way& way = document_.ways[index];
    const std::size_t begin = refs_begin_[index];
    const std::size_t end = index + 1 < refs_begin_.size() ? refs_begin_[index + 1] : refs_.size();
    std::size_t first_lost = end;
    way.references = static_cast<std::uint32_t>(end - begin);
    const std::size_t nodes_begin = document_.way_nodes.size();
    for (std::size_t i = begin; i < end; ++i) {
      const auto place =
          refs_[i] == kNoId ? std::nullopt : document_.node_index.find_near(refs_[i], near_);
      if (place && document_.nodes[*place].placed) {
        document_.way_nodes.push_back(*place);
        continue;
      }
      if (first_lost == end) first_lost = i;
      if (!place && way.missing++ == 0) way.first_missing = static_cast<std::uint32_t>(i - begin);
    }
    way.nodes = std::span<const std::uint32_t>(document_.way_nodes).subspan(nodes_begin);
    if (first_lost == end) return;
    fault(way.at, "import.reference",
          fmt::format("{} of its nodes, first {}, are not there or have no place",
                      way.references - way.nodes.size(),
                      document_.written_reference(way, first_lost - begin)))
        .in_text = way.missing > 0;
  }

  template <typename Element>
  IdIndex index_of(const std::vector<Element>& elements, const char* kind) {
    std::vector<std::pair<std::int64_t, std::uint32_t>> ids;
    ids.reserve(elements.size());
    for (const Element& element : elements) {
      ids.emplace_back(element.id, static_cast<std::uint32_t>(ids.size()));
    }
    IdIndex index(std::move(ids));
    if (index.repeated() > 0) {
      document_.remarks.push_back(
          {"import.duplicate-id", true, "file", 0,
           fmt::format("{} {}s have an id that came before; the first of each is used",
                       index.repeated(), kind)});
    }
    return index;
  }

  int threads_;
  Document document_;
  XmlScanner& scanner_;  // the document's
  std::size_t budget_;   // of memory [bytes]
  RepeatedTexts texts_;
  std::vector<std::int64_t> refs_;               // to the nodes of all ways
  std::vector<std::size_t> refs_begin_;          // those of each way
  std::vector<Range> way_tags_, relation_tags_;  // of the tags of each
  std::vector<std::size_t> members_end_;         // of those of each relation
  std::size_t near_ = 0;                         // where the last node was found
  std::string mgrs_code_, crs_;
  std::size_t bad_elevations_ = 0;
  std::size_t first_bad_elevation_ = 0;
};

}  // namespace

Document read_document(std::string bytes, const std::string& name, int threads) {
  return DocumentReader(std::move(bytes), name, threads).read();
}

}  // namespace roadbed::map::lanelet2
