#include <fmt/format.h>

#include <deque>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/commonroad/document.h"
#include "roadbed/map/edit/lanelet_parts.h"
#include "roadbed/map/edit/merging/coordinate_systems.h"
#include "roadbed/map/edit/merging/lanelet_ends.h"
#include "roadbed/map/edit/merging/lanelet_joins.h"
#include "roadbed/map/edit/merging/merge.h"
#include "roadbed/map/edit/new_ids.h"
#include "roadbed/map/edit/xml_edit.h"

namespace roadbed::map::inline edit::inline merging {
namespace {

bool is_scenario_part(std::string_view name) {
  return name.ends_with("bstacle") || name == "planningProblem" || name == "phantomObstacle";
}

// What is of a lanelet's neighbours, or of how it was cut, is not of itself.
bool is_link(pugi::xml_node node) {
  const std::string_view name = node.name();
  return node.type() == pugi::node_pi || name == "predecessor" || name == "successor" ||
         name == "adjacentLeft" || name == "adjacentRight";
}

/// All elements with an `id`, from one on down.
std::vector<pugi::xml_node> named_elements(pugi::xml_node root) {
  std::vector<pugi::xml_node> open{root}, named;
  while (!open.empty()) {
    const pugi::xml_node node = open.back();
    open.pop_back();
    if (node.attribute("id")) named.push_back(node);
    for (const auto child : node.children()) {
      if (child.type() == pugi::node_element) open.push_back(child);
    }
  }
  return named;
}

class ScenarioMerger {
 public:
  explicit ScenarioMerger(std::deque<commonroad::Document>& files)
      : files_(files), root_(root_of(0)), names_(files.size()) {}

  void run(const MergeOptions& options, Merged& result) {
    join_parts(result);
    for (const auto node : named_elements(root_)) elements_.emplace(text(node, "id"), node);
    for (const auto node : root_.children()) {
      if (node.type() == pugi::node_element) last_[node.name()] = node;
    }
    for (const auto lanelet : root_.children("lanelet")) lanelets_.push_back({lanelet, 0});
    for (std::size_t f = 1; f < files_.size(); ++f) add_file(f, result);
    settle_links(result);
    link_lanelet_ends(files_.front().xml, lanelets_, options.tolerance_m, result.seams);
    result.count("elements taken once that several maps hold", repeated_);
    result.count("obstacles and planning problems of other time steps, left out", lost_);
  }

 private:
  pugi::xml_node root_of(std::size_t f) const { return files_[f].xml.root(); }

  // Lanelets that a clip cut, and links as they were before it.
  void join_parts(Merged& result) {
    for (const commonroad::Document& file : files_) {
      for (const auto node : named_elements(file.xml.root())) fresh_.take(text(node, "id"));
      recall_links(file.xml.root());
    }
    for (JoinedLanelet& joined : join_lanelets(files_, fresh_, result)) {
      joined_.insert({{*joined.files.begin(), joined.id}, std::move(joined.files)});
    }
  }

  void settle_links(Merged& result) {
    LaneletParts parts;
    for (const auto& [node, source] : lanelets_) {
      parts.add({node, remembered_span(node).value_or(all_rows(node)), source});
    }
    result.count("links to what no map holds", parts.settle_links(root_, false).links);
  }

  void add_file(std::size_t f, Merged& result) {
    pugi::xml_node root = root_of(f);
    const bool same_steps =
        root.attribute("timeStepSize").as_double() == root_.attribute("timeStepSize").as_double();
    if (!same_steps) {
      for (const auto node : all_children(root)) {
        if (!is_scenario_part(node.name())) continue;
        root.remove_child(node);
        ++lost_;
      }
    }
    std::vector<std::pair<pugi::xml_node, pugi::xml_node>> once;  // here, and in the first file
    std::vector<pugi::xml_node> added;
    NameChanges& names = names_[f];
    for (const auto node : all_children(root)) {
      if (!node.attribute("id")) continue;
      const auto known = elements_.find(text(node, "id"));
      if (known != elements_.end() && say_the_same(node, known->second, is_link)) {
        once.emplace_back(node, known->second);
      } else {
        added.push_back(node);
        rename(f, node, result);
      }
    }
    // What names something renamed is another thing, too.
    for (std::size_t before = 0; before != added.size();) {
      before = added.size();
      std::erase_if(once, [&](const auto& one) {
        if (!leads_to_renamed(one.first, names)) return false;
        added.push_back(one.first);
        rename(f, one.first, result);
        return true;
      });
    }
    for (const auto& [node, known] : once) add_links(node, known, names);
    for (const auto node : added) add(f, node, names);
    repeated_ += once.size();
  }

  static std::vector<pugi::xml_node> all_children(pugi::xml_node root) {
    return {root.children().begin(), root.children().end()};
  }

  static bool leads_to_renamed(pugi::xml_node element, const NameChanges& names) {
    std::vector<pugi::xml_node> open{element};
    while (!open.empty()) {
      const pugi::xml_node node = open.back();
      open.pop_back();
      if (names.contains(text(node, "ref"))) return true;
      for (const auto child : node.children()) {
        if (child.type() == pugi::node_element && !is_link(child)) open.push_back(child);
      }
    }
    return false;
  }

  void rename(std::size_t f, pugi::xml_node element, Merged& result) {
    for (const auto node : named_elements(element)) {
      const std::string id = text(node, "id");
      if (!elements_.contains(id)) continue;
      const std::string fresh = fresh_.fresh();
      names_[f][id] = fresh;
      if (const auto joined = joined_.find({f, id}); joined != joined_.end()) {
        for (const std::size_t file : joined->second) names_[file][id] = fresh;
      }
      result.renamed.push_back({files_[f].xml.name(), node.name(), id, fresh});
    }
  }

  static std::string called(const NameChanges& names, const std::string& id) {
    const auto found = names.find(id);
    return found == names.end() ? id : found->second;
  }

  // Links of a lanelet that another file knows, too.
  static void add_links(pugi::xml_node from, pugi::xml_node to, const NameChanges& names) {
    pugi::xml_node behind = to.child("rightBound");
    for (const char* link : {"predecessor", "successor", "adjacentLeft", "adjacentRight"}) {
      const bool is_one = std::string_view(link).starts_with("adjacent");
      for (const auto node : to.children(link)) behind = node;
      for (const auto node : from.children(link)) {
        const std::string id = called(names, text(node, "ref"));
        const auto same = [&](pugi::xml_node other) {
          return std::string_view(other.name()) == link && (is_one || text(other, "ref") == id);
        };
        if (to.find_child(same)) continue;
        behind = to.insert_copy_after(node, behind);
        set_text(behind, "ref", id);
      }
    }
  }

  // Behind those of its kind, else at the end.
  void add(std::size_t f, pugi::xml_node element, const NameChanges& names) {
    pugi::xml_node& last = last_[element.name()];
    last = last ? root_.insert_copy_after(element, last) : insert_ordered(root_, element, kOrder);
    std::vector<pugi::xml_node> open{last};
    while (!open.empty()) {
      const pugi::xml_node node = open.back();
      open.pop_back();
      if (node.attribute("ref")) set_text(node, "ref", called(names, text(node, "ref")));
      if (node.attribute("id")) {
        set_text(node, "id", called(names, text(node, "id")));
        elements_.emplace(text(node, "id"), node);
      }
      for (const auto child : node.children()) {
        if (child.type() == pugi::node_element) open.push_back(child);
      }
    }
    if (std::string_view(last.name()) != "lanelet") return;
    lanelets_.push_back({last, f});
    if (auto span = remembered_span(last)) {
      span->whole = called(names, span->whole);
      remember_span(last, *span);
    }
  }

  static constexpr std::array<std::string_view, 11> kOrder = {
      "location",        "scenarioTags",        "lanelet",        "trafficSign",
      "trafficLight",    "intersection",        "staticObstacle", "dynamicObstacle",
      "phantomObstacle", "environmentObstacle", "planningProblem"};

  const std::deque<commonroad::Document>& files_;
  pugi::xml_node root_;  // of the first file, that becomes the whole
  FreshIds fresh_;
  std::map<std::string, pugi::xml_node> elements_;  // of the whole, by id
  std::map<std::string, pugi::xml_node> last_;      // of each kind
  std::vector<SourcedLanelet> lanelets_;
  std::vector<NameChanges> names_;  // that each file's elements get
  // Files that have parts of a lanelet, by the first of them and its id there.
  std::map<std::pair<std::size_t, std::string>, std::set<std::size_t>> joined_;
  std::size_t repeated_ = 0, lost_ = 0;
};

std::string system_of(const commonroad::Document& file) {
  return commonroad::text_of(
      file.xml.root().child("location").child("geoTransformation").child("geoReference"));
}

}  // namespace

Merged merge_common_road(std::vector<MergeInput> inputs, const MergeOptions& options) {
  const std::string indent = indent_of(inputs.front().bytes);
  std::deque<commonroad::Document> files;
  for (MergeInput& input : inputs) {
    const commonroad::Document& file = files.emplace_back(std::move(input.bytes), input.name);
    if (options.same_system) continue;
    require_same_system({system_of(files.front())}, inputs.front().name, {system_of(file)},
                        input.name);
  }
  Merged result;
  ScenarioMerger(files).run(options, result);
  result.bytes = text_of(files.front().xml, indent);
  return result;
}

}  // namespace roadbed::map::edit::merging
