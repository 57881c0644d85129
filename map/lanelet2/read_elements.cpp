#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <utility>

#include "roadbed/map/files/in_threads.h"
#include "roadbed/map/files/input_error.h"
#include "roadbed/map/lanelet2/element_lists.h"

namespace roadbed::map::lanelet2 {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kLeastStretch = 2'000'000;  // that is worth a thread [bytes]

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

// For as many elements as texts of that size have; what is not used is never touched.
void make_room(std::size_t text_size, ElementLists& lists) {
  lists.nodes.reserve(text_size / 160);
  lists.places.reserve(text_size / 160);
  lists.refs.reserve(text_size / 80);
  lists.tags.reserve(text_size / 160);
}

// The elements that a scanner comes to inside the text's first.
class ElementReader {
 public:
  ElementReader(const Document& document, XmlScanner& scanner, ElementLists& lists)
      : document_(document), scanner_(scanner), lists_(lists) {}

  // Up to the end of the first, or of the stretch: which of the two.
  XmlScanner::Event read() {
    for (;;) {
      const XmlScanner::Event event = scanner_.next();
      if (event != XmlScanner::Event::start) return event;
      const std::size_t outside = scanner_.depth() - 1;
      add();
      if (scanner_.depth() > outside) scanner_.skip();
    }
  }

 private:
  // Calls `f` at the start of each child of the element that has just started, goes to its end.
  template <typename F>
  void each_child(const F& f) {
    const std::size_t depth = scanner_.depth();
    while (scanner_.next() == XmlScanner::Event::start) {
      f();
      if (scanner_.depth() > depth) scanner_.skip();
    }
  }

  void spend(std::size_t bytes) { lanelet2::spend(bytes, lists_.left_bytes, document_.name); }

  void fault(std::size_t at, const char* rule, std::string message) {
    spend(ElementCost::fault);
    lists_.remarks.push_back(document_.fault_at(at, rule, std::move(message)));
  }

  void add() {
    if (scanner_.value("action") == "delete") return;  // so editors (JOSM) mark what is gone
    const std::string_view name = scanner_.name();
    const std::optional<MemberKind> kind = member_kind(name);
    if (!kind) {
      if (name != "bounds") ++lists_.unused["osm/" + std::string(name)];
      return;
    }
    const std::optional<std::int64_t> id = id_in(scanner_.value("id"));
    spend(kind == MemberKind::node ? ElementCost::node : ElementCost::other);
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
    NodePlace place{kNothing, kNothing, kNothing, kNothing};
    double elevation_m = 0.0;
    place.latitude_deg = number_in(scanner_.value("lat"));
    place.longitude_deg = number_in(scanner_.value("lon"));
    each_child([&] { read_node_tag(place, elevation_m); });
    if (!(std::abs(elevation_m) < 1e5)) {
      if (lists_.bad_elevations++ == 0) lists_.first_bad_elevation_at = at;
      elevation_m = 0.0;
    }
    lists_.nodes.push_back({id, {0, 0, elevation_m}, false, at});
    lists_.places.push_back(place);
  }

  void read_node_tag(NodePlace& place, double& elevation_m) {
    const std::string_view key = scanner_.value("k"), value = scanner_.value("v");
    if (equals(key, "local_x")) {
      place.local_x_m = number_in(value);
    } else if (equals(key, "local_y")) {
      place.local_y_m = number_in(value);
    } else if (equals(key, "ele")) {
      elevation_m = number_in(value);
    } else if (equals(key, "mgrs_code") && lists_.mgrs_code.empty()) {
      lists_.mgrs_code = value;
    }
  }

  void add_way(std::int64_t id) {
    Way way;
    way.id = id;
    way.at = scanner_.offset();
    const std::size_t refs_begin = lists_.refs.size(), tags_begin = lists_.tags.size();
    each_child([&] {
      if (equals(scanner_.name(), "nd")) {
        lists_.refs.push_back(id_in(scanner_.value("ref")).value_or(ElementLists::kNoId));
      } else if (equals(scanner_.name(), "tag")) {
        add_tag(way);
      }
    });
    lists_.way_refs.push_back({refs_begin, lists_.refs.size()});
    lists_.way_tags.push_back({tags_begin, lists_.tags.size()});
    lists_.ways.push_back(way);
  }

  // Keeps it, and the first `type` and `subtype` once more.
  template <typename Element>
  void add_tag(Element& element) {
    spend(ElementCost::child);
    const std::string_view key = texts_.first_of(scanner_.value("k")),
                           value = texts_.first_of(scanner_.value("v"));
    if (equals(key, "type") && element.type.data() == nullptr) element.type = value;
    if (equals(key, "subtype") && element.subtype.data() == nullptr) element.subtype = value;
    lists_.tags.emplace_back(key, value);
  }

  void add_relation(std::int64_t id) {
    Relation relation{id, {}, {}, {}, {}, scanner_.offset()};
    const std::size_t members_begin = lists_.members.size(), tags_begin = lists_.tags.size();
    each_child([&] {
      if (equals(scanner_.name(), "member")) {
        add_member();
      } else if (equals(scanner_.name(), "tag")) {
        add_tag(relation);
      }
    });
    lists_.relation_tags.push_back({tags_begin, lists_.tags.size()});
    lists_.relation_members.push_back({members_begin, lists_.members.size()});
    lists_.relations.push_back(relation);
  }

  void add_member() {
    spend(ElementCost::child);
    const std::optional<MemberKind> kind = member_kind(scanner_.value("type"));
    const std::optional<std::int64_t> ref = id_in(scanner_.value("ref"));
    if (!kind || !ref) {
      fault(scanner_.offset(), "import.reference", "names no node, way or relation");
      return;
    }
    lists_.members.push_back({*kind, *ref, texts_.first_of(scanner_.value("role"))});
  }

  const Document& document_;
  XmlScanner& scanner_;
  ElementLists& lists_;
  RepeatedTexts texts_;
};

std::size_t memory_for(const Document& document) { return 128'000'000 + 6 * document.text.size(); }

template <typename T>
void append(std::vector<T>&& from, std::vector<T>& to) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

void append(const std::vector<ElementLists::Range>& from, std::size_t shift,
            std::vector<ElementLists::Range>& to) {
  for (const auto& [begin, end] : from) to.push_back({begin + shift, end + shift});
}

void append(ElementLists&& from, ElementLists& to) {
  append(from.way_refs, to.refs.size(), to.way_refs);
  append(from.way_tags, to.tags.size(), to.way_tags);
  append(from.relation_tags, to.tags.size(), to.relation_tags);
  append(from.relation_members, to.members.size(), to.relation_members);
  append(std::move(from.nodes), to.nodes);
  append(std::move(from.places), to.places);
  append(std::move(from.ways), to.ways);
  append(std::move(from.refs), to.refs);
  append(std::move(from.relations), to.relations);
  append(std::move(from.tags), to.tags);
  append(std::move(from.members), to.members);
  append(std::move(from.remarks), to.remarks);
  for (const auto& [name, count] : from.unused) to.unused[name] += count;
  if (to.mgrs_code.empty()) to.mgrs_code = std::move(from.mgrs_code);
  if (to.bad_elevations == 0) to.first_bad_elevation_at = from.first_bad_elevation_at;
  to.bad_elevations += from.bad_elevations;
  to.left_bytes += from.left_bytes;
}

// Reads the text in one go.
ElementLists read_whole(Document& document) {
  ElementLists lists;
  lists.left_bytes = memory_for(document);
  make_room(document.text.size(), lists);
  document.scanners.emplace_back(document.text, document.name);
  XmlScanner& scanner = document.scanners.back();
  scanner.next();
  lists.crs = scanner.value("crs");
  ElementReader(document, scanner, lists).read();
  scanner.expect_end();
  return lists;
}

// Where the first element of a file's own kinds begins, from a place on; the text's end: nowhere.
std::size_t element_at(std::string_view text, std::size_t from) {
  for (std::size_t at = text.find('<', from); at != text.npos; at = text.find('<', at + 1)) {
    const std::string_view rest = text.substr(at + 1, 9);
    if (rest.starts_with("node ") || rest.starts_with("way ") || rest.starts_with("relation ")) {
      return at;
    }
  }
  return text.size();
}

std::vector<XmlScanner::Stretch> stretches_of(std::string_view text, std::size_t count) {
  std::vector<XmlScanner::Stretch> stretches;
  std::size_t from = 0;
  for (std::size_t i = 1; i <= count; ++i) {
    const std::size_t to =
        i < count ? element_at(text, std::max(from, text.size() / count * i)) : text.size();
    if (to > from) stretches.push_back({from, to, {}});
    from = to;
  }
  return stretches;
}

// Whether all stretches are whole, each read into the list of its number.
bool read_stretches(Document& document, const std::vector<XmlScanner::Stretch>& stretches,
                    int threads, std::vector<ElementLists>& lists) {
  for (const XmlScanner::Stretch& stretch : stretches) {
    document.scanners.emplace_back(document.text, document.name, stretch);
  }
  std::atomic<bool> are_whole = true;
  try {
    in_threads(stretches.size(), threads, [&](std::size_t i) {
      XmlScanner& scanner = document.scanners[i];
      const bool is_last = i + 1 == stretches.size();
      make_room(i == 0 ? document.text.size() : stretches[i].to - stretches[i].from, lists[i]);
      lists[i].left_bytes = memory_for(document) / stretches.size();
      if (i == 0) scanner.next();
      const auto end = ElementReader(document, scanner, lists[i]).read();
      if ((end == XmlScanner::Event::end) != is_last) are_whole = false;  // more follows the first
      if (is_last) scanner.expect_end();
    });
  } catch (const InputError&) {  // what is wrong is said by who reads it in one go
    return false;
  }
  return are_whole;
}

// Reads the text in stretches that begin where an element seems to. That they are all whole proves
// that it was one, and no text of a comment; none, if they are not.
std::optional<ElementLists> read_in_stretches(Document& document, std::size_t count, int threads) {
  std::vector<XmlScanner::Stretch> stretches = stretches_of(document.text, count);
  XmlScanner first(document.text, document.name);
  first.next();
  for (std::size_t i = 1; i < stretches.size(); ++i) stretches[i].inside = first.name();
  std::vector<ElementLists> lists(stretches.size());
  if (!read_stretches(document, stretches, threads, lists)) {
    document.scanners.clear();
    return std::nullopt;
  }
  for (std::size_t i = 1; i < lists.size(); ++i) append(std::move(lists[i]), lists[0]);
  lists[0].crs = first.value("crs");
  return std::move(lists[0]);
}

}  // namespace

void spend(std::size_t bytes, std::size_t& left_bytes, const std::string& file) {
  if (bytes > left_bytes) {
    throw InputError({.file = file,
                      .found = "next to nothing but empty elements",
                      .needed = "a map with content of its size",
                      .remedy = "check whether it is the right file"});
  }
  left_bytes -= bytes;
}

ElementLists read_elements(Document& document, int threads) {
  if (document.text.size() > 0xffff'ffff) {
    throw InputError({.file = document.name,
                      .found = "more than 4 GB",
                      .needed = "a map with content of its size",
                      .remedy = "check whether it is the right file"});
  }
  const std::size_t count = std::min(static_cast<std::size_t>(std::max(1, threads)),
                                     document.text.size() / kLeastStretch);
  if (count > 1) {
    if (auto lists = read_in_stretches(document, count, threads)) return std::move(*lists);
  }
  return read_whole(document);
}

}  // namespace roadbed::map::lanelet2
