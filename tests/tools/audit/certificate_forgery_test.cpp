// A campaign: fields of real certificates are forged, alone and in pairs, and every file that they
// name gets its right hash. What the check then accepts has to be true, by a new audit of what is
// claimed. ROADBED_FORGERIES says how many of each certificate, ROADBED_FORGERY_SEED another start.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/map/files/input_error.h"
#include "roadbed/map/files/read_file.h"
#include "roadbed/map/files/sha256.h"
#include "roadbed/planning/audit/vehicle_audit.h"
#include "roadbed/tests/support/part_distance.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tools/audit/audit_subjects.h"
#include "roadbed/tools/audit/audited_drive.h"
#include "roadbed/tools/audit/certificate_file_check.h"
#include "roadbed/tools/audit/certificate_json.h"
#include "roadbed/tools/batch/input_cache.h"
#include "roadbed/tools/cli/inputs.h"
#include "roadbed/tools/files/trajectory_csv.h"
#include "roadbed/tools/files/vehicle_file.h"

namespace roadbed::tools {
namespace {

namespace fs = std::filesystem;
using planning::Verdict;
using Json = nlohmann::json;
using Pointer = Json::json_pointer;

int count_from(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::atoi(text);
}

// ------------------------------------------------------------------------------------- forging

/// Where a scalar stands, and its place without the indices of lists: "/from_occupied/*/*".
struct Leaf {
  Pointer at;
  std::string kind;
};

void collect(const Json& json, const Pointer& at, const std::string& kind,
             std::vector<Leaf>& leaves) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) {
      collect(value, at / key, kind + "/" + key, leaves);
    }
  } else if (json.is_array()) {
    // Columns of a list's rows are fields of their own.
    for (std::size_t i = 0; i < json.size(); ++i) {
      const bool is_row = !json.empty() && !json.front().is_structured();
      collect(json[i], at / i, kind + (is_row ? "/" + std::to_string(i) : "/*"), leaves);
    }
  } else {
    leaves.push_back({at, kind});
  }
}

class Forger {
 public:
  Forger(const Json& honest, std::vector<std::string> files, unsigned seed)
      : honest_(honest), files_(std::move(files)), random_(seed) {
    std::vector<Leaf> leaves;
    collect(honest, Pointer(), "", leaves);
    for (const Leaf& leaf : leaves) by_kind_[leaf.kind].push_back(leaf.at);
  }

  /// One field of each kind after the other, `at_once` of them.
  Json forged(int number, int at_once) {
    Json forgery = honest_;
    what_.clear();
    for (int i = 0; i < at_once; ++i) {
      const bool in_turn = i == 0;
      const auto& [kind, places] =
          *std::next(by_kind_.begin(), in_turn ? number % static_cast<int>(by_kind_.size())
                                               : pick(static_cast<int>(by_kind_.size())));
      const Pointer at = places[static_cast<std::size_t>(pick(static_cast<int>(places.size())))];
      if (forgery.contains(at)) forge(forgery, at, kind);
    }
    set_right_hashes(forgery);
    return forgery;
  }

  const std::string& what() const { return what_; }
  std::size_t kinds() const { return by_kind_.size(); }

 private:
  int pick(int count) { return std::uniform_int_distribution(0, count - 1)(random_); }

  void forge(Json& forgery, const Pointer& at, const std::string& kind) {
    Json& value = forgery[at];
    const int way = pick(8);
    if (way == 0) {
      remove(forgery, at);
    } else if (value.is_number()) {
      value = number(value.get<double>());
      if (kind.ends_with("/0") && kind.starts_with("/from_")) value = std::abs(value.get<double>());
    } else if (value.is_string()) {
      value = word(kind);
    }
    what_ += fmt::format("{}{} ", at.to_string(), way == 0 ? " removed" : "");
  }

  // A number in a row takes the row with it.
  void remove(Json& forgery, const Pointer& at) {
    Pointer gone = at;
    if (forgery[gone.parent_pointer()].is_array()) gone = gone.parent_pointer();
    Json& parent = forgery[gone.parent_pointer()];
    if (parent.is_array()) {
      parent.erase(static_cast<std::size_t>(std::stoul(gone.back())));
    } else {
      parent.erase(gone.back());
    }
  }

  double number(double honest) {
    constexpr std::array steps{1e-4, 1e-3, 0.01, 0.1, 1.0, 10.0};
    switch (pick(5)) {
      case 0:
        return honest + steps[static_cast<std::size_t>(pick(6))];
      case 1:
        return honest - steps[static_cast<std::size_t>(pick(6))];
      case 2:
        return honest * 1.01;
      case 3:
        return 0.0;
      default:
        return -honest;
    }
  }

  std::string word(const std::string& kind) {
    const auto one_of = [this](const std::vector<std::string>& words) {
      return words[static_cast<std::size_t>(pick(static_cast<int>(words.size())))];
    };
    if (kind.ends_with("verdict")) return one_of({"clear", "conflict", "unknown", "undecided"});
    if (kind == "/unknown_counts_as") return one_of({"free", "occupied", "report"});
    if (kind == "/heights_above/ground") return one_of({"level", "map", "measured"});
    if (kind.ends_with("/file")) return one_of(files_);
    return one_of({"body", "left mirror", "other"});
  }

  static void set_right_hashes(Json& forgery) {
    for (const char* role : {"occupancy", "trajectory", "vehicle_file", "map"}) {
      if (!forgery.contains(role) || !forgery[role].contains("file")) continue;
      const fs::path file = forgery[role]["file"].get<std::string>();
      if (fs::is_regular_file(file)) forgery[role]["sha256"] = map::sha256_of_file(file);
    }
  }

  Json honest_;
  std::vector<std::string> files_;
  std::mt19937 random_;
  std::map<std::string, std::vector<Pointer>> by_kind_;
  std::string what_;
};

// -------------------------------------------------------------------------------- what is true

constexpr double kSlack_m = 1e-5;

bool is_weaker_or_same(Verdict claimed, Verdict found) {
  return claimed == found || claimed == Verdict::undecided || claimed == Verdict::unknown;
}

planning::AuditQuestion question_of(const CertificateFile& file, const map::RoadMap* road_map,
                                    const Inputs& inputs) {
  const Vehicle vehicle = file.vehicle ? read_vehicle(file.vehicle->name) : Vehicle{};
  const planning::AuditCertificate& first = file.parts.front();
  planning::AuditQuestion question{.parts = vehicle.parts(file.underside_m),
                                   .ground = {.kind = file.ground.kind,
                                              .level_m = file.ground.under.level_m,
                                              .road_map = road_map},
                                   .options = {.clearance_m = first.clearance_m,
                                               .inflate_m = first.inflate_m,
                                               .unknown = first.unknown_policy,
                                               .least_measured = file.least_measured}};
  if (file.obstacles) {
    question.moving_in_source = read_moving_obstacles(file.obstacles->name, inputs);
  }
  return question;
}

/// What a new audit finds of what a certificate claims, from the files that it names.
class Truth {
 public:
  Truth(const CertificateFile& file, const Inputs& inputs)
      : file_(file),
        occupancy_(inputs.occupancy(file.occupancy->name)),
        road_map_(file.roads ? inputs.road_map(file.roads->name) : nullptr),
        drive_(read_trajectory_csv(file.trajectory.name)),
        question_(question_of(file, road_map_.get(), inputs)),
        around_(*occupancy_, ground_below(), question_.parts,
                planning::audited_region(drive_, question_.parts, question_.options)),
        audit_(planning::audit_vehicle(around_, drive_, question_.options,
                                       question_.moving_in_source)) {}

  /// What is not true; empty: all is.
  std::string untruth() const {
    if (file_.parts.size() != question_.parts.size()) return "other parts";
    if (!is_weaker_or_same(file_.verdict(), audit_.whole.verdict)) return "the verdict";
    for (std::size_t i = 0; i < file_.parts.size(); ++i) {
      for (const auto& look : {&Truth::of_numbers, &Truth::of_shape, &Truth::of_heights,
                               &Truth::of_spans, &Truth::of_observed, &Truth::of_conflicts}) {
        if (std::string wrong = (this->*look)(i); !wrong.empty()) return wrong;
      }
    }
    return {};
  }

 private:
  planning::GroundUnder ground_below() const {
    map::BodyReach body;
    for (const geometry::BodyPart& part : question_.inflated_parts()) {
      body.rear_m = std::min(body.rear_m, part.rear_m - part.radius_m);
      body.front_m = std::max(body.front_m, part.front_m + part.radius_m);
    }
    return planning::ground_under(*occupancy_, drive_, question_.ground, body);
  }

  std::string of_numbers(std::size_t i) const {
    const planning::AuditCertificate& claims = file_.parts[i];
    const planning::AuditReport& found = audit_.of_parts[i];
    if (!is_weaker_or_same(claims.verdict, found.verdict)) return "a part's verdict";
    if (claims.certified_clearance_m > found.least_clearance_m + kSlack_m) return "certified";
    const double fraction = 1.0 - found.unknown_fraction;
    return std::abs(claims.measured_fraction - fraction) > 2.5e-3 ? "measured share" : "";
  }

  std::string of_shape(std::size_t i) const {
    const geometry::BodyPart &a = file_.parts[i].part, &b = question_.parts[i];
    const double most_m = std::max({std::abs(a.rear_m - b.rear_m), std::abs(a.front_m - b.front_m),
                                    std::abs(a.right_m - b.right_m), std::abs(a.left_m - b.left_m),
                                    std::abs(a.radius_m - b.radius_m)});
    return most_m > kSlack_m ? "measures of a part" : "";
  }

  // Above a map's road to 2 mm, above what was measured to a third of a cell.
  std::string of_heights(std::size_t i) const {
    const bool is_measured = file_.ground.kind == planning::GroundRule::Kind::measured;
    const double within_m = 2e-3 + (is_measured ? 0.35 * occupancy_->resolution_m() : 0.0);
    for (const geometry::TrajectoryPoint& row : drive_.points()) {
      const auto ends = [&](const map::HeightBand& band) {
        const double ground_m = band.ground ? band.ground->height_m(row.pose().position()) : 0.0;
        return Eigen::Vector2d(band.from_m + ground_m, band.to_m + ground_m);
      };
      const Eigen::Vector2d off = ends(file_.parts[i].band) - ends(around_.band_of(i));
      if (off.cwiseAbs().maxCoeff() > within_m) return "heights";
    }
    return {};
  }

  std::string of_spans(std::size_t i) const {
    const planning::AuditCertificate& claims = file_.parts[i];
    const bool do_keep = keep(i, claims.from_occupied, map::ObstacleKind::occupied) &&
                         keep(i, claims.from_unknown, map::ObstacleKind::unknown);
    return do_keep ? "" : "a span";
  }

  bool keep(std::size_t i, const std::vector<planning::ProvenSpan>& spans,
            map::ObstacleKind kind) const {
    const planning::AuditCertificate& claims = file_.parts[i];
    const geometry::BodyPart body = geometry::inflated(claims.part, claims.inflate_m);
    return std::ranges::all_of(spans, [&](const planning::ProvenSpan& span) {
      for (const double fraction : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const auto state =
            geometry::interpolate(drive_.points()[span.segment], drive_.points()[span.segment + 1],
                                  span.from + fraction * (span.to - span.from));
        const double away_m = span.at_least_m + body.radius_m;
        const auto nearest = around_.field_of(i).nearest(body.core_at(state.pose()), away_m, kind);
        if (nearest && nearest->distance_m < away_m - kSlack_m) return false;
      }
      return true;
    });
  }

  std::string of_observed(std::size_t i) const {
    const double cell_m = occupancy_->resolution_m();
    for (const planning::ObservedTime& time : file_.parts[i].observed) {
      const Eigen::Vector2d& at = time.column_in_source;
      const map::OccupancyCell column{{at.x(), at.y(), 0.0}, cell_m, map::CellState::free};
      for (const double t_s : {time.from_s, 0.5 * (time.from_s + time.to_s), time.to_s}) {
        const double away_m =
            tests::part_to_cell_m(question_.parts[i], 0.0, drive_.at(t_s).pose(), column);
        if (away_m > planning::kObservedWithin_m + cell_m) return "what was looked at";
      }
    }
    return {};
  }

  std::string of_conflicts(std::size_t i) const {
    constexpr double same_s = 0.1;
    const bool are_real =
        std::ranges::all_of(file_.parts[i].conflicts, [&](const planning::Conflict& claimed) {
          return std::ranges::any_of(audit_.of_parts[i].conflicts,
                                     [&](const planning::Conflict& real) {
                                       return real.from_s - same_s <= claimed.at.t_s &&
                                              claimed.at.t_s <= real.to_s + same_s;
                                     });
        });
    return are_real ? "" : "a conflict";
  }

  const CertificateFile& file_;
  std::shared_ptr<const map::OccupancySource> occupancy_;
  std::shared_ptr<const map::RoadMap> road_map_;
  geometry::Trajectory drive_;
  planning::AuditQuestion question_;
  planning::VehicleSurroundings around_;
  planning::VehicleAudit audit_;
};

// ---------------------------------------------------------------------------------- the campaign

class CertificateForgery : public testing::Test {
 protected:
  static std::string data(const std::string& name) {
    return (tests::data_folder() / name).string();
  }

  void SetUp() override {
    mirrors_ =
        folder_.write("mirrors.json", R"({"mirrors":{"beyond_m":0.2,"rear_m":1.7,"front_m":1.9,)"
                                      R"("from_height_m":0.9,"to_height_m":1.2}})");
    wide_ = folder_.write("wide.json", R"({"width_m":3.2,"length_m":9.0})");
    boxes_ = folder_.write("boxes.csv",
                           "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n"
                           "0,crossing,150,170,1.57,4.5,1.8\n30,crossing,150,230,1.57,4.5,1.8\n");
  }

  // A drive along a lane of the town, and its certificate.
  std::string certificate(const std::string& number, std::vector<std::string> more) {
    const std::string proof = folder_ / ("proof" + number + ".json");
    more.insert(more.begin(),
                {"audit", "--occupancy", data("town.bt"), "--map", data("town.xodr"), "--lane",
                 "lane:1/2/1@5", "--save-drive", folder_ / ("drive" + number + ".csv"),
                 "--certificate", proof, "--json", "--quiet"});
    const tests::ProgramRun run = tests::run_roadbed(more);
    EXPECT_TRUE(fs::exists(proof)) << run.err;
    return proof;
  }

  tests::TemporaryFolder folder_;
  std::string mirrors_, wide_, boxes_;
};

TEST_F(CertificateForgery, OfOneFieldOrTwoIsRefusedUnlessWhatItClaimsIsTrue) {
  const std::vector<std::string> proofs{
      certificate("1", {"--unknown", "report"}),
      certificate("2", {"--unknown", "free", "--vehicle", mirrors_, "--ground", "0"}),
      certificate("3", {"--unknown", "occupied", "--offset", "0.6", "--clearance", "0.3"}),
      certificate("4", {"--unknown", "free", "--obstacles", boxes_, "--inflate", "0.2"}),
      certificate("5", {"--unknown", "free", "--vehicle", wide_, "--offset", "-1"})};
  const std::vector<std::string> files{mirrors_,
                                       wide_,
                                       data("town.xodr"),
                                       data("town.bt"),
                                       folder_ / "drive1.csv",
                                       folder_ / "drive3.csv",
                                       folder_ / "none"};
  const int forgeries = count_from("ROADBED_FORGERIES", 40);
  const auto seed = static_cast<unsigned>(count_from("ROADBED_FORGERY_SEED", 1));
  FileHashes hashes;
  const InputCache inputs(hashes, std::numeric_limits<std::uint64_t>::max(), [] { return 0U; });
  int refused = 0, unusable = 0, true_ones = 0, false_ones = 0;
  for (std::size_t k = 0; k < proofs.size(); ++k) {
    const Json honest = Json::parse(tests::bytes_of(proofs[k]));
    std::ostringstream said;
    ASSERT_TRUE(check_certificate_file(proofs[k], {}, false, inputs, said)) << said.str();
    Forger forger(honest, files, seed + static_cast<unsigned>(k));
    for (int i = 0; i < forgeries; ++i) {
      const Json forgery = forger.forged(i, 1 + i % 2);
      if (forgery == honest) continue;
      const std::string file = folder_.write("forged.json", forgery.dump());
      try {
        std::ostringstream out;
        if (!check_certificate_file(file, {}, true, inputs, out)) {
          ++refused;
          continue;
        }
        const CertificateFile claims = read_certificate_json(file);
        const std::string wrong = Truth(claims, inputs).untruth();
        (wrong.empty() ? true_ones : false_ones) += 1;
        EXPECT_EQ(wrong, "") << "certificate " << k + 1 << ", forged " << forger.what();
      } catch (const map::InputError&) {
        ++unusable;
      }
    }
  }
  fmt::print("forgeries: {} refused, {} unusable, {} accepted and true, {} accepted and false\n",
             refused, unusable, true_ones, false_ones);
  EXPECT_GT(refused, 2 * true_ones);
}

}  // namespace
}  // namespace roadbed::tools
