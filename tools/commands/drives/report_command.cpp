#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/tools/commands/drives/commands.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline drives {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Numbers of a metrics.json by name, "comfort.largest_jerk_mps3"; true and false are 1 and 0, what
/// is null has no value. Lists and texts are no metrics.
using Metrics = std::map<std::string, std::optional<double>>;

void collect(const nlohmann::json& value, const std::string& name, Metrics& metrics) {
  if (value.is_object()) {
    for (const auto& [key, part] : value.items()) {
      const std::string shown = map::one_line(key);
      collect(part, name.empty() ? shown : name + "." + shown, metrics);
    }
  } else if (value.is_number()) {
    metrics[name] = value.get<double>();
  } else if (value.is_boolean()) {
    metrics[name] = value.get<bool>() ? 1.0 : 0.0;
  } else if (value.is_null()) {
    metrics[name] = std::nullopt;
  }
}

[[noreturn]] void refuse_run(const fs::path& file, const std::string& found) {
  throw map::InputError({.file = file.string(),
                         .found = found,
                         .needed = "the metrics.json of a drive, or its folder",
                         .remedy = "drive with `roadbed simulate`"});
}

Metrics read_metrics(const fs::path& run) {
  const fs::path file = map::is_folder(run) ? run / "metrics.json" : run;
  const nlohmann::json document = parse_json_strictly(map::read_file(file), map::input_name(file));
  Metrics metrics;
  if (document.is_object()) {
    JsonNode(document, map::input_name(file)).check_version("metrics");
    collect(document, "", metrics);
    metrics.erase("roadbed_metrics");
  }
  if (metrics.empty()) refuse_run(file, "no metric");
  return metrics;
}

/// "name=value" of --max.
struct Bound {
  std::string metric;
  double most = 0.0;
};

std::optional<Bound> bound_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return std::nullopt;
  Bound bound{text.substr(0, equals), 0.0};
  const char* const end = text.data() + text.size();
  const auto [stop, fault] = std::from_chars(text.data() + equals + 1, end, bound.most);
  if (fault != std::errc{} || stop != end || !std::isfinite(bound.most)) return std::nullopt;
  return bound;
}

std::string value_text(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "-";
}

ordered_json json_of(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

class ReportCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Compare the metrics of drives, show a recorded drive");
    Arguments compare = arguments.part("compare");
    compare.description("Set the metrics of two drives side by side");
    compare.add("A", a_, "Folder of a drive, or its metrics.json").required();
    compare.add("B", b_, "The other one; bounds are for this").required();
    compare
        .add(
            "--max", bounds_,
            "METRIC=VALUE: the status is 1 if B's metric is greater, or has no value; may be given "
            "several times")
        .checked([](const std::string& text) {
          return bound_of(text) ? std::string() : "needs METRIC=VALUE, got " + text;
        });
    compare.flag("-j,--json", json_, "Print one JSON document");
    compare.says_no_if("a metric of B is above its bound");
    compare.example("  roadbed report compare before after --max largest_cross_track_m=0.2");
    arguments.example(
        "  roadbed report compare before after\n"
        "  roadbed report drive drive/trajectory.csv --map town.xodr -o drive.html");
    drive_arguments_ = arguments.part("drive");
    drive_->declare(*drive_arguments_);
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    if (drive_arguments_->given()) return drive_->run(streams, common);
    const Metrics a = read_metrics(a_), b = read_metrics(b_);
    std::vector<Bound> exceeded;
    for (const std::string& text : bounds_) {
      const Bound bound = *bound_of(text);
      const auto found = b.find(bound.metric);
      if (found == b.end()) refuse_run(b_, "no metric of the name " + bound.metric);
      if (!found->second || *found->second > bound.most) exceeded.push_back(bound);
    }
    if (json_) {
      print_json(streams.out, a, b, exceeded);
    } else {
      print_table(streams.out, a, b, exceeded);
    }
    return exceeded.empty() ? Exit::ok : Exit::no;
  }

 private:
  /// Calls with the name and both values, of every metric that either has.
  template <typename Visit>
  static void for_each_metric(const Metrics& a, const Metrics& b, const Visit& visit) {
    Metrics all = a;
    all.insert(b.begin(), b.end());
    const auto value = [](const Metrics& metrics, const std::string& name) {
      const auto found = metrics.find(name);
      return found == metrics.end() ? std::nullopt : found->second;
    };
    for (const auto& [name, unused] : all) visit(name, value(a, name), value(b, name));
  }

  static void print_table(std::ostream& out, const Metrics& a, const Metrics& b,
                          const std::vector<Bound>& exceeded) {
    fmt::print(out, "{:42} {:>14} {:>14} {:>14}\n", "metric", "A", "B", "B - A");
    for_each_metric(a, b, [&](const auto& name, const auto& in_a, const auto& in_b) {
      const auto change = in_a && in_b ? std::optional(*in_b - *in_a) : std::nullopt;
      fmt::print(out, "{:42} {:>14} {:>14} {:>14}\n", name, value_text(in_a), value_text(in_b),
                 value_text(change));
    });
    for (const Bound& bound : exceeded) {
      fmt::print(out, "B does not keep {} at {:g} or less\n", bound.metric, bound.most);
    }
  }

  static void print_json(std::ostream& out, const Metrics& a, const Metrics& b,
                         const std::vector<Bound>& exceeded) {
    ordered_json metrics = ordered_json::object(), over = ordered_json::array();
    for_each_metric(a, b, [&](const auto& name, const auto& in_a, const auto& in_b) {
      metrics[name] = {{"a", json_of(in_a)}, {"b", json_of(in_b)}};
    });
    for (const Bound& bound : exceeded) {
      over.push_back({{"metric", bound.metric}, {"max", bound.most}});
    }
    out << map::json_text(
               ordered_json{{"roadbed_comparison", 1}, {"metrics", metrics}, {"exceeded", over}}, 2)
        << '\n';
  }

  std::unique_ptr<Command> drive_ = make_report_drive_command();
  std::optional<Arguments> drive_arguments_;
  fs::path a_, b_;
  std::vector<std::string> bounds_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_report_command() { return std::make_unique<ReportCommand>(); }

}  // namespace roadbed::tools::commands::drives
