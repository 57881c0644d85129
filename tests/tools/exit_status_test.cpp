// 0 yes, 1 no, 2 wrong usage, 3 unusable input or output, 4 the program's own fault: of every
// command.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "roadbed/tests/support/program_commands.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/tools/line_of.h"

namespace roadbed::tests {
namespace {

using Words = std::vector<std::string>;

/// A command's words and what follows them.
Words with(Words command, const Words& more) {
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

class ExitStatus : public testing::Test {
 protected:
  void SetUp() override {
    // A post in the way of a drive along x.
    std::string post;
    for (int i = 0; i < 20; ++i) post += "10.05 0.05 " + std::to_string(0.1 * i) + "\n";
    post_ = folder_.write("post.xyz", post);
    drive_ = folder_.write("drive.csv", "t_s,x_m,y_m,heading_rad\n0,0,0,0\n10,20,0,0\n");
    a_ = folder_.write("a.json", R"({"driven_m": 1})");
    b_ = folder_.write("b.json", R"({"driven_m": 2})");
    jobs_ = folder_.write("jobs.jsonl", R"({"job":"validate","inputs":[")" + town_ +
                                            R"("],"options":{"max-slope":0,"fail-on":"info"}})"
                                            "\n");
  }

  std::string fresh(const std::string& suffix) {
    return folder_ / ("out" + std::to_string(++count_) + suffix);
  }

  /// What follows each command whose input is not there, or whose output is in the way where it has
  /// no input; `control design` has neither.
  std::map<std::string, Words> unusable() {
    const std::string none = folder_ / "none";
    const Words places{"--from", "lane:1/3/1@6", "--to", "lane:7/0/1@35"};
    return {
        {"import", {none, "-o", fresh(".rbm")}},
        {"info", {none}},
        {"validate", {none}},
        {"export", {none, "-o", fresh(".svg")}},
        {"convert", {none, fresh(".svg")}},
        {"diff", {none, none}},
        {"map diff", {none, none}},
        {"map clip", {none, "--bbox=0,0,1,1", "-o", fresh(".xodr")}},
        {"map merge", {none, none, "-o", fresh(".xodr")}},
        {"map transform", {none, "--turn", "1", "-o", fresh(".xodr")}},
        {"map tile", {none, "100", "-o", fresh("")}},
        {"map stats", {none}},
        {"map query", {none, "type = driving"}},
        {"map fix", {none, "-o", fresh(".xodr")}},
        {"locate", {none, "--at", "0,0"}},
        {"route", with({none}, places)},
        {"reach", {none, "--from", "lane:1/3/1@6", "--within", "5s"}},
        {"reference", with(with({none}, places), {"-o", fresh(".csv")})},
        {"plan", {none, "-o", fresh("")}},
        {"simulate", {none, "-o", fresh("")}},
        {"pilot", {none, "--goal", "0,0"}},
        {"occupancy build", {none, "-o", fresh(".bt")}},
        {"occupancy info", {none}},
        {"occupancy export", {none, "-o", fresh(".pgm")}},
        {"occupancy diff", {none, none}},
        {"occupancy crop", {none, "--heights=0,1", "-o", fresh(".bt")}},
        {"occupancy merge", {none, none, "-o", fresh(".bt")}},
        {"occupancy objects", {none, "-o", fresh(".csv")}},
        {"drive info", {none}},
        {"audit", {"--occupancy", none, "--trajectory", drive_, "--svg", fresh(".svg")}},
        {"figures", {"-o", folder_.path()}},
        {"report compare", {none, none}},
        {"report drive", {none, "-o", fresh(".html")}},
        {"batch", {none, "-o", fresh("")}},
        {"jobs import", {none, "-o", fresh(".jsonl")}},
        {"jobs validate", {none, "-o", fresh(".jsonl")}},
        {"jobs route", with({none, "-o", fresh(".jsonl")}, places)},
        {"jobs simulate", {none, "-o", fresh(".jsonl")}},
        {"jobs audit", {"--occupancy", none, "--trajectory", none + "/*", "-o", fresh(".jsonl")}},
    };
  }

  TemporaryFolder folder_;
  const std::string town_ = data_folder() / "town.xodr";
  std::string post_, drive_, a_, b_, jobs_;
  int count_ = 0;
};

TEST_F(ExitStatus, IsTwoWhereTheCommandLineIsWrongOfEveryCommand) {
  for (const Words& command : commands_that_run()) {
    const ProgramRun run = run_roadbed(with(command, {"--no-such-option"}));
    EXPECT_EQ(run.status, 2) << line_of(command) << ": " << run.err;
    EXPECT_EQ(run.out, "") << line_of(command);
  }
  EXPECT_EQ(run_roadbed({}).status, 2);
  EXPECT_EQ(run_roadbed({"no-such-command"}).status, 2);
  EXPECT_EQ(run_roadbed({"map"}).status, 2);
  EXPECT_EQ(run_roadbed({"info", town_, "--threads", "0"}).status, 2);
}

TEST_F(ExitStatus, OfAWrongCommandLineComesWithOneLineThatNamesWhatWasMeant) {
  const auto said = [](const Words& words) { return run_roadbed(words).err; };
  EXPECT_EQ(said({"rout"}),
            "roadbed: there is no command rout; did you mean route? see: roadbed --help\n");
  EXPECT_EQ(said({"occupancy", "bild", "a.pcd"}),
            "roadbed occupancy: there is no command bild; did you mean build? see: roadbed "
            "occupancy --help\n");
  EXPECT_EQ(said({"occupancy"}),
            "roadbed occupancy: a command is required: build, info, export, diff, crop, merge, "
            "objects; see: roadbed "
            "occupancy --help\n");
  EXPECT_EQ(said({"route", town_, "--frm", "0,0"}),
            "roadbed route: there is no option --frm; did you mean --from? see: roadbed route "
            "--help\n");
  EXPECT_EQ(said({"info", town_, "more"}),
            "roadbed info: \"more\" is one argument too many; see: roadbed info --help\n");
  EXPECT_EQ(said({"info"}), "roadbed info: MAP is required; see: roadbed info --help\n");
  EXPECT_EQ(said({"control", "design", "--delay", "99"}),
            "roadbed control design: --delay: 99 is not a number from 0 to 50; see: roadbed "
            "control design --help\n");
}

TEST_F(ExitStatus, IsThreeWhereAnInputIsMissingOfEveryCommandAndNothingIsLeft) {
  std::map<std::string, Words> left = unusable();
  const std::vector<std::string> before = files_below(folder_.path());
  for (const Words& command : commands_that_run()) {
    const std::string name = line_of(command);
    if (name == "control design" || name == "help") continue;  // neither reads a file
    ASSERT_TRUE(left.contains(name)) << name;
    const ProgramRun run = run_roadbed(with(command, left.at(name)));
    EXPECT_EQ(run.status, 3) << name << ": " << run.err;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << name << ": " << run.err;
    EXPECT_TRUE(run.err.starts_with("roadbed: ")) << name << ": " << run.err;
    EXPECT_EQ(run.out, "") << name;
    left.erase(name);
  }
  EXPECT_TRUE(left.empty()) << left.begin()->first;
  EXPECT_EQ(files_below(folder_.path()), before);
}

TEST_F(ExitStatus, IsOneWhereTheAnswerIsNo) {
  const Words closed{"--from", "lane:1/3/1@6", "--to", "lane:7/0/1@35", "--avoid", "road:7"};
  const std::string octree = fresh(".bt");
  ASSERT_EQ(run_roadbed({"occupancy", "build", post_, "-o", octree}).status, 0);
  const std::vector<Words> commands{
      {"validate", town_, "--max-slope", "0", "--fail-on", "info"},
      {"map", "diff", town_, data_folder() / "ramp.xodr"},
      {"diff", town_, data_folder() / "ramp.xodr"},
      {"locate", town_, "--at", "1e6,1e6"},
      with({"route", town_}, closed),
      with({"reference", town_, "-o", fresh(".csv")}, closed),
      {"reach", town_, "--from", "lane:1/3/1@6", "--within", "5s", "--avoid", "road:1"},
      {"audit", "--occupancy", octree, "--trajectory", drive_, "--unknown", "free"},
      {"report", "compare", a_, b_, "--max", "driven_m=1"},
      {"batch", jobs_, "-o", fresh("")},
  };
  for (const Words& words : commands) {
    const ProgramRun run = run_roadbed(words);
    EXPECT_EQ(run.status, 1) << line_of(words) << ": " << run.err;
    EXPECT_NE(run.out + run.err, "") << line_of(words);
  }
}

TEST_F(ExitStatus, IsThreeWhereAnOutputIsInTheWayAndItStaysAsItIs) {
  const std::string file = folder_.write("there.svg", "kept");
  for (const Words& words : std::vector<Words>{
           {"export", town_, "-o", file},
           {"route", town_, "--from", "lane:1/3/1@6", "--to", "lane:7/0/1@35", "-o", file},
           {"validate", town_, "--svg", file}}) {
    EXPECT_EQ(run_roadbed(words).status, 3) << line_of(words);
    EXPECT_EQ(bytes_of(file), "kept");
  }
}

TEST_F(ExitStatus, QuietSilencesNotesAndNoErrorOfEveryCommand) {
  std::map<std::string, Words> wrong = unusable();
  for (auto& [name, words] : wrong) {
    Words line;
    std::istringstream parts(name);
    for (std::string part; parts >> part;) line.push_back(part);
    const ProgramRun loud = run_roadbed(with(line, words));
    const ProgramRun quiet = run_roadbed(with(with(line, words), {"-q"}));
    EXPECT_EQ(quiet.err, loud.err) << name;
    EXPECT_EQ(quiet.status, loud.status) << name;
  }
  const std::string octree = fresh(".bt"), scenario = data_folder() / "scenarios/parked_car.json";
  const std::string drive = fresh("");
  const Words places{"--from", "lane:1/3/1@6", "--to", "lane:7/0/1@35"};
  for (const Words& words : std::vector<Words>{
           {"import", town_, "-o", fresh(".rbm")},
           {"info", town_},
           {"validate", town_},
           {"export", town_, "-o", fresh(".osm")},
           {"convert", town_, fresh(".svg")},
           {"diff", town_, town_},
           {"locate", town_, "--at", "150,198"},
           with({"route", town_}, places),
           {"reach", town_, "--from", "lane:1/3/1@6", "--within", "5s"},
           with({"reference", town_, "-o", fresh(".csv")}, places),
           {"plan", scenario, "-o", fresh("")},
           {"control", "design"},
           {"drive", "info", drive_},
           {"simulate", scenario, "-o", drive},
           {"occupancy", "build", post_, "-o", octree},
           {"occupancy", "info", octree},
           {"occupancy", "export", octree, "-o", fresh(".pgm")},
           {"occupancy", "diff", octree, octree},
           {"occupancy", "crop", octree, "--heights=0,1", "-o", fresh(".bt")},
           {"occupancy", "merge", octree, octree, "-o", fresh(".bt")},
           {"audit", "--occupancy", octree, "--trajectory", drive_, "--unknown", "free"},
           {"report", "compare", a_, b_},
           {"batch", jobs_, "-o", fresh("")},
           {"jobs", "validate", town_, "-o", fresh(".jsonl")}}) {
    const ProgramRun run = run_roadbed(with(words, {"--quiet"}));
    EXPECT_LE(run.status, 1) << line_of(words) << ": " << run.err;
    EXPECT_EQ(run.err, "") << line_of(words);
  }
}

TEST_F(ExitStatus, IsFourWhereMemoryIsShort) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer reserves more memory than a limit could leave.";
#endif
  const std::string big = folder_.write("big.xodr", "<OpenDRIVE>"), out = fresh(".rbm");
  std::filesystem::resize_file(big, std::uintmax_t{4} << 30);  // takes no place on the disk
  const std::string err = folder_ / "err";
  const int ended = std::system(("ulimit -v 1000000; exec " + program_file().string() + " import " +
                                 big + " -o " + out + " 2> " + err)
                                    .c_str());
  EXPECT_EQ(WEXITSTATUS(ended), 4);
  EXPECT_EQ(bytes_of(err), "roadbed: out of memory\n");
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace roadbed::tests
