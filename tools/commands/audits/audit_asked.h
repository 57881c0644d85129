#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/model/road_map.h"
#include "roadbed/planning/audit/audit_drive.h"
#include "roadbed/tools/audit/certificate_file_check.h"
#include "roadbed/tools/audit/road_audit.h"
#include "roadbed/tools/cli/arguments.h"
#include "roadbed/tools/cli/inputs.h"
#include "roadbed/tools/commands/occupancy/filter_arguments.h"
#include "roadbed/tools/files/vehicle_file.h"

namespace roadbed::tools::inline commands::inline audits {

/// The options that say what drives are audited for: `--occupancy`, the vehicle, the question and
/// the road. Beside `--check` they say what a certificate has to be about.
class AuditAsked {
 public:
  void declare_occupancy(Arguments& arguments);
  /// @returns what certificates say nothing of.
  std::vector<Argument> declare(Arguments& arguments);

  /// What is wrong with the options together; empty if nothing is.
  std::string fault() const;

  const std::filesystem::path& occupancy_file() const { return occupancy_; }
  /// Which points of the occupancy count, where that is of clouds.
  const FilterArguments& filter() const { return filter_; }
  const std::filesystem::path& map_file() const { return map_; }
  /// The one given, else the one that a solution names.
  const std::filesystem::path& vehicle_file() const {
    return vehicle_.empty() ? drives_vehicle_ : vehicle_;
  }
  const std::filesystem::path& obstacles_file() const { return obstacles_; }

  /// Of a log, what the command line leaves out: its map, and that the drive is on it.
  void take_map_of_log(const std::filesystem::path& map_file);
  /// That the drive is on the map's drivable surface, where nothing else is said of the road.
  void take_road();

  /// What the file of the drives says of the question: which time is second 0, and, if it is a
  /// CommonRoad solution, the vehicle, where none is given.
  /// @param file  or a folder of them; empty: swept.
  /// @throws InputError if it, or the scenario, is unusable.
  void take_drive(const std::filesystem::path& file);
  /// The vehicle that is audited as the solution names it; empty: it is not from there.
  std::string vehicle_of_drive() const { return vehicle_.empty() ? drives_vehicle_.string() : ""; }
  /// In a line, that the vehicle given has another shape than the solution's; empty: it has not.
  std::string vehicle_note(const Vehicle& vehicle) const;
  /// Whether dynamic obstacles are at other times than their file alone says.
  /// @throws InputError if that is unusable.
  bool shifts_obstacles() const;

  bool asks() const { return !occupancy_.empty() || about_road(); }
  bool about_road() const { return !on_.empty(); }
  const planning::AuditOptions& options() const { return options_; }
  double from_height_m() const { return from_height_m_; }
  double margin_m() const { return margin_m_; }

  /// @throws InputError as do the two below, if a file is unusable.
  Vehicle read_vehicle() const;
  planning::AuditQuestion question(const Vehicle& vehicle, const map::RoadMap* road_map,
                                   bool certifies, const Inputs& inputs) const;

  /// @pre about_road()
  RoadQuestion road_question(const map::RoadMap* road_map) const;

  /// Whether obstacles are given of which only the lights beside them are looked at.
  bool leaves_obstacles() const { return occupancy_.empty() && !obstacles_.empty(); }

  bool has_rules() const { return !rules_.empty(); }

  /// Only what the command line says.
  CertificateDemands demands(const std::filesystem::path& trajectory) const;

  /// "--occupancy street.bt --on drivable", as one would type it.
  std::string against() const;

  /// What drives are audited against, by name.
  std::string suite() const;

 private:
  std::string about_occupancy() const;
  void declare_question(Arguments& arguments);
  /// @returns `--rules`.
  Argument declare_road(Arguments& arguments);

  // To tell what a certificate has to be about from what is a default.
  std::optional<Argument> clearance_argument_, inflate_argument_, unknown_argument_,
      least_measured_argument_, from_height_argument_, margin_argument_, seam_argument_;
  std::filesystem::path occupancy_, vehicle_, map_, obstacles_;
  std::filesystem::path drives_vehicle_;  // that a solution names
  FilterArguments filter_;
  planning::AuditOptions options_;
  std::string ground_, on_, rules_;
  long start_step_ = 0;  // of CommonRoad, second 0 of the drive
  double from_height_m_ = map::HeightBand{}.from_m;
  double margin_m_ = 0.0, seam_m_ = planning::SurfaceRule{}.seam_m;
};

}  // namespace roadbed::tools::commands::audits
