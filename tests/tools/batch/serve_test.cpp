#include "roadbed/tools/batch/serve_process.h"
#include "roadbed/tools/commands/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <streambuf>
#include <string>
#include <utility>
#include <vector>

#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/support/sha256sum.h"

namespace roadbed::tests {
namespace {

using nlohmann::json;
using testing::EndsWith;
using testing::HasSubstr;

const std::string kTownMap = (data_folder() / "town.xodr").string();

std::vector<json> served(const std::string& lines, const std::filesystem::path& folder) {
  std::istringstream in(lines);
  std::stringstream out;
  tools::serve(in, out, tools::job_kinds(), {.folder = folder});
  std::vector<json> results;
  for (std::string line; std::getline(out, line);) results.push_back(json::parse(line));
  return results;
}

json route_job(const std::string& to) {
  return {{"job", "route"},
          {"inputs", {kTownMap}},
          {"options", {{"from", "lane:1/0/-1@10"}, {"to", to}}}};
}

TEST(Serve, AnswersARouteJobWithTheDocumentOfTheCommand) {
  const TemporaryFolder folder;
  const auto results = served(route_job("lane:7/0/1@55").dump(), folder.path());
  const ProgramRun alone = run_roadbed(
      {"route", kTownMap, "--from", "lane:1/0/-1@10", "--to", "lane:7/0/1@55", "--json"});
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0]["status"], "done");
  EXPECT_EQ(results[0]["exit"], 0);
  EXPECT_EQ(results[0]["result"], json::parse(alone.out));
}

TEST(Serve, WritesTheFilesOfAnImportAsTheCommandAloneDoes) {
  const TemporaryFolder folder, other;
  const std::string alone = (other / "town.rbm").string();
  ASSERT_EQ(run_roadbed({"import", kTownMap, "-o", alone}).status, 0);
  const json job = {{"job", "import"}, {"inputs", {kTownMap}}};
  const json result = served(job.dump(), folder.path()).at(0);
  const auto hash = result["hash"].get<std::string>();
  ASSERT_EQ(result["files"], json({"files/" + hash.substr(0, 2) + "/" + hash + ".rbm"}));
  EXPECT_EQ(bytes_of(folder / result["files"][0].get<std::string>()), bytes_of(alone));
  EXPECT_GT(result["result"]["lanes"], 10);
}

TEST(Serve, TellsAnAnswerThatIsNoFromAnInputThatIsUnusable) {
  const TemporaryFolder folder;
  const std::string closed = "lane:1/0/-1@10";
  json no_route = route_job("lane:7/0/1@55");
  no_route["options"]["avoid"] = "road:7";
  json no_map = route_job(closed);
  no_map["inputs"] = {"nowhere.xodr"};
  const auto results = served(no_route.dump() + "\n" + no_map.dump() + "\n", folder.path());
  ASSERT_EQ(results.size(), 2U);
  EXPECT_EQ(results[0]["status"], "no");
  EXPECT_EQ(results[0]["exit"], 1);
  EXPECT_THAT(results[0]["reason"].get<std::string>(), HasSubstr("no route"));
  EXPECT_EQ(results[0]["result"]["found"], false);
  EXPECT_EQ(results[1]["status"], "failed");
  EXPECT_EQ(results[1]["cause"], "input");
  EXPECT_THAT(results[1]["reason"].get<std::string>(), HasSubstr("nowhere.xodr: no such file"));
  EXPECT_TRUE(results[1]["result"].is_null());
}

TEST(Serve, AnswersEveryBadLineWithItsReasonAndGoesOn) {
  const TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"{", "is not JSON"},
      {"[1]", "object"},
      {R"({"job":"fly"})", "one of import, validate, route, simulate, audit"},
      {R"({"job":"audit","job":"audit"})", "twice"},
      {R"({"job":"audit","speed":1})", "speed"},
      {R"({"job":"audit","options":{"trajectry":"a"}})", "is no option of audit"},
      {R"({"job":"audit","options":{"force":true}})", "is set by the batch"},
      {R"({"job":"validate","options":{"rules":true}})", "no option of a job"},
      {R"({"job":"audit","options":{"report":"a.html"}})", "the batch chooses"},
      {R"({"job":"audit","options":{"inflate":{"m":1}}})", "a text, a number, or a list"},
      {R"({"job":"route","options":{"matrix":1}})", "true or false"},
      {R"({"job":"simulate","inputs":["a"],"outputs":["timings"]})", "no output of simulate"},
      {R"({"job":"audit","outputs":["svg","svg"]})", "twice"},
      {R"({"job":"audit","outputs":["svg.../../x"]})", "no output of audit"},
  };
  std::string lines;
  for (const auto& [line, reason] : bad) lines += line + "\n";
  const auto results = served(lines + route_job("lane:7/0/1@55").dump(), folder.path());
  ASSERT_EQ(results.size(), bad.size() + 1);
  for (std::size_t i = 0; i < bad.size(); ++i) {
    EXPECT_EQ(results[i]["status"], "failed") << bad[i].first;
    EXPECT_EQ(results[i]["cause"], "line") << bad[i].first;
    EXPECT_THAT(results[i]["reason"].get<std::string>(), HasSubstr(bad[i].second));
  }
  EXPECT_EQ(results.back()["status"], "done");
}

TEST(Serve, RefusesAnOptionOfAWrongTypeAsTheCommandDoes) {
  const TemporaryFolder folder;
  const json job = {{"job", "audit"},
                    {"options", {{"occupancy", "a"}, {"trajectory", "b"}, {"inflate", "wide"}}}};
  const json result = served(job.dump(), folder.path()).at(0);
  EXPECT_EQ(result["status"], "failed");
  EXPECT_EQ(result["exit"], 2);
  EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr("inflate"));
}

TEST(Serve, CutsALineThatIsLongerThanAnyJobAndGoesOn) {
  const TemporaryFolder folder;
  const std::string endless(std::size_t{40} << 20, '[');
  const auto results = served(endless + "\n" + route_job("lane:7/0/1@55").dump(), folder.path());
  ASSERT_EQ(results.size(), 2U);
  EXPECT_THAT(results[0]["reason"].get<std::string>(), HasSubstr("longer than"));
  EXPECT_EQ(results[1]["status"], "done");
}

TEST(Serve, GivesAJobAnotherHashWhenAFileThatItReadsChanges) {
  const TemporaryFolder folder, inputs;
  std::filesystem::copy_file(kTownMap, inputs / "town.xodr");
  std::filesystem::copy_file(data_folder() / "town.bt", inputs / "town.bt");
  std::filesystem::copy_file(data_folder() / "drive.json", inputs / "drive.json");
  const json simulate = {{"job", "simulate"}, {"inputs", {(inputs / "drive.json").string()}}};
  const auto hash = [&] {
    return served(simulate.dump(), folder.path()).at(0)["hash"].get<std::string>();
  };
  const std::string first = hash();
  EXPECT_EQ(hash(), first);
  const auto add_space = [&](const char* name) {
    inputs.write(name, bytes_of(inputs / name) + " ");
  };
  add_space("drive.json");
  const std::string second = hash();
  EXPECT_NE(second, first);
  add_space("town.xodr");  // named by the scenario, not by the job
  EXPECT_NE(hash(), second);
}

json simulate_job(const std::filesystem::path& scenario) {
  return {{"job", "simulate"}, {"inputs", {scenario.string()}}};
}

TEST(Serve, TakesNothingThatAKilledProcessLeftForFilesOfTheJob) {
  const TemporaryFolder folder;
  const std::string line = simulate_job(data_folder() / "drive.json").dump();
  const json first = served(line, folder.path()).at(0);
  const auto hash = first["hash"].get<std::string>();
  const std::string own = "files/" + hash.substr(0, 2) + "/" + hash + "/";
  folder.write(own + ".report.html.4711-0", "half");
  folder.write(own + "older.csv", "");
  EXPECT_EQ(served(line, folder.path()).at(0), first);
  EXPECT_FALSE(std::filesystem::exists(folder / (own + "older.csv")));
}

/// Lines, before each of which something happens.
class LinesAndDeeds : public std::streambuf {
 public:
  struct Entry {
    std::function<void()> deed;
    std::string line;
  };
  explicit LinesAndDeeds(std::vector<Entry> entries) : entries_(std::move(entries)) {}

 protected:
  int_type underflow() override {
    if (next_ == entries_.size()) return traits_type::eof();
    Entry& entry = entries_[next_++];
    entry.deed();
    entry.line += '\n';
    setg(entry.line.data(), entry.line.data(), entry.line.data() + entry.line.size());
    return traits_type::to_int_type(entry.line.front());
  }

 private:
  std::vector<Entry> entries_;
  std::size_t next_ = 0;
};

TEST(Serve, AnswersFromTheMapAsItIsWhenTheJobBegins) {
  const TemporaryFolder folder, inputs;
  const std::string town = bytes_of(kTownMap);
  json job = route_job("lane:7/0/1@55");
  job["inputs"] = {inputs.write("town.xodr", town)};
  const auto write = [&](const std::string& bytes) {
    return [&inputs, bytes] { inputs.write("town.xodr", bytes); };
  };
  const auto nothing = [] {};
  LinesAndDeeds bytes({{nothing, job.dump()},
                       {nothing, job.dump()},
                       {write("<OpenDRIVE/>"), job.dump()},
                       {write(town), job.dump()}});
  std::istream in(&bytes);
  std::stringstream out;
  tools::serve(in, out, tools::job_kinds(),
               {.folder = folder.path(), .memory_bytes = 4'000'000'000});
  std::vector<json> results;
  for (std::string line; std::getline(out, line);) results.push_back(json::parse(line));
  ASSERT_EQ(results.size(), 4U);
  EXPECT_EQ(results[0]["status"], "done");
  EXPECT_EQ(results[1], results[0]);
  EXPECT_EQ(results[2]["status"], "failed");
  EXPECT_EQ(results[3], results[0]);
}

TEST(Serve, TakesTheHashThatWhoeverAsksKnowsAJobBy) {
  const TemporaryFolder folder;
  const std::string line = json{{"job", "import"}, {"inputs", {kTownMap}}}.dump();
  const json plain = served(line, folder.path()).at(0);
  const auto hash = plain["hash"].get<std::string>();
  EXPECT_EQ(served(hash + "\t" + line, folder.path()).at(0), plain);
}

TEST(Serve, SaysThatAnInputHasChangedSinceItsHashWasTakenAndLeavesNoFile) {
  const TemporaryFolder folder;
  const std::string line = json{{"job", "import"}, {"inputs", {kTownMap}}}.dump();
  const std::string other(64, 'a');
  const json result = served(other + "\t" + line, folder.path()).at(0);
  EXPECT_EQ(result["hash"], other);
  EXPECT_EQ(result["status"], "failed");
  EXPECT_EQ(result["cause"], "changed");
  EXPECT_TRUE(files_below(folder.path()).empty());
}

TEST(Serve, SaysThatAnInputChangedWhileTheJobRan) {
  const TemporaryFolder inputs;
  for (const char* name : {"town.xodr", "town.bt", "drive.json"}) {
    std::filesystem::copy_file(data_folder() / name, inputs / name);
  }
  // What it writes goes below the folder that it reads.
  const json result = served(simulate_job(inputs.path()).dump(), inputs / "out").at(0);
  EXPECT_EQ(result["status"], "failed");
  EXPECT_EQ(result["cause"], "changed");
  EXPECT_TRUE(result["files"].empty());
  EXPECT_TRUE(files_below(inputs / "out").empty());
}

// The bytes are those that the README of batches says.
TEST(Batch, KnowsAJobByWhatSha256sumMakesOfProgramJobAndInputs) {
  const TemporaryFolder folder;
  const json job = route_job("lane:7/0/1@55");
  const ProgramRun listed = run_roadbed(
      {"batch", folder.write("jobs.jsonl", job.dump()), "-o", folder / "out", "--list-missing"});
  std::string program =
      run_roadbed({"--version"}).out;  // "roadbed 0.1.0 (build ab, libraries cd)\n…"
  program = program.substr(0, program.find(')')).substr(std::string("roadbed ").size());
  program.replace(program.find("(build "), std::string("(build ").size(), "");
  program.replace(program.find(", libraries "), std::string(", libraries ").size(), " ");
  const json town = json::array({kTownMap, sha256sum_of(kTownMap)});
  const json identity = json::array(
      {program, "route", job["inputs"], job["options"], json::array(), json::array({town})});
  EXPECT_EQ(listed.out.substr(0, listed.out.find('\t')), sha256sum_of_bytes(identity.dump()));
}

TEST(Serve, KnowsAJobOfAnotherProgramByAnotherHash) {
  const TemporaryFolder folder, inputs;
  const std::string line = route_job("lane:7/0/1@55").dump();
  const std::string jobs = inputs.write("jobs.jsonl", line);
  const ProgramRun listed =
      run_roadbed({"batch", jobs, "-o", folder.path().string(), "--list-missing"});
  const json here = served(line, folder.path()).at(0);  // in the program of the tests
  EXPECT_THAT(listed.out, EndsWith("\t" + line + "\n"));
  EXPECT_NE(listed.out.substr(0, 64), here["hash"].get<std::string>());
}

TEST(Program, SaysTheBuildThatItsLinkerWroteIntoIt) {
  const std::string shown = run_roadbed({"--version"}).out;
  const std::size_t begin = shown.find("(build ") + 7, end = shown.find(", libraries ");
  ASSERT_EQ(end - begin, 40U) << shown;
  EXPECT_EQ(shown.find('\n'), end + 12 + 64 + 1);
  std::string note("GNU\0", 4);
  for (std::size_t i = begin; i < end; i += 2) {
    note += static_cast<char>(std::stoi(shown.substr(i, 2), nullptr, 16));
  }
  EXPECT_NE(bytes_of(program_file()).find(note), std::string::npos);
}

// An update of a library is another build id; here it is one library more.
TEST(Program, SaysAnotherHashOfItsLibrariesWhereOneIsAnother) {
  const std::string shown = run_roadbed({"--version"}).out;
  EXPECT_EQ(run_roadbed({"--version"}).out, shown);
  const TemporaryFolder folder;
  const std::string library = (folder / "libmore.so").string();
  const std::string make =
      "echo 'int roadbed_more = 1;' | c++ -shared -fPIC -Wl,--build-id=sha1 "
      "-x c++ - -o '" +
      library + "'";
  ASSERT_EQ(std::system(make.c_str()), 0);
  ::setenv("LD_PRELOAD", library.c_str(), 1);
  ::setenv("ASAN_OPTIONS", "verify_asan_link_order=0", 1);  // where the program is sanitized
  const std::string other = run_roadbed({"--version"}).out;
  ::unsetenv("ASAN_OPTIONS");
  ::unsetenv("LD_PRELOAD");
  const std::size_t end = shown.find(", libraries ");
  EXPECT_EQ(other.substr(0, end), shown.substr(0, end));
  EXPECT_NE(other.substr(0, other.find('\n')), shown.substr(0, shown.find('\n')));
}

}  // namespace
}  // namespace roadbed::tests
