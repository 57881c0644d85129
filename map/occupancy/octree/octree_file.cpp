#include "roadbed/map/occupancy/octree/octree_file.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/occupancy/clouds/cloud_formats.h"

namespace roadbed::map::inline occupancy::inline octree {
namespace {

constexpr int kDeepest = 16;
constexpr std::string_view kBtHeader = "# Octomap OcTree binary file";
constexpr std::string_view kOtHeader = "# Octomap OcTree file";

class OctreeParser {
 public:
  OctreeParser(std::string_view bytes, const std::string& name)
      : bytes_(bytes), lines_(bytes), name_(name) {}

  OctreeFile parse() {
    read_header();
    check_header();
    if (file_.nodes == 0) {
      if (!file_.data.empty()) refuse_trailing();
    } else if (file_.form == OctreeForm::bt) {
      walk_bt();
    } else {
      walk_ot();
    }
    return file_;
  }

 private:
  [[noreturn]] void refuse(const std::string& place, const std::string& element,
                           const std::string& found, const std::string& needed,
                           const std::string& remedy) const {
    refuse_cloud(name_, place, element, found, needed, remedy);
  }

  [[noreturn]] void refuse_header(const std::string& element, const std::string& found,
                                  const std::string& needed) const {
    refuse(std::to_string(lines_.line_number()), element, found, needed,
           "get the whole file; of a point cloud make an octree with roadbed occupancy build");
  }

  [[noreturn]] void refuse_data(const std::string& found, const std::string& needed) const {
    refuse(fmt::format("byte {}", bytes_.size() - rest_.size()), "octree", found, needed,
           "get the whole file, or build it again");
  }

  [[noreturn]] void refuse_trailing() const {
    refuse_data(fmt::format("{} bytes are left after the last node", rest_.size()), "none");
  }

  void read_header() {
    const std::string_view first = lines_.next_line();
    if (first.starts_with(kBtHeader)) {
      file_.form = OctreeForm::bt;
    } else if (first.starts_with(kOtHeader)) {
      file_.form = OctreeForm::ot;
    } else {
      refuse_header("header", "is not OctoMap's",
                    fmt::format("a first line \"{}\" or \"{}\"", kBtHeader, kOtHeader));
    }
    while (true) {
      if (lines_.done()) refuse_header("header", "ends without a data line", "data");
      std::string_view line = lines_.next_line();
      const std::string_view key = next_word(line);
      if (key == "data") break;
      read_header_line(key, line);
    }
    file_.data = rest_ = lines_.rest();
  }

  void read_header_line(std::string_view key, std::string_view line) {
    if (key == "#") return read_comment(line);
    const std::string_view word = next_word(line);
    if (key == "id") {
      id_ = word;
    } else if (key == "size") {
      const auto value = parse_count(word);
      if (!value) refuse_header("size", fmt::format("\"{}\"", word), "a number of nodes");
      file_.nodes = *value;
      has_size_ = true;
    } else if (key == "res") {
      file_.resolution_m = parse_number(word).value_or(0.0);
    }
  }

  void read_comment(std::string_view line) {
    if (next_word(line) != "roadbed") return;
    const std::string_view what = next_word(line);
    if (what == "seen-through") read_seen_through(line);
    if (what != "origin") return;
    for (int axis = 0; axis < 3; ++axis) {
      const auto value = parse_number(next_word(line));
      if (!value || !(std::abs(*value) < 1e9)) {
        refuse_header("origin", "is not three finite numbers", "# roadbed origin X Y Z CRS");
      }
      file_.origin_in_source[axis] = *value;
    }
    if (!line.empty()) line.remove_prefix(1);
    file_.crs = one_line(std::string(line));
  }

  void read_seen_through(std::string_view line) {
    constexpr std::uint64_t most = 255;
    const auto clouds = parse_count(next_word(line));
    const bool is_removed = next_word(line) == "removed";
    const auto cells = parse_count(next_word(line));
    if (!clouds || *clouds > most || !is_removed || !cells) {
      refuse_header("seen-through", "is not two whole numbers",
                    "# roadbed seen-through CLOUDS removed CELLS");
    }
    file_.seen_through = SeeThroughRemoval{static_cast<int>(*clouds), *cells};
  }

  void check_header() const {
    // A .bt holds the same bits whatever kind of tree wrote it.
    if (file_.form == OctreeForm::ot && id_ != "OcTree") {
      refuse_header("id", fmt::format("\"{}\"", id_), "OcTree, without colours or time stamps");
    }
    if (!has_size_) refuse_header("size", "is missing", "the number of nodes");
    constexpr double finest = 1e-4, coarsest = 1e4;
    if (!(file_.resolution_m >= finest && file_.resolution_m <= coarsest)) {
      refuse_header("res", fmt::format("{}", file_.resolution_m),
                    fmt::format("{} to {} metres", finest, coarsest));
    }
  }

  // Takes a node's bytes off the data.
  std::string_view take(std::size_t size, std::size_t nodes_so_far) {
    if (rest_.size() < size) {
      refuse_data(fmt::format("ends after {} nodes", nodes_so_far),
                  fmt::format("{} as the header says", file_.nodes));
    }
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  void check_depth(int depth) const {
    if (depth > kDeepest) {
      refuse_data(fmt::format("a node lies {} levels deep", depth),
                  fmt::format("at most {}", kDeepest));
    }
  }

  void check_end(std::size_t nodes) const {
    if (nodes != file_.nodes) {
      refuse_data(fmt::format("has {} nodes", nodes),
                  fmt::format("{} as the header says", file_.nodes));
    }
    if (!rest_.empty()) refuse_trailing();
  }

  // Depth first, as the file is written: the nodes of a stack are siblings that still have to come.
  void walk_bt() {
    std::size_t nodes = 1;
    std::vector<int> inner{0};  // depths of inner nodes still to come
    while (!inner.empty()) {
      const int depth = inner.back();
      inner.pop_back();
      const auto children = static_cast<unsigned>(read_unsigned(take(2, nodes), 0, 2));
      if (children == 0) refuse_data("an inner node has no child", "one to eight children");
      check_depth(depth + 1);
      for (unsigned child = 0; child < 8; ++child) {
        const unsigned state = children >> (2 * child) & 3u;
        nodes += state != 0;
        if (state == 3) inner.push_back(depth + 1);
      }
    }
    check_end(nodes);
  }

  void walk_ot() {
    std::size_t nodes = 0;
    std::vector<int> to_come{0};
    while (!to_come.empty()) {
      const int depth = to_come.back();
      to_come.pop_back();
      check_depth(depth);
      const std::string_view node = take(5, nodes);
      ++nodes;
      if (!std::isfinite(read_scalar(node.data(), ScalarType::f32))) {
        refuse_data("a log-odds value is not finite", "a number");
      }
      const int children = std::popcount(static_cast<unsigned char>(node[4]));
      to_come.insert(to_come.end(), static_cast<std::size_t>(children), depth + 1);
    }
    check_end(nodes);
  }

  std::string_view bytes_;
  TextScanner lines_;
  const std::string& name_;
  OctreeFile file_;
  std::string id_;
  bool has_size_ = false;
  std::string_view rest_;
};

}  // namespace

bool is_octree_file(std::string_view bytes) { return bytes.starts_with("# Octomap OcTree"); }

OctreeFile parse_octree_file(std::string_view bytes, const std::string& name) {
  return OctreeParser(bytes, name).parse();
}

}  // namespace roadbed::map::occupancy::octree
