#include "roadbed/map/lanelet2/document.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lanelet2/frame.h"

namespace roadbed::map::lanelet2 {
namespace {

constexpr std::int64_t kNoId = std::numeric_limits<std::int64_t>::min();
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// What memory is spent on, besides the text [bytes]: at worst, while a list grows.
struct Cost {
  static constexpr std::size_t node = 3 * sizeof(Node) + 3 * sizeof(NodePlace) + 16;
  static constexpr std::size_t other = 3 * sizeof(Relation) + 16;
  static constexpr std::size_t child = 100;
  static constexpr std::size_t fault = 400;
};

std::optional<std::int64_t> id_in(std::string_view text) {
  std::int64_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return id;
}

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

// Places in a list: the first one, and that behind the last.
struct Range {
  std::size_t from, to;
};

// A number as most are written: a sign, digits, a point, digits. With at most 15 digits both the
// whole number that they are and the power of ten that divides it are exact, so that the quotient
// is the nearest double; none if the text is of another form.
std::optional<double> plain_decimal(std::string_view text) {
  constexpr std::array<double, 16> kPowers = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                              1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  if (text.empty() || text.size() > 16) return {};
  std::int64_t digits = 0;
  std::size_t point = text.size();
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto digit = static_cast<unsigned>(text[i] - '0');
    if (digit <= 9) {
      digits = 10 * digits + digit;
    } else if (text[i] == '.' && point == text.size()) {
      point = i;
    } else {
      return {};
    }
  }
  const bool has_point = point != text.size();
  const std::size_t decimals = has_point ? text.size() - point - 1 : 0;
  if (text.size() - (has_point ? 1 : 0) > 15 || point == 0 || (has_point && decimals == 0))
    return {};
  const double value = static_cast<double>(digits) / kPowers[decimals];
  return negative ? -value : value;
}

// A node before its place in the map is known.
struct RawNode {
  NodePlace place{kNothing, kNothing, kNothing, kNothing};
  double elevation_m = 0.0;
};

class DocumentReader {
 public:
  DocumentReader(const std::string& bytes, const std::string& name)
      : document_(bytes, name),
        scanner_(document_.scanner),
        budget_(128'000'000 + 6 * bytes.size()) {
    if (bytes.size() > 0xffff'ffff) refuse("more than 4 GB");
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
    places_.reserve(size / 160);
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

  void fault(std::size_t at, const char* rule, std::string message) {
    spend(Cost::fault);
    document_.fault(at, rule, std::move(message));
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
    places_.push_back(raw.place);
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
    const std::string_view key = scanner_.value("k"), value = scanner_.value("v");
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
    document_.members.push_back({*kind, *ref, scanner_.value("role")});
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
    const Frame frame(places_, mgrs_code_);
    // A file that roadbed wrote says in its root what the local coordinates are.
    document_.crs = frame.is_local() && !crs_.empty() ? crs_ : frame.crs();
    if (document_.crs.empty() && !frame.doubt().empty()) {
      document_.remarks.push_back(
          {"import.crs-unknown", false, "file", 0, frame.doubt() + "; its CRS is unknown"});
    }
    bool first = true;
    std::size_t lost = 0;
    std::size_t example = 0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const auto position = frame.place(places_[i]);
      Node& node = document_.nodes[i];
      if (!position) {
        if (lost++ == 0) example = node.at;
        continue;
      }
      if (first) document_.origin_in_source = (*position / 1000.0).array().round() * 1000.0;
      first = false;
      node.in_map.head<2>() = *position - document_.origin_in_source;
      node.placed = true;
    }
    if (lost > 0) {
      document_.fault(example, "import.node-position",
                      fmt::format("{} nodes, this one first, have no usable coordinates", lost));
    }
    if (bad_elevations_ > 0) {
      document_.fault(first_bad_elevation_, "import.elevation",
                      fmt::format("{} nodes, this one first, have an elevation that is no height "
                                  "on earth; 0 is used",
                                  bad_elevations_));
    }
    places_ = {};
  }

  void add_way_nodes(std::size_t index) {
    Way& way = document_.ways[index];
    const std::size_t begin = refs_begin_[index];
    const std::size_t end = index + 1 < refs_begin_.size() ? refs_begin_[index + 1] : refs_.size();
    std::size_t first_missing = end;
    const std::size_t nodes_begin = document_.way_nodes.size();
    for (std::size_t i = begin; i < end; ++i) {
      const auto place = document_.node_index.find_near(refs_[i], near_);
      if (place && document_.nodes[*place].placed && refs_[i] != kNoId) {
        document_.way_nodes.push_back(*place);
      } else if (first_missing == end) {
        first_missing = i;
      }
    }
    way.nodes = std::span<const std::uint32_t>(document_.way_nodes).subspan(nodes_begin);
    if (first_missing == end) return;
    fault(way.at, "import.reference",
          fmt::format("{} of its nodes, first {}, are not there or have no place",
                      end - begin - way.nodes.size(), written_ref(way, first_missing - begin)));
  }

  // How the text names a way's node.
  std::string written_ref(const Way& way, std::size_t index) const {
    XmlScanner scanner(document_.text, document_.name, way.at);
    std::size_t behind = index + 1;
    for (auto event = scanner.next(); event != XmlScanner::Event::done; event = scanner.next()) {
      const bool is_node =
          event == XmlScanner::Event::start && scanner.depth() == 2 && scanner.name() == "nd";
      if (is_node && --behind == 0) return std::string(scanner.value("ref"));
    }
    return {};
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

  Document document_;
  XmlScanner& scanner_;  // the document's
  std::size_t budget_;   // of memory [bytes]
  std::vector<NodePlace> places_;
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

std::vector<Eigen::Vector3d> Document::points(const Way& way) const {
  std::vector<Eigen::Vector3d> found;
  found.reserve(way.nodes.size());
  for (const std::uint32_t node : way.nodes) found.push_back(nodes[node].in_map);
  return found;
}

Attributes attributes_of(Tags tags) { return {tags.begin(), tags.end()}; }

std::vector<Tag> views_of(const Attributes& tags) { return {tags.begin(), tags.end()}; }

Attributes Document::tags_of(std::size_t at) const {
  XmlScanner element(text, name, at);
  Attributes found;
  for (auto event = element.next(); event != XmlScanner::Event::done; event = element.next()) {
    if (event == XmlScanner::Event::start && element.depth() == 2 && element.name() == "tag") {
      found.emplace_back(element.value("k"), element.value("v"));
    }
  }
  return found;
}

void Document::fault(std::size_t at, const char* rule, std::string message) {
  if (!line_starts_) line_starts_.emplace(text);
  XmlScanner element(text, name, at);
  element.next();
  remarks.push_back({rule, true, fmt::format("{} {}", element.name(), element.value("id")),
                     line_starts_->line_at(at), std::move(message)});
}

Document read_document(const std::string& bytes, const std::string& name) {
  return DocumentReader(bytes, name).read();
}

double number_in(std::string_view text) {
  if (const std::optional<double> plain = plain_decimal(text)) return *plain;
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return kNothing;
  }
  return value;
}

}  // namespace roadbed::map::lanelet2
