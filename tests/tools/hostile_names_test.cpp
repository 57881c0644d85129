// Names that hold everything that a terminal, a log or a spreadsheet acts on, through every
// command: every byte of every output is looked at.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// A line break before =1+1 and FORGED: neither may begin a line or a field anywhere.
const std::string kName =
    "\n=1+1<b>\"',;\xE2\x80\xA8\xE2\x80\xAE\xE2\x81\xA6\xE2\x80\x8F\xD8\x9C\x1b[31mRED\x1b]0;"
    "pwn\x07"
    "\xC2\x9B"
    "31m\xC2\x85\r\nFORGED clear\rCR\t\x7f";

/// The same in an attribute of XML.
std::string in_xml(const std::string& text) {
  std::string written;
  for (const char sign : text) {
    const auto code = static_cast<unsigned char>(sign);
    const bool by_number =
        code < 0x20 || code == 0x7F || std::string("<>&\"'").find(sign) != std::string::npos;
    written += by_number ? fmt::format("&#{};", code) : std::string(1, sign);
  }
  return written;
}

/// Every bad thing in an output: as JSON, so that a failure shows it. The tables of bytes are
/// written out here again, and not taken from what is tested.
std::string faults_in(const std::string& bytes) {
  static const std::regex hidden(
      "[\\x01-\\x08\\x0b-\\x1f\\x7f]|\xC2[\x80-\x9F]|\xE2\x80[\x8E\x8F\xA8-\xAE]|\xE2\x81[\xA6-"
      "\xA9]|"
      "\xD8\x9C|\n=1|\n\"=|,=1|,\"=|\nFORGED",
      std::regex::optimize);
  std::string faults;
  for (auto found = std::sregex_iterator(bytes.begin(), bytes.end(), hidden);
       found != std::sregex_iterator() && faults.size() < 400; ++found) {
    const auto at = static_cast<std::size_t>(found->position());
    const std::string around = bytes.substr(at < 20 ? 0 : at - 20, 40);
    faults += nlohmann::json(around).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  }
  if (bytes.find('\0') != std::string::npos) faults += " a zero";
  return faults;
}

/// Databases and what only roadbed reads keep texts as they are.
bool is_binary(const std::string& name) {
  const std::string suffix = fs::path(name).extension().string();
  for (const char* binary : {".gpkg", ".fgb", ".rbm", ".bt"}) {
    if (suffix == binary) return true;
  }
  return false;
}

class HostileNames : public testing::Test {
 protected:
  HostileNames() {
    fs::copy(data_folder() / "town.bt", folder_ / "town.bt");
    folder_.write("town.xodr", hostile_town());
    folder_.write("drive.json", hostile_drive());
    fs::create_directory(folder_ / "out");
  }

  static std::string hostile_town() {
    std::string town = bytes_of(data_folder() / "town.xodr");
    const std::string name = in_xml(kName);
    const std::string filled = std::regex_replace(name, std::regex("\\$"), "$$$$");
    for (const char* attribute :
         {"(<road name=\")[^\"]*\"", "(<junction name=\")[^\"]*\"",
          "(<header [^>]*?name=\")[^\"]*\"", "(<signal [^>]*?name=\")[^\"]*\""}) {
      town = std::regex_replace(town, std::regex(attribute), "$1" + filled + "\"");
    }
    for (const char* id : {"(<road [^>]*?\\bid=\")7\"", "(elementId=\")7\"",
                           "((?:incomingRoad|connectingRoad|linkedRoad)=\")7\""}) {
      town = std::regex_replace(town, std::regex(id), "$1" + filled + "\"");
    }
    return town;
  }

  static std::string hostile_drive() {
    nlohmann::json drive = nlohmann::json::parse(bytes_of(data_folder() / "drive.json"));
    drive["name"] = kName;
    drive["duration_s"] = 2.0;
    drive["goal"] = "lane:1/3/1@80";
    drive["obstacles"].erase(3);  // drives on the road whose id is hostile
    drive["obstacles"].erase(2);
    for (auto& obstacle : drive["obstacles"]) {
      obstacle["id"] = obstacle["id"].get<std::string>() + kName;
      obstacle["kind"] = kName;
    }
    return drive.dump();
  }

  std::string in(const std::string& name) const { return (folder_ / name).string(); }
  std::string out(const std::string& name) const { return (folder_ / "out" / name).string(); }

  ProgramRun run(const Words& words) const {
    const ProgramRun ended = run_roadbed(words);
    std::string line;
    for (const std::string& word : words) line += word.substr(0, 60) + " ";
    EXPECT_TRUE(ended.status <= 1 || ended.status == 3) << line << ended.err;
    EXPECT_EQ(ended.err.find("internal error"), std::string::npos) << ended.err;
    EXPECT_EQ(faults_in(ended.out), "") << line;
    EXPECT_EQ(faults_in(ended.err), "") << line;
    return ended;
  }

  ~HostileNames() override {
    for (const std::string& name : files_below(folder_ / "out")) {
      if (is_binary(name)) continue;
      EXPECT_EQ(faults_in(bytes_of(folder_ / "out" / name)), "") << name;
    }
  }

  TemporaryFolder folder_;
};

TEST_F(HostileNames, NoCommandOnAMapLetsOneThrough) {
  run({"import", in("town.xodr"), "-o", out("town.rbm")});
  for (const std::string& map : {in("town.xodr"), out("town.rbm")}) {
    run({"info", map});
    run({"info", map, "--json"});
    run({"locate", map, "--at", "150,196"});
    run({"locate", map, "--at", "150,196", "--json"});
    run({"map", "diff", (data_folder() / "town.xodr").string(), map});
    run({"map", "diff", (data_folder() / "town.xodr").string(), map, "--json"});
    for (const char* suffix : {"geojson", "svg", "csv", "osm", "xml", "gpkg", "fgb"}) {
      const ProgramRun ended =
          run({"export", map, "-o", out(std::string("map.") + suffix), "--force"});
      EXPECT_EQ(ended.status, 0) << ended.err;
    }
  }
  EXPECT_NE(bytes_of(out("map.csv")).find("\"' =1+1<b>\"\""), std::string::npos);
  for (const Words& more : {Words{}, Words{"--json"}}) {
    Words words = {"validate",       in("town.xodr"), "--force",      "--junit",
                   out("v.xml"),     "--sarif",       out("v.sarif"), "--geojson",
                   out("v.geojson"), "--svg",         out("v.svg")};
    words.insert(words.end(), more.begin(), more.end());
    run(words);
  }
}

TEST_F(HostileNames, NoAnswerAboutRoutesLetsOneThrough) {
  folder_.write("pairs.csv",
                "from,to\n\"=1+1\x1b[31m\xE2\x80\xAE\r x\",lane:6/0/1\nlane:1/3/1@6,lane:6/0/1\n"
                "\"-150,196\",@x\n");
  for (const char* suffix : {"csv", "geojson", "svg"}) {
    run({"route", in("town.xodr"), "--from", "lane:1/3/1@6", "--to", "lane:6/0/1", "-o",
         out(std::string("route.") + suffix)});
    run({"reach", in("town.xodr"), "--from", "lane:1/3/1@6", "--within", "120s", "-o",
         out(std::string("reach.") + suffix)});
  }
  // From before the road of the hostile id onto it: its name is in the answer.
  EXPECT_NE(bytes_of(out("reach.csv")).find("FORGED"), std::string::npos);
  run({"route", in("town.xodr"), "--batch", in("pairs.csv"), "-o", out("answers.csv")});
  run({"route", in("town.xodr"), "--batch", in("pairs.csv"), "--json"});
  run({"route", in("town.xodr"), "--batch", in("pairs.csv"), "--matrix", "-o", out("matrix.csv")});
  run({"route", in("town.xodr"), "--from", "lane:" + kName, "--to", "150,196"});
}

TEST_F(HostileNames, NoPlanDriveOrAuditLetsOneThrough) {
  run({"plan", in("drive.json"), "-o", out("plan")});
  run({"simulate", in("drive.json"), "-o", out("drive")});
  run({"report", "compare", out("drive"), out("drive")});
  fs::create_directory(folder_ / "drives");
  for (const std::string& name : {"a" + kName.substr(0, 80), std::string("=b\x07")}) {
    std::string file = std::regex_replace(name, std::regex("/"), "_") + ".csv";
    fs::copy(out("drive/trajectory.csv"), folder_ / ("drives/" + file));
  }
  const std::string obstacle = "\"=1+1\x1b[31m\xE2\x80\xAE\xC2\x9B\r x\",150,196.7,0,4,2\n";
  folder_.write("others.csv",
                "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n0," + obstacle + "10," + obstacle);
  run({"audit", "--occupancy", in("town.bt"), "--trajectory", out("drive/trajectory.csv"), "--map",
       in("town.xodr"), "--obstacles", in("others.csv"), "--junit", out("a.xml"), "--geojson",
       out("a.geojson"), "--svg", out("a.svg"), "--report", out("a.html"), "--certificate",
       out("a.cert")});
  run({"audit", "--check", out("a.cert")});
  run({"audit", "--occupancy", in("town.bt"), "--trajectory", in("drives"), "--junit", out("b.xml"),
       "--report", out("b.html")});
  run({"audit", "--occupancy", in("town.bt"), "--trajectory", in("drives"), "--json"});
  run({"jobs", "audit", "--occupancy", in("town.bt"), "--trajectory", in("drives/*.csv"), "-o",
       out("jobs.jsonl")});
  run({"batch", out("jobs.jsonl"), "-o", out("batch")});
}

TEST_F(HostileNames, NoRefusalLetsOneThrough) {
  const std::string jobs = folder_.write(
      "jobs.jsonl",
      nlohmann::json{
          {"job", "validate"}, {"inputs", {kName}}, {"options", nlohmann::json::object()}}
              .dump() +
          "\nno\x1b[31m job\xE2\x80\xAE\n" + nlohmann::json{{"job", kName}}.dump() + "\n");
  run({"batch", jobs, "-o", out("batch")});
  run({"info", in(kName + ".xodr")});
  run({"simulate", folder_.write("v.json", nlohmann::json{{kName, 1}}.dump()), "-o", out("d")});
  folder_.write("a" + kName.substr(0, 40) + ".xodr", "<OpenDRIVE>" + kName);
  run({"info", in("a" + kName.substr(0, 40) + ".xodr")});
}

TEST_F(HostileNames, NoSystemOfCoordinatesLetsOneThrough) {
  std::string octree = bytes_of(folder_ / "town.bt");
  const std::size_t end = octree.find('\n', octree.find("# roadbed origin"));
  folder_.write("other.bt", octree.substr(0, end) + " \x1b[31m\xC2\x9B\xE2\x80\xAE\rX\xFF" +
                                octree.substr(end));
  run({"occupancy", "info", in("other.bt")});
  run({"occupancy", "info", in("other.bt"), "--json"});
  run({"occupancy", "build", (data_folder() / "scans/scan_00.pcd").string(), "--crs", kName, "-o",
       out("built.bt")});
  run({"occupancy", "info", out("built.bt")});
}

}  // namespace
}  // namespace roadbed::tests
