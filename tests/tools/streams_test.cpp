// Inputs from standard input, pipes and packed files: the same answers as from the plain file.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "roadbed/tests/support/packed.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"

namespace roadbed::tests {
namespace {

using testing::HasSubstr;

std::string data(const std::string& name) { return data_folder() / name; }

/// A command that reads one file: what stands for it is "IN".
struct Reading {
  std::string file;
  std::vector<std::string> words;
};

std::vector<std::string> with_input(std::vector<std::string> words, const std::string& input) {
  for (std::string& word : words) {
    if (word == "IN") word = input;
  }
  return words;
}

class Streams : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("points.csv", "x_m,y_m\n150,198\n160,200\n");
    folder_.write("pairs.csv",
                  "from,to\nlane:1/0/-1@10,lane:7/0/1@35\n\"150,198\",lane:7/0/1@35\n");
    folder_.write("drive.csv", "t_s,x_m,y_m,heading_rad\n0,150,198,0\n1,155,198,0\n");
    folder_.write("moving.csv", "t_s,id,x_m,y_m,heading_rad,length_m,width_m\n0,a,170,198,0,4,2\n");
    folder_.write("van.json", R"({"width_m": 1.9})");
    folder_.write("two.xyz", "1 2 3\n4 5 6\n");
    std::string scenario = bytes_of(data("scenarios/parked_car.json"));
    scenario.replace(scenario.find("../town.xodr"), 12, data("town.xodr"));
    folder_.write("scene.json", scenario);
  }

  std::string made(const std::string& name) const { return folder_ / name; }

  std::vector<Reading> readings() const {
    const std::string town = data("town.xodr"), walls = data("town.bt");
    const std::string drive = made("drive.csv");
    return {
        {town, {"info", "IN", "--json"}},
        {data("junction.xml"), {"info", "IN", "--json"}},
        {data("crossing.osm"), {"validate", "IN", "--json"}},
        {town, {"locate", "IN", "--at", "150,198", "--json"}},
        {made("points.csv"), {"locate", town, "--points", "IN", "--json"}},
        {town, {"route", "IN", "--from", "150,198", "--to", "lane:7/0/1@35", "--json"}},
        {made("pairs.csv"), {"route", town, "--batch", "IN", "--quiet"}},
        {town, {"reach", "IN", "--from", "150,198", "--within", "60s", "--json"}},
        {walls, {"occupancy", "info", "IN", "--json"}},
        {data("scans/scan_00.pcd"), {"occupancy", "info", "IN", "--json"}},
        {made("two.xyz"), {"occupancy", "info", "IN", "--json"}},
        {drive, {"audit", "--occupancy", walls, "--trajectory", "IN", "--quiet"}},
        {walls, {"audit", "--occupancy", "IN", "--trajectory", drive, "--quiet"}},
        {made("moving.csv"),
         {"audit", "--occupancy", walls, "--trajectory", drive, "--obstacles", "IN", "--quiet"}},
        {made("van.json"),
         {"audit", "--occupancy", walls, "--trajectory", drive, "--vehicle", "IN", "--quiet"}}};
  }

  TemporaryFolder folder_;
};

/// What the program answers when a named pipe gives it these bytes.
ProgramRun run_with_pipe(const std::vector<std::string>& words, const std::string& bytes,
                         const std::string& pipe) {
  if (::mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("mkfifo failed");
  std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << bytes; });
  ProgramRun run = run_roadbed(with_input(words, pipe));
  writer.join();
  std::filesystem::remove(pipe);
  return run;
}

TEST_F(Streams, GiveTheAnswerOfThePlainFileAsPackedFilesDo) {
  for (const Reading& reading : readings()) {
    SCOPED_TRACE(testing::PrintToString(reading.words));
    const std::string bytes = bytes_of(reading.file);
    const ProgramRun plain = run_roadbed(with_input(reading.words, reading.file));
    EXPECT_FALSE(plain.out.empty()) << plain.err;
    const std::string packed = folder_.write("packed.xyz.gz", gzipped(bytes));
    for (const ProgramRun& run :
         {run_roadbed_reading(reading.file, with_input(reading.words, "-")),
          run_roadbed(with_input(reading.words, packed)),
          run_with_pipe(reading.words, zstandard(bytes), folder_ / "pipe")}) {
      EXPECT_EQ(run.out, plain.out) << run.err;
      EXPECT_EQ(run.status, plain.status);
    }
  }
}

TEST_F(Streams, OfADriveLeaveNoRecordToReplayAndSaySo) {
  const std::string plain = folder_ / "plain", piped = folder_ / "piped";
  const std::string scene = made("scene.json");
  ASSERT_EQ(run_roadbed({"simulate", scene, "-o", plain, "--quiet"}).status, 0);
  const ProgramRun run = run_roadbed_reading(scene, {"simulate", "-", "-o", piped});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("note: no replay.json"));
  EXPECT_TRUE(bytes_of(plain + "/trajectory.csv") == bytes_of(piped + "/trajectory.csv"));
  EXPECT_TRUE(std::filesystem::exists(plain + "/replay.json"));
  EXPECT_FALSE(std::filesystem::exists(piped + "/replay.json"));
}

TEST_F(Streams, AreNoInputsOfACertificate) {
  const std::string proof = folder_ / "proof.json", walls = data("town.bt");
  const ProgramRun run = run_roadbed_reading(
      made("drive.csv"),
      {"audit", "--occupancy", walls, "--trajectory", "-", "--certificate", proof});
  EXPECT_NE(run.status, 0);
  EXPECT_THAT(run.err,
              HasSubstr("standard input: is a stream, whose bytes cannot be hashed again"));
  EXPECT_FALSE(std::filesystem::exists(proof));
  // A packed file is one: its hash is that of its own bytes.
  const std::string packed = folder_.write("drive.csv.gz", gzipped(bytes_of(made("drive.csv"))));
  run_roadbed({"audit", "--occupancy", walls, "--trajectory", packed, "--certificate", proof});
  EXPECT_EQ(run_roadbed({"audit", "--check", proof}).status, 0);
  folder_.write("drive.csv.gz", zstandard(bytes_of(made("drive.csv"))));
  EXPECT_NE(run_roadbed({"audit", "--check", proof}).status, 0);
}

TEST_F(Streams, OfJobsGiveTheResultsOfTheFile) {
  const std::string jobs = folder_.write(
      "jobs.jsonl", R"({"job":"validate","inputs":[")" + data("town.xodr") + "\"]}\n");
  const std::string packed = folder_.write("jobs.jsonl.gz", gzipped(bytes_of(jobs)));
  const auto results = [&](const std::string& name, const ProgramRun& run) {
    EXPECT_EQ(run.err, "");
    return bytes_of(folder_ / name / "results.jsonl");
  };
  const auto out = [&](const std::string& name) { return (folder_ / name).string(); };
  const std::string plain =
      results("plain", run_roadbed({"batch", jobs, "-o", out("plain"), "--quiet"}));
  EXPECT_THAT(plain, HasSubstr("validate"));
  EXPECT_EQ(results("packed", run_roadbed({"batch", packed, "-o", out("packed"), "--quiet"})),
            plain);
  EXPECT_EQ(results("piped", run_roadbed_reading(
                                 jobs, {"batch", "-", "-o", out("piped"), "--isolate", "--quiet"})),
            plain);
}

TEST_F(Streams, AreNoInputsOfJobs) {
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string jobs = folder_.write("jobs.jsonl",
                                         "{\"job\":\"validate\",\"inputs\":[\"-\"]}\n"
                                         "{\"job\":\"validate\",\"inputs\":[\"" +
                                             pipe + "\"]}\n");
  run_roadbed({"batch", jobs, "-o", folder_ / "out", "--quiet"});
  const std::string results = bytes_of(folder_ / "out" / "results.jsonl");
  EXPECT_THAT(results, HasSubstr("reads standard input"));
  EXPECT_THAT(results, HasSubstr("is a stream, which can be read once only"));
}

TEST_F(Streams, ThatUnpackToMoreThanTheLimitAreRefused) {
  constexpr std::size_t frame_bytes = std::size_t{1} << 26;
  const std::string frame = zstandard(std::string(frame_bytes, ' '));
  std::string bomb;
  for (std::size_t size = 0; size <= std::size_t{1} << 30; size += frame_bytes) bomb += frame;
  const std::string file = folder_.write("bomb.zst", bomb);
  const ProgramRun run = run_roadbed({"info", file});
  EXPECT_THAT(run.err, HasSubstr("bomb.zst: unpacks to more than 1073741824 bytes"));
  EXPECT_EQ(run.out, "");
}

// Clouds, octrees and tables take several times their bytes: what unpacks to more than a file of
// its size is worth is refused.
TEST_F(Streams, OfRowsUnpackToNoMoreThanTheirSizeIsWorth) {
  const std::string much(25'000'000, ' ');
  const auto expect_refused = [](const ProgramRun& run) {
    EXPECT_EQ(run.status, 3);
    EXPECT_THAT(run.err, HasSubstr(": unpacks to more than 24"));
    EXPECT_THAT(run.err, HasSubstr(" packed ones; unpack it to a file first"));
  };
  for (const std::string& file :
       {folder_.write("scan.bin.zst", zstandard(much)),
        folder_.write("town.bt.gz", gzipped("# Octomap OcTree binary file\n" + much))}) {
    expect_refused(run_roadbed({"occupancy", "info", file}));
    expect_refused(run_roadbed({"occupancy", "build", file, "-o", folder_ / "out.bt"}));
    expect_refused(run_roadbed_reading(file, {"occupancy", "info", "-"}));
  }
  const std::string drive =
      folder_.write("drive.csv.gz", gzipped("t_s,x_m,y_m,heading_rad\n" + much));
  expect_refused(run_roadbed({"drive", "info", drive}));
}

}  // namespace
}  // namespace roadbed::tests
