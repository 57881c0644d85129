#include "roadbed/map/edit/clipping/osm_part.h"

#include <algorithm>
#include <limits>

#include "roadbed/map/files/xml_places.h"

namespace roadbed::map::inline edit::inline clipping {
namespace {

constexpr std::string_view kBlanksBehind = " \t\r\n";

std::string_view without_blanks_behind(std::string_view text) {
  return text.substr(0, text.find_last_not_of(kBlanksBehind) + 1);
}

}  // namespace

OsmLayout::OsmLayout(const lanelet2::Document& document) : text_(document.text) {
  const auto add = [&](const auto& elements) {
    for (const auto& element : elements) {
      elements_.push_back({element.at, element.at + xml_element_at(text_, element.at).size()});
    }
  };
  add(document.nodes);
  add(document.ways);
  add(document.relations);
  std::ranges::sort(elements_, {}, &Place::at);
  for (std::size_t i = 0; i <= elements_.size(); ++i) {
    if (!without_blanks_behind(gap(i)).empty()) said_gaps_.push_back(i);
  }
  std::size_t last = 0;
  const auto set_last = [&](lanelet2::MemberKind kind, const auto& elements) {
    if (!elements.empty()) last = std::max(last, index_of(elements.back().at));
    last_.at(static_cast<std::size_t>(kind)) = last;
  };
  set_last(lanelet2::MemberKind::node, document.nodes);
  set_last(lanelet2::MemberKind::way, document.ways);
  set_last(lanelet2::MemberKind::relation, document.relations);
}

std::size_t OsmLayout::index_of(std::size_t at) const {
  const auto found = std::ranges::lower_bound(elements_, at, {}, &Place::at);
  return static_cast<std::size_t>(found - elements_.begin());
}

std::string_view OsmLayout::gap(std::size_t i) const {
  return between(i == 0 ? 0 : elements_[i - 1].end, i == count() ? text_.size() : elements_[i].at);
}

void OsmPart::keep(std::size_t at, std::string text) {
  kept_.emplace_back(layout_.index_of(at), std::move(text));
}

void OsmPart::add(lanelet2::MemberKind kind, const std::string& text) {
  added_.at(static_cast<std::size_t>(kind)) += "\n  " + text;
}

// Goes from one place to the next at which anything is written. Blanks before what is left out go
// with it.
std::string OsmPart::file() && {
  using enum lanelet2::MemberKind;
  std::ranges::stable_sort(kept_, {}, &std::pair<std::size_t, std::string>::first);
  std::vector<std::size_t> places = layout_.said_gaps();
  for (const auto& [index, text] : kept_) places.push_back(index);
  for (const auto kind : {node, way, relation}) places.push_back(layout_.last_of(kind) + 1);
  places.push_back(layout_.count());
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  std::string file;
  auto kept = kept_.begin();
  for (const std::size_t i : places) {
    for (const auto kind : {node, way, relation}) {
      if (layout_.last_of(kind) + 1 == i) file += added_.at(static_cast<std::size_t>(kind));
    }
    while (kept != kept_.end() && kept->first == i && std::next(kept) != kept_.end() &&
           std::next(kept)->first == i) {
      ++kept;
    }
    const bool stays = kept != kept_.end() && kept->first == i;
    file += stays || i == layout_.count() ? layout_.gap(i) : without_blanks_behind(layout_.gap(i));
    if (!stays) continue;
    file += kept->second.empty() ? layout_.element(i) : std::string_view(kept->second);
    ++kept;
  }
  return file;
}

}  // namespace roadbed::map::edit::clipping
