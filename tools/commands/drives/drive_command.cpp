#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/visible_text.h"
#include "roadbed/map/logs/log.h"
#include "roadbed/map/logs/log_contents.h"
#include "roadbed/tools/cli/drive_arguments.h"
#include "roadbed/tools/commands/drives/commands.h"
#include "roadbed/tools/files/drive_file.h"
#include "roadbed/tools/files/json.h"

namespace roadbed::tools::inline commands::inline drives {
namespace {

using geometry::TrajectoryPoint;

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

Json gaps_json(const std::vector<map::LogGap>& found, std::int64_t start_ns) {
  Json gaps = Json::array();
  for (const map::LogGap& gap : found) {
    gaps.push_back({{"after_s", seconds(gap.from_ns - start_ns)},
                    {"length_s", seconds(gap.to_ns - gap.from_ns)}});
  }
  return gaps;
}

Json rate_json(double rate_hz) { return rate_hz > 0.0 ? Json(rate_hz) : Json(); }

Json frames_json(const map::TopicContents& topic) {
  Json frames = Json::array();
  for (const map::FrameContents& frame : topic.frames) {
    frames.push_back({{"parent", frame.parent},
                      {"child", frame.child},
                      {"transforms", frame.transforms},
                      {"rate_hz", rate_json(frame.rate_hz)},
                      {"gaps", gaps_json(frame.gaps, topic.first_ns)}});
  }
  return frames;
}

Json topic_json(const map::TopicContents& topic) {
  const bool has_any = topic.messages > 0;
  return {{"topic", topic.topic.name},
          {"type", topic.topic.type},
          {"encoding", topic.topic.encoding},
          {"messages", topic.messages},
          {"first_ns", has_any ? Json(topic.first_ns) : Json()},
          {"last_ns", has_any ? Json(topic.last_ns) : Json()},
          {"rate_hz", rate_json(topic.rate_hz)},
          {"gaps", gaps_json(topic.gaps, topic.first_ns)},
          {"backwards", topic.backwards},
          {"frames", frames_json(topic)}};
}

double step_m(const TrajectoryPoint& from, const TrajectoryPoint& to) {
  return std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
}

/// Steps longer than the speed before lets a vehicle go, at 15 m/s² and noise of 0.1 m.
Json jumps_json(const std::vector<TrajectoryPoint>& rows) {
  constexpr double most_mps2 = 15.0, noise_m = 0.1;
  Json jumps = Json::array();
  double before_mps = rows.front().speed_mps;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double took_s = rows[i].t_s - rows[i - 1].t_s, way_m = step_m(rows[i - 1], rows[i]);
    const double most_m = (std::abs(before_mps) + most_mps2 * took_s) * took_s + noise_m;
    if (way_m > most_m) {
      jumps.push_back({{"t_s", rows[i].t_s}, {"step_m", way_m}, {"most_m", most_m}});
    } else {
      before_mps = way_m / took_s;
    }
  }
  return jumps;
}

Json gaps_json(const std::vector<TrajectoryPoint>& rows) {
  std::vector<std::int64_t> times_ns;
  for (const TrajectoryPoint& row : rows) {
    times_ns.push_back(std::llround(1e9 * (row.t_s - rows.front().t_s)));
  }
  std::int64_t median_ns = 0;
  return gaps_json(map::gaps_in(times_ns, median_ns), 0);
}

Json drive_json(const DriveOfFile& read) {
  const geometry::Trajectory& drive = read.drive;
  const std::vector<TrajectoryPoint>& rows = drive.points();
  double length_m = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i) length_m += step_m(rows[i - 1], rows[i]);
  const auto [slowest, fastest] =
      std::ranges::minmax_element(rows, {}, &TrajectoryPoint::speed_mps);
  const auto [west, east] = std::ranges::minmax_element(rows, {}, &TrajectoryPoint::x_m);
  const auto [south, north] = std::ranges::minmax_element(rows, {}, &TrajectoryPoint::y_m);
  return {{"rows", rows.size()},
          {"start_s", drive.start_s()},
          {"duration_s", drive.end_s() - drive.start_s()},
          {"length_m", length_m},
          {"least_speed_mps", slowest->speed_mps},
          {"greatest_speed_mps", fastest->speed_mps},
          {"bounds",
           {{"min_x_m", west->x_m},
            {"min_y_m", south->y_m},
            {"max_x_m", east->x_m},
            {"max_y_m", north->y_m}}},
          {"gaps", read.is_planned ? Json::array() : gaps_json(rows)},
          {"jumps", jumps_json(rows)},
          {"notes", read.notes}};
}

void print_rate(std::ostream& out, const Json& of) {
  if (!of["rate_hz"].is_null()) fmt::print(out, ", {:.3g} Hz", of["rate_hz"].get<double>());
  const std::size_t gaps = of["gaps"].size();
  if (gaps > 0) fmt::print(out, ", {} gap{}", gaps, gaps == 1 ? "" : "s");
}

void print_topic(std::ostream& out, const Json& topic) {
  fmt::print(out, "{} ({}): {} messages", topic["topic"].get<std::string>(),
             topic["type"].get<std::string>(), topic["messages"].get<std::size_t>());
  if (!topic["first_ns"].is_null()) {
    fmt::print(out, ", {:.3f} s to {:.3f} s", seconds(topic["first_ns"].get<std::int64_t>()),
               seconds(topic["last_ns"].get<std::int64_t>()));
  }
  print_rate(out, topic);
  if (topic["backwards"] != 0) {
    fmt::print(out, ", {} times backwards", topic["backwards"].get<std::size_t>());
  }
  out << '\n';
  if (topic["frames"].size() < 2) return;
  for (const Json& frame : topic["frames"]) {
    fmt::print(out, "  {} in {}: {} transforms", frame["child"].get<std::string>(),
               frame["parent"].get<std::string>(), frame["transforms"].get<std::size_t>());
    print_rate(out, frame);
    out << '\n';
  }
}

void print_drive(std::ostream& out, const Json& drive) {
  const auto number = [&](const char* key) { return drive[key].get<double>(); };
  const Json& box = drive["bounds"];
  fmt::print(out, "drive: {} rows, {:.3f} s, {:.3f} m, {:.3f} to {:.3f} m/s\n",
             drive["rows"].get<std::size_t>(), number("duration_s"), number("length_m"),
             number("least_speed_mps"), number("greatest_speed_mps"));
  fmt::print(out, "  x {:.3f} to {:.3f} m, y {:.3f} to {:.3f} m\n", box["min_x_m"].get<double>(),
             box["max_x_m"].get<double>(), box["min_y_m"].get<double>(),
             box["max_y_m"].get<double>());
  for (const Json& gap : drive["gaps"]) {
    fmt::print(out, "  gap of {:.3f} s after {:.3f} s\n", gap["length_s"].get<double>(),
               gap["after_s"].get<double>());
  }
  for (const Json& jump : drive["jumps"]) {
    fmt::print(out, "  jump of {:.3f} m at {:.3f} s, at most {:.3f} m by its speed\n",
               jump["step_m"].get<double>(), jump["t_s"].get<double>(),
               jump["most_m"].get<double>());
  }
}

class DriveCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description("Look at recorded drives and logs");
    Arguments info = arguments.part("info");
    info.description(
        "Say what a log or a drive holds: topics with types, counts, times, rates, gaps of over "
        "three intervals, of transforms by frame; of a drive length, speeds, bounds and jumps that "
        "its speed does not let");
    info.add("F", input_, "Log (rosbag2: its folder or .db3; .mcap) or drive, as audit reads it")
        .required()
        .reads()
        .ending(".db3 .mcap .csv .xml .feather .txt");
    of_drive_.declare(info);
    info.flag("-j,--json", json_, "Print one JSON document");
    info.example("  roadbed drive info drive/trajectory.csv --json");
    arguments.example("  roadbed drive info drive/trajectory.csv");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    const Json info = contents();
    if (!common.quiet && !info["drive"].is_null()) {
      streams.err << notes_text(map::one_line(input_.string()), info["drive"]["notes"]);
    }
    if (json_) {
      streams.out << map::json_text(versioned("drive_info", info), 2) << '\n';
      return Exit::ok;
    }
    for (const Json& topic : info["topics"]) print_topic(streams.out, topic);
    if (info["drive"].is_null()) {
      fmt::print(streams.out, "no drive: {}\n", info["no_drive"].get<std::string>());
    } else {
      print_drive(streams.out, info["drive"]);
    }
    return Exit::ok;
  }

 private:
  // A log may hold no drive, or several; what else it holds is said all the same.
  Json contents() const {
    Json info;
    info["topics"] = Json::array();
    const bool is_log = map::is_log(input_);
    if (is_log) {
      for (const auto& topic : map::contents_of_log(input_)) {
        info["topics"].push_back(topic_json(topic));
      }
    }
    info["drive"] = Json();
    info["no_drive"] = Json();
    try {
      info["drive"] = drive_json(read_drive(input_, of_drive_.options({})));
    } catch (const map::InputError& error) {
      if (!is_log) throw;
      info["no_drive"] = error.what();
    }
    return info;
  }

  std::filesystem::path input_;
  DriveArguments of_drive_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_drive_command() { return std::make_unique<DriveCommand>(); }

}  // namespace roadbed::tools::commands::drives
