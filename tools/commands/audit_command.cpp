#include <fmt/format.h>
#include <fmt/ostream.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/json_text.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/model/road_map.h"
#include "roadbed/map/occupancy/clearance/clearance_field.h"
#include "roadbed/map/occupancy/octree/occupancy_source.h"
#include "roadbed/map/storage/output_file.h"
#include "roadbed/planning/audit/audit_drive.h"
#include "roadbed/tools/audit/audit_subjects.h"
#include "roadbed/tools/audit/audited_drive.h"
#include "roadbed/tools/audit/certificate_file_check.h"
#include "roadbed/tools/audit/certificate_json.h"
#include "roadbed/tools/audit/road_audit.h"
#include "roadbed/tools/cli/build_id.h"
#include "roadbed/tools/cli/progress_bar.h"
#include "roadbed/tools/commands/audit_frames.h"
#include "roadbed/tools/commands/audit_output.h"
#include "roadbed/tools/commands/commands.h"
#include "roadbed/tools/files/drive_file.h"
#include "roadbed/tools/files/json.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/files/vehicle_file.h"
#include "roadbed/tools/report/audit_pages.h"
#include "roadbed/tools/report/audit_pictures.h"
#include "roadbed/tools/report/report.h"
#include "roadbed/tools/report/surroundings.h"
#include "roadbed/tools/simulation/scenario.h"

namespace roadbed::tools::inline commands {
namespace {

using planning::AuditQuestion;
using planning::UnknownPolicy;

class AuditCommand : public Command {
 public:
  void declare(Arguments& arguments) override {
    arguments.description(
        "Prove that drives keep clear of occupied space and on the road, or show where they do "
        "not");
    arguments
        .add("--occupancy", occupancy_,
             "Octree of obstacles (.bt .ot), or a folder of tiles, of which a drive reads those "
             "that it meets")
        .reads()
        .ending(kOctreeEndings);
    const std::vector<Argument> not_with_check = subjects_.declare(arguments);
    arguments.heading("Question");
    arguments
        .add("--vehicle", vehicle_,
             std::string("Vehicle: ") + kVehicleSyntax + "; default: commonroad:2")
        .reads()
        .ending(".json .yaml");
    arguments
        .add("--map", map_, "Map of the roads: what --on is about; checks that frames agree; drawn")
        .reads()
        .ending(kMapEndings);
    arguments
        .add(
            "--obstacles", obstacles_,
            "Dynamic obstacles beside the occupancy: a scenario (.json, CommonRoad .xml), or boxes "
            "over time (.csv: t_s,id,x_m,y_m,heading_rad,length_m,width_m, poses of the "
            "centre; an id of one row stands for ever, one of several is there from its "
            "first to its last), in the drive's time and coordinates")
        .reads(files_named_by_scenario)
        .ending(".json .xml .csv");
    declare_question(arguments);
    declare_road(arguments);
    declare_outputs(arguments, not_with_check);
    arguments.require([this] { return missing(); });
    arguments.says_no_if("a drive is not clear, or the certificate does not hold");
    arguments.example(
        "  roadbed audit --occupancy street.bt --trajectory drive/trajectory.csv "
        "--certificate proof.json\n"
        "  roadbed audit --check proof.json --vehicle car.json --clearance 0.3\n"
        "  roadbed audit --occupancy street.bt --trajectory drives --threads 4 --junit audit.xml\n"
        "  roadbed audit --occupancy street.bt --trajectory poses.txt --pose-frame rear-axle "
        "--save-drive poses.csv\n"
        "  roadbed audit --occupancy street.bt --map town.xodr --lane lane:1/0/-1 --offset 0.3\n"
        "  roadbed audit --map town.xodr --on drivable --margin 0.1 --trajectory "
        "drive/trajectory.csv");
  }

  Exit run(const Streams& streams, const CommonOptions& common) override {
    inputs_ = common.inputs;
    if (!check_.empty()) {
      const bool holds = check_certificate_file(check_, demands(), json_, *inputs_, streams.out);
      return holds ? Exit::ok : Exit::no;
    }
    for (const auto& output : {svg_, report_, certificate_, junit_, geojson_, saved_drive_}) {
      if (!output.empty()) map::check_writable(output, force_);
    }
    if (!certificate_.empty()) refuse_certificate_of_streams();
    if (!certificate_.empty()) refuse_certificate_of_logs();
    const Vehicle vehicle = vehicle_.empty() ? Vehicle{} : read_vehicle(vehicle_);
    AuditQuestion question = asked(vehicle);
    std::shared_ptr<const map::RoadMap> road_map;
    if (!map_.empty()) road_map = inputs_->road_map(map_);
    question.ground = ground_rule(ground_, road_map.get());
    const RoadQuestion road = on_.empty() ? RoadQuestion{} : road_question(road_map.get());
    const std::vector<AuditSubject> subjects = subjects_.list(road_map.get(), vehicle.shape);
    Scene scene = make_scene(road_map.get(), vehicle.shape, streams, common);
    if (!on_.empty()) scene.road = &road;
    return subjects_.is_folder() ? run_folder(subjects, question, scene, streams, common)
                                 : run_one(subjects.front(), question, scene, streams, common);
  }

 private:
  /// What all drives are audited against.
  struct Scene {
    std::shared_ptr<const map::OccupancySource> occupancy;  // null: the road only
    const map::RoadMap* road_map;
    geometry::VehicleShape shape;
    const RoadQuestion* road = nullptr;  // null: the occupancy only

    std::string crs() const {
      if (occupancy) return occupancy->crs();
      return road_map == nullptr ? std::string() : road_map->crs();
    }
    AuditDemand demand(const AuditQuestion& question) const {
      return {.occupancy = occupancy.get(), .question = question, .road = road};
    }
  };

  // Beside --check it is what a certificate has to be about.
  void declare_question(Arguments& arguments) {
    clearance_argument_ =
        arguments
            .add("--clearance", options_.clearance_m, "Less distance than this is a conflict [m]")
            .within(0.0, 100.0)
            .with_default();
    inflate_argument_ =
        arguments.add("--inflate", options_.inflate_m, "Margin added around the vehicle [m]")
            .within(0.0, 100.0)
            .with_default();
    unknown_argument_ = arguments.choice(
        "--unknown", options_.unknown,
        {{"free", UnknownPolicy::free},
         {"occupied", UnknownPolicy::occupied},
         {"report", UnknownPolicy::report}},
        "How unknown space counts, which was not measured: free, occupied, or report: no obstacle, "
        "but a "
        "drive over it is not clear. Where nothing was measured within 10 m of the body at its "
        "heights, a drive is not clear either way");
    least_measured_argument_ = arguments
                                   .add("--least-measured", options_.least_measured,
                                        "Fraction of the space that the vehicle takes that has to "
                                        "be measured, else no drive is clear, whatever --unknown "
                                        "says")
                                   .within(0.0, 1.0)
                                   .with_default();
    arguments
        .add("--ground", ground_,
             "What heights are above: Z of level ground in the occupancy's frame [m]; map: the "
             "road's surface of --map, which the band follows; measured: the surface that was "
             "measured along the drive, to a cell, with nothing below it, on all sides and "
             "without a step, refused elsewhere; heights are widened by a cell. A drive that "
             "is all upon an obstacle takes its top for ground. Default: map with --map, else "
             "0")
        .checked(ground_rule_fault);
    from_height_argument_ =
        arguments
            .add("--from-height", from_height_m_,
                 "The vehicle's underside above the ground [m]; its top is the vehicle's height")
            .within(-100.0, 100.0)
            .with_default();
  }

  void declare_road(Arguments& arguments) {
    arguments.heading("Road");
    arguments
        .add("--on", on_,
             "What the whole body has to stay on, between the rows too: drivable (drivable lanes "
             "and road areas of --map), surface (with shoulders, stops, parking, bus and taxi "
             "lanes), lanes (those that the drive is along in their direction, and those beside "
             "them), route:F.json (lanes that route --json printed), or area:F.geojson (polygons "
             "in the drive's coordinates). Needs no --occupancy")
        .checked(surface_words_fault)
        .may_read([](const std::string& words) {
          return surface_words_fault(words).empty() ? surface_words(words).file
                                                    : std::filesystem::path();
        });
    margin_argument_ =
        arguments.add("--margin", margin_m_, "Least distance from the body to the edge of --on [m]")
            .within(0.0, 0.5 * planning::kSurfaceHorizon_m)
            .with_default();
    arguments
        .add("--seam", seam_m_,
             "Points of the map this near to each other are one for --on: gaps of maps that do not "
             "meet exactly are no holes [m]")
        .within(0.0, 0.1)
        .with_default();
    arguments
        .add("--rules", rules_,
             "Traffic rules that count in the verdict, with commas: markings (solid ones are not "
             "crossed), direction, speed, lights (none is passed at red, as far as a CommonRoad "
             "map or the scenario of --obstacles says what they show), or all. With --on and "
             "--map each has a verdict of its own either way")
        .checked(rules_fault);
  }

  static std::vector<planning::TrafficRule> rules_of(const std::string& words) {
    std::vector<planning::TrafficRule> rules;
    for (const planning::TrafficRule rule : planning::kTrafficRules) {
      const auto name = "," + std::string(planning::to_string(rule)) + ",";
      if (words == "all" || ("," + words + ",").find(name) != std::string::npos) {
        rules.push_back(rule);
      }
    }
    return rules;
  }

  static std::string rules_fault(const std::string& words) {
    if (words == "all") return {};
    const auto count = 1 + std::ranges::count(words, ',');
    const auto known = static_cast<std::ptrdiff_t>(rules_of(words).size());
    return count == known ? "" : "is not all, nor of markings, direction, speed and lights";
  }

  RoadQuestion road_question(const map::RoadMap* road_map) const {
    RoadQuestion road{.on = on_, .surface = surface_rule(on_, road_map), .margin_m = margin_m_};
    road.surface.seam_m = seam_m_;
    road.made = made_surface(road.surface);
    road.counted = rules_of(rules_);
    for (const auto& file : {map_, obstacles_}) {
      const std::vector<planning::LightCycle> lights = recorded_lights(file);
      road.lights.insert(road.lights.end(), lights.begin(), lights.end());
    }
    return road;
  }

  // Only what the command line says.
  CertificateDemands demands() const {
    const auto if_given = [](const std::optional<Argument>& argument, auto value) {
      return argument->given() ? std::optional(value) : std::nullopt;
    };
    return {.occupancy = occupancy_,
            .trajectory = subjects_.file(),
            .vehicle = vehicle_,
            .map = map_,
            .obstacles = obstacles_,
            .ground = ground_,
            .on = on_,
            .clearance_m = if_given(clearance_argument_, options_.clearance_m),
            .inflate_m = if_given(inflate_argument_, options_.inflate_m),
            .underside_m = if_given(from_height_argument_, from_height_m_),
            .least_measured = if_given(least_measured_argument_, options_.least_measured),
            .margin_m = if_given(margin_argument_, margin_m_),
            .unknown = if_given(unknown_argument_, options_.unknown)};
  }

  void declare_outputs(Arguments& arguments, const std::vector<Argument>& not_with_check) {
    arguments.heading("Outputs");
    arguments.flag("-j,--json", json_, "Print one JSON document");
    const Argument svg =
        arguments.add("--svg", svg_, "Draw the audit of one drive as a picture (.svg)")
            .writes(".svg");
    const Argument page =
        arguments
            .add("--report", report_,
                 "Write a page that plays the audit of one drive, or lists those of a folder, with "
                 "close-ups (.html)")
            .writes(".html");
    const Argument certificate =
        arguments
            .add("--certificate", certificate_,
                 "Write the proof of one drive (.json): spans of time, what holds in them, "
                 "witnesses, hashes of the inputs")
            .writes(".json");
    const Argument junit =
        arguments.add("--junit", junit_, "Write a test case per drive (.xml)").writes(".xml");
    const Argument geojson =
        arguments
            .add("--geojson", geojson_,
                 "Write stretches, conflicts and witnesses (.geojson), in the occupancy's "
                 "coordinates")
            .writes(".geojson");
    const Argument saved =
        arguments
            .add("--save-drive", saved_drive_,
                 "Write the drive that was audited, poses of the rear axle (.csv)")
            .writes(".csv");
    Argument check =
        arguments
            .add("--check", check_,
                 "Verify a certificate by brute force instead, from the files that it names. The "
                 "question's options, --occupancy and --trajectory say what it has to be about; "
                 "files may have moved, if they are the same")
            .reads(files_named_by_certificate)
            .ending(".json");
    for (const Argument& other : {svg, page, certificate, junit, geojson, saved})
      check.excludes(other);
    for (const Argument& other : not_with_check) check.excludes(other);
    arguments.flag("-f,--force", force_, "Replace outputs that exist");
  }

  std::string missing() const {
    if (!check_.empty()) return {};
    if (ground_ == "map" && map_.empty()) return "--ground map needs --map";
    if (occupancy_.empty() && on_.empty()) return "--occupancy or --on is required";
    if (on_.empty() && (margin_argument_->given() || !rules_.empty())) {
      return "--margin and --rules need --on";
    }
    const bool is_area = !on_.empty() && on_.starts_with("area:");
    if (!on_.empty() && !is_area && map_.empty()) return "--on " + on_ + " needs --map";
    if (!rules_.empty() && map_.empty()) return "--rules needs --map";
    if (occupancy_.empty() && !ground_.empty()) return "--ground needs --occupancy";
    if (std::string fault = subjects_.fault(!map_.empty()); !fault.empty()) return fault;
    if (!subjects_.is_swept()) return {};
    const bool proves_nothing = !certificate_.empty() && saved_drive_.empty();
    return proves_nothing ? "--certificate needs --save-drive here, as it is about a file" : "";
  }

  AuditQuestion asked(const Vehicle& vehicle) const {
    AuditQuestion question{.parts = vehicle.parts(from_height_m_),
                           .options = options_,
                           .certifies = !certificate_.empty()};
    if (!obstacles_.empty()) {
      question.moving_in_source = read_moving_obstacles(obstacles_, *inputs_);
    }
    return question;
  }

  Scene make_scene(const map::RoadMap* road_map, const geometry::VehicleShape& shape,
                   const Streams& streams, const CommonOptions& common) const {
    Scene scene{occupancy_.empty() ? nullptr : inputs_->occupancy(occupancy_), road_map, shape};
    if (!scene.occupancy) return scene;
    if (const auto removed = scene.occupancy->seen_through(); removed && !common.quiet) {
      fmt::print(streams.err,
                 "note: {} was built with --remove-seen-through {}: {} cells with points count as "
                 "free\n",
                 occupancy_.string(), removed->clouds, removed->cells);
    }
    if (road_map == nullptr) return scene;
    check_overlap(road_bounds(*road_map), measured_bounds(*scene.occupancy), occupancy_.string());
    const std::string &of_map = road_map->crs(), &of_occupancy = scene.occupancy->crs();
    if (!common.quiet && !of_map.empty() && !of_occupancy.empty() && of_map != of_occupancy) {
      fmt::print(streams.err, "note: the map's CRS is \"{}\", the occupancy's \"{}\"\n", of_map,
                 of_occupancy);
    }
    return scene;
  }

  Exit run_folder(const std::vector<AuditSubject>& subjects, const AuditQuestion& question,
                  const Scene& scene, const Streams& streams, const CommonOptions& common) const {
    if (!svg_.empty() || !certificate_.empty() || !saved_drive_.empty()) {
      throw map::InputError({.file = "--svg, --certificate or --save-drive",
                             .found = "is about one drive, and --trajectory is a folder",
                             .remedy = "give one file"});
    }
    ProgressBar progress(subjects.size(), !common.quiet && isatty(STDERR_FILENO) == 1);
    const std::vector<AuditedDrive> audits =
        audit_all(scene.demand(question), subjects, common.threads, [&] { progress.done_one(); });
    for (const AuditedDrive& audited : audits) {
      if (!common.quiet && audited.fault.empty()) note_curvature(audited, scene, streams.err);
    }
    write_index(audits, question, scene);
    write_files(audits, question, scene);
    if (json_) {
      streams.out << text_of_json(versioned("audits", with_removal(audits_json(audits), scene)));
    } else {
      streams.out << audits_table(audits);
    }
    return std::ranges::all_of(audits, &AuditedDrive::is_clear) ? Exit::ok : Exit::no;
  }

  // Of what the vehicle could not drive; audited all the same.
  static void note_curvature(const AuditedDrive& audited, const Scene& scene, std::ostream& err) {
    const std::string note = curvature_note(audited.drive, scene.shape);
    if (!note.empty()) fmt::print(err, "note: {}: {}\n", audited.name, note);
  }

  Exit run_one(const AuditSubject& subject, const AuditQuestion& question, const Scene& scene,
               const Streams& streams, const CommonOptions& common) const {
    AuditedDrive audited{.name = subject.name, .drive = subject.drive()};
    if (!common.quiet) note_curvature(audited, scene, streams.err);
    audit_one(scene.demand(question), audited, [&](const planning::GroundUnder& ground) {
      if (common.quiet) return;
      streams.err << ground_note(ground, question, scene.occupancy->resolution_m());
    });
    if (!saved_drive_.empty())
      map::write_output(saved_drive_, write_trajectory_csv(audited.drive), force_);
    write_picture(audited, question, scene);
    write_report(audited, question, scene);
    write_certificate(audited, question, scene);
    write_files({audited}, question, scene);
    if (json_) {
      streams.out << text_of_json(versioned("audit", with_removal(audit_json(audited), scene)));
    } else {
      streams.out << audit_text(audited);
    }
    return audited.is_clear() ? Exit::ok : Exit::no;
  }

  static nlohmann::ordered_json with_removal(nlohmann::ordered_json json, const Scene& scene) {
    const auto removed = scene.occupancy ? scene.occupancy->seen_through() : std::nullopt;
    if (removed) {
      json["occupancy_seen_through"] = {{"clouds", removed->clouds},
                                        {"removed_cells", removed->cells}};
    }
    return json;
  }

  // File names may hold bytes that are no UTF-8.
  static std::string text_of_json(const nlohmann::ordered_json& json) {
    return map::json_text(json, 2) + "\n";
  }

  // What a picture of a drive can show.
  map::Box2 drawn(const AuditedDrive& audited, const AuditQuestion& question) const {
    const Eigen::Vector2d margin_m = Eigen::Vector2d::Constant(60.0);
    const map::Box2 around =
        planning::audited_region(audited.drive, question.parts, options_).around;
    return {around.min_in_source - margin_m, around.max_in_source + margin_m};
  }

  // Lanes that a picture of a drive can show: it is wider or higher than the drive's box by less
  // than three times the box's longer side.
  std::vector<geometry::Ring> drawn_lanes(const AuditedDrive& audited,
                                          const AuditQuestion& question, const Scene& scene) const {
    if (scene.road_map == nullptr) return {};
    const map::Box2 box = drawn(audited, question);
    const double side_m = (box.max_in_source - box.min_in_source).maxCoeff();
    const Eigen::Vector2d margin_m = Eigen::Vector2d::Constant(3.0 * side_m);
    return drivable_rings(*scene.road_map,
                          {box.min_in_source - margin_m, box.max_in_source + margin_m});
  }

  void write_picture(const AuditedDrive& audited, const AuditQuestion& question,
                     const Scene& scene) const {
    if (svg_.empty()) return;
    const planning::AuditReport whole = audited.whole();
    map::write_output(svg_,
                      audit_svg({audited.drive, question.inflated_parts(), whole,
                                 occupied_around(audited, question, scene),
                                 drawn_ground(audited, question, scene), question.moving_in_source,
                                 !scene.occupancy}),
                      force_);
  }

  std::vector<map::Box2> occupied_around(const AuditedDrive& audited, const AuditQuestion& question,
                                         const Scene& scene) const {
    if (!scene.occupancy) return {};
    return occupied_boxes(*scene.occupancy, question.heights(audited.audit.ground),
                          drawn(audited, question));
  }

  // The surface that the drive has to stay on; else lanes.
  std::vector<geometry::Ring> drawn_ground(const AuditedDrive& audited,
                                           const AuditQuestion& question,
                                           const Scene& scene) const {
    if (!audited.road) return drawn_lanes(audited, question, scene);
    std::vector<geometry::Ring> rings;
    for (const geometry::Polygon& polygon : audited.road->made->polygons_in_source) {
      rings.push_back(polygon.outer);
      rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
    }
    return rings;
  }

  // The vehicle's rectangle, grown by the margin on every side.
  geometry::VehicleShape inflated(const geometry::VehicleShape& shape) const {
    geometry::VehicleShape grown = shape;
    grown.length_m += 2.0 * options_.inflate_m;
    grown.width_m += 2.0 * options_.inflate_m;
    grown.rear_overhang_m += options_.inflate_m;
    return grown;
  }

  void write_report(const AuditedDrive& audited, const AuditQuestion& question,
                    const Scene& scene) const {
    if (report_.empty()) return;
    const map::Box2 around = drawn(audited, question);
    const Eigen::AlignedBox2d box(around.min_in_source, around.max_in_source);
    AuditSurroundings page{.name = audited.name,
                           .body = inflated(scene.shape),
                           .parts = question.inflated_parts(),
                           .clearance_m = options_.clearance_m,
                           .occupied = {},
                           .road_map = {},
                           .moving = question.moving_in_source,
                           .command = "roadbed audit " + against(),
                           .version = name_and_version(),
                           .crs = scene.crs(),
                           .sources = {}};
    if (scene.occupancy) {
      page.occupied = occupied_in(*scene.occupancy, question.heights(audited.audit.ground), box);
      page.sources.push_back(source("occupancy", hashed_once(occupancy_)));
    } else {
      page.clearance_m = margin_m_;
      if (!map_.empty()) page.sources.push_back(source("map", hashed_once(map_)));
    }
    if (scene.road_map != nullptr) page.road_map = map_around(*scene.road_map, box);
    if (!subjects_.is_swept() && !std::filesystem::is_directory(subjects_.file())) {
      page.sources.push_back(source("trajectory", hashed_input(subjects_.file())));
    }
    map::write_output(
        report_, drive_report_html(report_of_audit(audited.drive, audited.whole(), page)), force_);
  }

  void write_index(const std::vector<AuditedDrive>& audits, const AuditQuestion& question,
                   const Scene& scene) const {
    if (report_.empty()) return;
    const std::vector<geometry::BodyPart> parts = question.inflated_parts();
    std::vector<IndexedAudit> index;
    for (const AuditedDrive& audited : audits) {
      index.push_back(indexed(audited));
      if (!audited.fault.empty()) continue;
      const auto occupied = occupied_around(audited, question, scene);
      const std::vector<geometry::Ring> lanes = drawn_ground(audited, question, scene);
      index.back().pictures = close_ups(
          audited.whole(), {audited.drive, parts, occupied, lanes, question.moving_in_source});
    }
    map::write_output(report_, audit_index_html(index, suite(), name_and_version()), force_);
  }

  // "--occupancy street.bt --on drivable", as one would type it.
  std::string against() const {
    std::string words;
    if (!occupancy_.empty()) words = "--occupancy " + occupancy_.string();
    if (!on_.empty()) words += (words.empty() ? "--on " : " --on ") + on_;
    if (occupancy_.empty() && !map_.empty()) words += " --map " + map_.string();
    return words;
  }

  // What drives were audited against, by name.
  std::string suite() const {
    if (!occupancy_.empty()) return occupancy_.string();
    return map_.empty() ? on_ : map_.string();
  }

  static ReportSource source(const char* role, const CertifiedFile& file) {
    return {.role = role, .name = file.name, .sha256 = file.sha256};
  }

  // Of what many audits share.
  CertifiedFile hashed_once(const std::filesystem::path& file) const {
    return *inputs_->of<CertifiedFile>("hashed input", {file}, [&] {
      return std::make_shared<const CertifiedFile>(hashed_input(file));
    });
  }

  // Who checks a certificate hashes its files again.
  void refuse_certificate_of_streams() const {
    for (const auto& file : {occupancy_, subjects_.file(), vehicle_, map_, obstacles_}) {
      if (map::is_stream(file)) certified_file(file);  // says why not
    }
  }

  // Who checks it gets the drive as it was audited, and needs no options to read it.
  void refuse_certificate_of_logs() const {
    if (subjects_.is_swept() || subjects_.is_folder() || !saved_drive_.empty() ||
        is_drive_table(subjects_.file())) {
      return;
    }
    throw map::InputError({.file = map::input_name(subjects_.file()),
                           .found = "is no .csv of a drive, which certificates are about",
                           .needed = "--save-drive beside --certificate",
                           .remedy = "give it"});
  }

  void write_certificate(const AuditedDrive& audited, const AuditQuestion& question,
                         const Scene& scene) const {
    if (certificate_.empty()) return;
    const std::filesystem::path& drive = saved_drive_.empty() ? subjects_.file() : saved_drive_;
    CertificateFile file{.program = name_and_version(),
                         .trajectory = certified_file(drive),
                         .underside_m = from_height_m_,
                         .ground = {question.ground.kind, audited.audit.ground},
                         .least_measured = options_.least_measured,
                         .parts = audited.audit.certificates};
    if (scene.occupancy) file.occupancy = hashed_once(occupancy_);
    if (!obstacles_.empty() && scene.occupancy) {
      file.obstacles = certified_obstacles(obstacles_, question.moving_in_source);
    }
    if (!vehicle_.empty()) file.vehicle = certified_file(vehicle_);
    if (!map_.empty()) file.roads = hashed_once(map_);
    if (audited.road) file.surface = certified_surface(*audited.road, options_.inflate_m);
    map::write_output(certificate_, write_certificate_json(file), force_);
  }

  void write_files(const std::vector<AuditedDrive>& audits, const AuditQuestion& question,
                   const Scene& scene) const {
    if (!junit_.empty()) map::write_output(junit_, audits_junit(audits, suite()), force_);
    if (!geojson_.empty()) {
      map::write_output(geojson_, audits_geojson(audits, question, scene.crs()), force_);
    }
  }

  // To tell what a certificate has to be about from what is a default.
  std::optional<Argument> clearance_argument_, inflate_argument_, unknown_argument_,
      least_measured_argument_, from_height_argument_;
  std::shared_ptr<const Inputs> inputs_;
  std::filesystem::path occupancy_, vehicle_, map_, obstacles_, svg_, report_, certificate_, junit_,
      geojson_, saved_drive_, check_;
  AuditSubjects subjects_;
  planning::AuditOptions options_;
  std::string ground_;
  double from_height_m_ = map::HeightBand{}.from_m;
  std::optional<Argument> margin_argument_;
  std::string on_, rules_;
  double margin_m_ = 0.0, seam_m_ = planning::SurfaceRule{}.seam_m;
  bool json_ = false, force_ = false;
};

}  // namespace

std::unique_ptr<Command> make_audit_command() { return std::make_unique<AuditCommand>(); }

}  // namespace roadbed::tools::commands
