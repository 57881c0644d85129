#include "roadbed/map/edit/osm_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "roadbed/map/files/xml_characters.h"
#include "roadbed/map/files/xml_places.h"
#include "roadbed/map/files/xml_scanner.h"

namespace roadbed::map::inline edit {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string value_of(std::string_view tag, std::string_view name) {
  const auto value = xml_value_in(tag, name);
  return value ? decode_xml(tag.substr(value->at, value->size)) : std::string();
}

bool is_plain(std::string_view value) {
  return std::ranges::all_of(value, [](unsigned char c) {
    return c > 0x20 && c < 0x7F && c != '&' && c != '<' && c != '>' && c != '"' && c != '\'';
  });
}

}  // namespace

OsmElement::OsmElement(std::string_view text) : name_(xml_tag_name(text, 0)) {
  std::size_t at = xml_tag_end(text, 0);
  const bool empty = text[at - 2] == '/';
  start_ = text.substr(0, at - (empty ? 2 : 1));
  while (!start_.empty() && kBlanks.find(start_.back()) != kBlanks.npos) start_.pop_back();
  if (const std::size_t quote = start_.find_first_of("'\""); quote != start_.npos) {
    quote_ = start_[quote];
  }
  if (empty) return;
  for (;;) {
    const std::size_t child = text.find('<', at);
    if (child == text.npos) break;
    const std::string_view blanks = text.substr(at, child - at);
    if (text[child + 1] == '/') {
      before_end_ = blanks;
      break;
    }
    if (children_.empty()) before_child_ = blanks;
    const bool is_comment = text.substr(child, 4) == "<!--";
    const std::string_view whole = is_comment
                                       ? text.substr(child, text.find("-->", child) + 3 - child)
                                       : xml_element_at(text, child);
    const std::string_view name = is_comment ? "!--" : xml_tag_name(text, child);
    children_.push_back({name, name == "tag" ? value_of(whole, "k") : "", whole});
    at = child + whole.size();
  }
}

void OsmElement::add_attribute(std::string_view name, std::string_view value,
                               std::string& text) const {
  ((text += ' ') += name) += '=';
  text += quote_;
  if (is_plain(value)) {
    text += value;
  } else {
    for (const char c : xml_text(value)) c == '\'' ? text += "&apos;" : text += c;
  }
  text += quote_;
}

void OsmElement::set_attribute(std::string_view name, std::string_view value) {
  if (const auto found = xml_value_in(start_, name)) {
    start_.replace(found->at, found->size, is_plain(value) ? value : xml_text(value));
  } else {
    add_attribute(name, value, start_);
  }
}

void OsmElement::put_first(std::vector<Child> children, std::string_view in_place_of) {
  std::erase_if(children_, [&](const Child& child) { return child.name == in_place_of; });
  children_.insert(children_.begin(), std::make_move_iterator(children.begin()),
                   std::make_move_iterator(children.end()));
}

void OsmElement::set_nodes(const std::vector<std::int64_t>& ids) {
  std::vector<Child> children;
  for (const std::int64_t id : ids) {
    std::string& text = made_.emplace_front("<nd");
    add_attribute("ref", std::to_string(id), text);
    children.push_back({"nd", "", text += " />"});
  }
  put_first(std::move(children), "nd");
}

void OsmElement::set_members(const std::vector<lanelet2::Member>& members) {
  using lanelet2::MemberKind;
  std::vector<Child> children;
  for (const lanelet2::Member& member : members) {
    const char* kind = member.kind == MemberKind::node  ? "node"
                       : member.kind == MemberKind::way ? "way"
                                                        : "relation";
    std::string& text = made_.emplace_front("<member");
    add_attribute("type", kind, text);
    add_attribute("ref", std::to_string(member.id), text);
    add_attribute("role", member.role, text);
    children.push_back({"member", "", text += " />"});
  }
  put_first(std::move(children), "member");
}

void OsmElement::remove_tag(std::string_view key) {
  std::erase_if(children_, [&](const Child& c) { return c.name == "tag" && c.key == key; });
}

void OsmElement::set_tag(std::string_view key, std::string_view value) {
  remove_tag(key);
  std::string& text = made_.emplace_front("<tag");
  add_attribute("k", key, text);
  add_attribute("v", value, text);
  children_.push_back({"tag", std::string(key), text += " />"});
}

std::string OsmElement::said() const {
  std::string said;
  for (const Child& child : children_) {
    const bool counts = child.name != "nd" && child.name != "member" && child.key != kClipKey;
    if (counts) said += child.text;
  }
  return said;
}

std::string OsmElement::text() const {
  if (children_.empty()) return start_ + " />";
  std::size_t size = start_.size() + before_end_.size() + name_.size() + 4;
  for (const Child& child : children_) size += before_child_.size() + child.text.size();
  std::string text;
  text.reserve(size);
  (text += start_) += '>';
  for (const Child& child : children_) (text += before_child_) += child.text;
  (((text += before_end_) += "</") += name_) += '>';
  return text;
}

void OsmEdit::add(lanelet2::MemberKind kind, const std::string& text) {
  std::string& list = kind == lanelet2::MemberKind::node  ? nodes_
                      : kind == lanelet2::MemberKind::way ? ways_
                                                          : relations_;
  list += "\n  " + text;
}

std::string OsmEdit::file() && {
  std::ranges::stable_sort(replaced_, {}, &Replacement::at);
  const std::string_view text = document_.text;
  // New elements stand behind the last one of their kind, or of the kind before.
  const auto last = [](const auto& elements, std::size_t before) {
    return elements.empty() ? before : std::max(before, elements.back().at);
  };
  const std::size_t root = text.find("<osm");
  const std::size_t node = last(document_.nodes, root), way = last(document_.ways, node),
                    relation = last(document_.relations, way);
  std::map<std::size_t, std::string> added;
  const auto behind = [&](std::size_t at) {
    return at == root ? xml_tag_end(text, root) : at + xml_element_at(text, at).size();
  };
  added[behind(node)] += nodes_;
  added[behind(way)] += ways_;
  added[behind(relation)] += relations_;

  std::string file;
  file.reserve(text.size() + nodes_.size() + ways_.size() + relations_.size());
  std::size_t cursor = 0;
  auto next_added = added.begin();
  const auto copy_to = [&](std::size_t to) {
    for (; next_added != added.end() && next_added->first <= to; ++next_added) {
      file += text.substr(cursor, next_added->first - cursor);
      cursor = next_added->first;
      file += next_added->second;
    }
    file += text.substr(cursor, to - cursor);
    cursor = to;
  };
  for (std::size_t i = 0; i < replaced_.size(); ++i) {
    const auto& [at, replacement] = replaced_[i];
    if (i + 1 < replaced_.size() && replaced_[i + 1].at == at) continue;
    copy_to(at);
    if (replacement.empty()) {  // the blanks before it go, too
      file.erase(file.find_last_not_of(kBlanks) + 1);
    }
    file += replacement;
    cursor = at + xml_element_at(text, at).size();
  }
  copy_to(text.size());
  return file;
}

std::string with_root_attribute(std::string file, std::string_view name, std::string_view value) {
  const std::size_t at = file.find("<osm"), end = xml_tag_end(file, at);
  const std::string alone = file.substr(at, end - at - 1) + "/>";
  OsmElement root(alone);
  root.set_attribute(name, value);
  const std::string tag = root.text();
  return file.replace(at, end - at, tag.substr(0, tag.size() - 3) + ">");
}

std::string text_of(std::span<const lanelet2::Member> members) {
  std::string text;
  for (const lanelet2::Member& member : members) {
    text += fmt::format("{}{}{}/{}", text.empty() ? "" : " ", "nwr"[static_cast<int>(member.kind)],
                        member.id, member.role);
  }
  return text;
}

std::optional<std::vector<lanelet2::Member>> members_in(std::string_view text) {
  std::vector<lanelet2::Member> members;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    const std::size_t kind = std::string_view("nwr").find(word.front()), slash = word.find('/');
    if (kind == std::string_view::npos || slash == std::string_view::npos) return {};
    const auto id = lanelet2::id_in(word.substr(1, slash - 1));
    if (!id) return {};
    members.push_back({static_cast<lanelet2::MemberKind>(kind), *id, word.substr(slash + 1)});
    text.remove_prefix(std::min(text.size(), word.size() + 1));
  }
  return members;
}

std::string_view tag_value(lanelet2::Tags tags, std::string_view key) {
  const auto found =
      std::find_if(tags.begin(), tags.end(), [&](const auto& tag) { return tag.first == key; });
  return found == tags.end() ? std::string_view() : found->second;
}

WaySpan span_of(const lanelet2::Way& way) {
  const std::string text(tag_value(way.tags, kClipKey));
  WaySpan span;
  long long whole = 0;
  const int read =
      std::sscanf(text.c_str(), "%lld %lf %lf %zu", &whole, &span.from, &span.to, &span.rows);
  span.whole = whole;
  if (read == 4 && span.rows < 100'000'000 && span.fits(way.nodes.size())) return span;
  return {{0.0, static_cast<double>(way.nodes.size()) - 1.0, way.nodes.size()}, way.id};
}

std::int64_t free_id(const lanelet2::Document& document) {
  std::int64_t most = 0;
  const auto look_at = [&](const auto& elements) {
    for (const auto& element : elements) most = std::max(most, element.id);
  };
  look_at(document.nodes);
  look_at(document.ways);
  look_at(document.relations);
  return most + 1;
}

}  // namespace roadbed::map::edit
