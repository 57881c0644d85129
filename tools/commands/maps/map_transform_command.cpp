#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "roadbed/map/edit/elevation/elevate.h"
#include "roadbed/map/edit/transforming/transform.h"
#include "roadbed/map/files/coordinate_limits.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/tools/commands/maps/commands.h"
#include "roadbed/tools/commands/maps/edit_output.h"
#include "roadbed/tools/commands/maps/measured_ground.h"
#include "roadbed/tools/files/csv.h"

namespace roadbed::tools::inline commands::inline maps {
namespace {

/// Radians, or degrees with their unit behind.
std::optional<double> angle_of(std::string_view text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  const std::string_view unit(rest, end);
  if (error != std::errc() || !std::isfinite(value) || !(unit.empty() || unit == "deg")) return {};
  const double angle_rad = unit.empty() ? value : value * std::numbers::pi / 180.0;
  return std::abs(angle_rad) <= 2.0 * std::numbers::pi ? std::optional(angle_rad) : std::nullopt;
}

/// @throws InputError if the table is unusable.
std::vector<map::PointPair> read_pairs(const std::filesystem::path& file) {
  constexpr const char* header = "from_x_m,from_y_m,to_x_m,to_y_m";
  const std::string bytes = map::read_file(file);
  CsvReader table(bytes, map::input_name(file));
  std::vector<std::size_t> columns;
  for (const char* name : {"from_x_m", "from_y_m", "to_x_m", "to_y_m"}) {
    columns.push_back(table.column(name, header));
  }
  std::vector<map::PointPair> pairs;
  bool apart = false;
  while (table.next_row()) {
    table.check_width();
    const auto number = [&](std::size_t i) {
      return table.number(columns[i], -map::kFarthestM, map::kFarthestM);
    };
    pairs.push_back({{number(0), number(1)}, {number(2), number(3)}});
    apart = apart || pairs.back().from != pairs.front().from;
  }
  if (!apart) table.refuse("rows", "there are not two places", "at least two pairs of points");
  return pairs;
}

class TransformCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Move a map, bring it into another coordinate system, or onto the measured ground");
    arguments.add("MAP", input_, "An OpenDRIVE, Lanelet2 or CommonRoad file")
        .required()
        .reads()
        .ending(kMapEndings);
    const Argument turn =
        arguments
            .add(
                "--turn", turn_,
                "Turn it about the origin of its coordinates, counter-clockwise [rad], or as 90deg")
            .checked([](const std::string& text) {
              return angle_of(text) ? "" : "is not an angle within a whole turn, as 0.1 or 90deg";
            });
    arguments.add("--about", about_m_, "Turn it about X,Y in place of the origin [m]")
        .within(-map::kFarthestM, map::kFarthestM)
        .values(2)
        .separated_by(',');
    const Argument shift = arguments.add("--shift", shift_m_, "Then shift it by X,Y [m]")
                               .within(-map::kFarthestM, map::kFarthestM)
                               .values(2)
                               .separated_by(',');
    arguments.add("--lift", lift_m_, "Raise it [m]").within(-1e5, 1e5);
    arguments
        .add("--align", pairs_file_,
             "Turn and shift it so that points come nearest to others: a CSV file with "
             "from_x_m,from_y_m,to_x_m,to_y_m")
        .reads()
        .ending(".csv")
        .excludes(turn)
        .excludes(shift);
    arguments.add("--to", to_,
                  "Bring its coordinates into this system: EPSG:25832 or a PROJ string");
    arguments.add("--crs", crs_,
                  "What the coordinates' system is, in place of what the map says; after a motion "
                  "alone, what it is called");
    arguments
        .add("--elevation", ground_files_,
             "Then take heights from the ground under it: point clouds (.pcd .ply .las .laz .xyz) "
             "or "
             "octrees (.bt .ot .tiles) in the coordinates that the map has then; may be given "
             "again. --lift is added to them")
        .one_each()
        .reads()
        .ending(kCloudEndings);
    output_.declare(arguments);
    arguments.require([this] { return fault(); });
    arguments.example(
        "  roadbed map transform town.xodr --turn 90deg --shift=1000,-500 -o moved.xodr\n"
        "  roadbed map transform town.xodr --turn 2deg --about 300,200 -o turned.xodr\n"
        "  roadbed map transform town.xodr --to EPSG:25832 -o utm.xodr\n"
        "  roadbed map transform town.xodr --elevation street.bt -o hilly.xodr");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    output_.check();
    map::TransformOptions options;
    if (!turn_.empty()) {
      options.motion = map::turn_about(
          about_m_.empty() ? Eigen::Vector2d(0, 0) : Eigen::Vector2d(about_m_[0], about_m_[1]),
          angle_of(turn_).value());
    }
    if (!shift_m_.empty()) {
      options.motion.shift_m.head<2>() += Eigen::Vector2d(shift_m_[0], shift_m_[1]);
    }
    std::vector<std::string> notes;
    if (!pairs_file_.empty()) {
      const map::Alignment found = map::align(read_pairs(pairs_file_));
      options.motion = found.motion;
      notes.push_back(fmt::format(
          "turned by {:.9f} rad and shifted by {:.4f},{:.4f} m; points are {:.4f} m (root mean "
          "square) and at most {:.4f} m off",
          found.motion.turn_rad, found.motion.shift_m.x(), found.motion.shift_m.y(), found.rms_m,
          found.worst_m));
    }
    if (!to_.empty()) options.to = to_;
    if (!crs_.empty()) options.crs = crs_;
    map::Edited edited;
    edited.bytes = map::read_file(input_);
    if (ground_files_.empty()) options.motion.shift_m.z() = lift_m_.value_or(0.0);
    if (moves()) edited = map::transform(std::move(edited.bytes), map::input_name(input_), options);
    edited.notes.insert(edited.notes.begin(), notes.begin(), notes.end());
    if (!ground_files_.empty()) elevate(edited);
    return output_.finish(edited, "map_transform", streams, common);
  }

 private:
  bool moves() const {
    return !turn_.empty() || !shift_m_.empty() || !pairs_file_.empty() || !to_.empty() ||
           !crs_.empty() || (lift_m_ && ground_files_.empty());
  }

  void elevate(map::Edited& edited) const {
    const auto ground = [this](std::span<const Eigen::Vector2d> at) {
      auto heights_m = measured_ground(ground_files_, at);
      for (auto& height_m : heights_m) {
        if (height_m) *height_m += lift_m_.value_or(0.0);
      }
      return heights_m;
    };
    map::Edited higher = map::elevate(std::move(edited.bytes), map::input_name(input_), ground);
    edited.bytes = std::move(higher.bytes);
    edited.counts.insert(edited.counts.end(), higher.counts.begin(), higher.counts.end());
    edited.notes.insert(edited.notes.end(), higher.notes.begin(), higher.notes.end());
  }

  std::string fault() const {
    if (!about_m_.empty() && turn_.empty()) return "--about needs --turn";
    return moves() || !ground_files_.empty()
               ? output_.fault()
               : "at least one of --turn, --shift, --lift, --align, --to, --crs and --elevation is "
                 "required";
  }

  std::filesystem::path input_, pairs_file_;
  std::vector<std::filesystem::path> ground_files_;
  std::string turn_, to_, crs_;
  std::vector<double> about_m_, shift_m_;
  std::optional<double> lift_m_;
  EditOutput output_;
};

}  // namespace

std::unique_ptr<Command> make_map_transform_command() {
  return std::make_unique<TransformCommand>();
}

}  // namespace roadbed::tools::commands::maps
