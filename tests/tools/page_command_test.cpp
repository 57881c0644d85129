// Pages that commands write: what is shown over a map, and what changed in it.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "roadbed/tests/support/holds.h"
#include "roadbed/tests/support/program_run.h"
#include "roadbed/tests/support/real_data.h"
#include "roadbed/tests/tools/town.h"

namespace roadbed::tests {
namespace {

TEST(MapPageCommand, ShowsWhatOtherCommandsWrote) {
  const TemporaryFolder folder;
  const ProgramRun route = run_roadbed({"route", kTown, "--from", "lane:1/0/-1@10", "--to",
                                        "lane:7/0/1@55", "--alternatives", "2", "--json"});
  const ProgramRun reach =
      run_roadbed({"reach", kTown, "--from", "lane:1/0/-1@10", "--within", "300m", "--json"});
  const ProgramRun found = run_roadbed({"validate", kTown, "--json"});
  const std::string drive = folder.write("drive.csv",
                                         "t_s,x_m,y_m,heading_rad,speed_mps,acceleration_mps2,"
                                         "steering_rad,curvature_per_m\n"
                                         "0,150,198,0,10,0,0,0\n2,170,198,0,10,0,0,0\n");
  const ProgramRun run = run_roadbed(
      {"export", kTown, "-o", folder / "town.html", "--route", folder.write("r.json", route.out),
       "--reach", folder.write("near.json", reach.out), "--trajectory", drive, "--findings",
       folder.write("found.json", found.out), "--occupancy", data_folder() / "town.bt"});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string page = bytes_of(folder / "town.html");
  for (const char* name : {"Route r", "Route r, alternative 1", "Reach near", "Drive drive",
                           "Occupied town.bt", "speed.bend"}) {
    EXPECT_TRUE(holds(page, '"' + std::string(name) + '"')) << name;
  }
}

TEST(MapPageCommand, NamesTheLinesOfTheSource) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_roadbed({"export", kTown, "-o", folder / "town.html"}).status, 0);
  std::ifstream source(kTown);
  long line = 1;
  for (std::string text; std::getline(source, text); ++line) {
    if (holds(text, "<road ") && holds(text, " id=\"7\"")) break;
  }
  EXPECT_TRUE(holds(bytes_of(folder / "town.html"), "\"road 7\":" + std::to_string(line)));
}

TEST(MapPageCommand, RefusesWhatIsNotForItsMapOrForAPage) {
  const TemporaryFolder folder;
  const std::string other = folder.write(
      "r.json",
      R"({"found":true,"length_m":1,"cost_s":1,"lanes":[{"lane":"no/0/1","from_s_m":0,"to_s_m":1}]})");
  const std::string none = folder.write("none.json", R"({"found":false,"reason":"far away"})");
  const std::string page = folder / "town.html";
  const ProgramRun run = run_roadbed({"export", kTown, "-o", page, "--route", other});
  EXPECT_EQ(run.status, 3);
  EXPECT_TRUE(holds(run.err, "the map has no lane \"no/0/1\"")) << run.err;
  EXPECT_EQ(run_roadbed({"export", kTown, "-o", page, "--route", none}).status, 3);
  EXPECT_EQ(run_roadbed({"export", kTown, "-o", page, "--findings", other}).status, 3);
  EXPECT_FALSE(std::filesystem::exists(page));
  EXPECT_EQ(run_roadbed({"export", kTown, "-o", folder / "a.svg", "--route", none}).status, 2);
}

TEST(MapPageCommand, RefusesAMapAsExportDoes) {
  const TemporaryFolder folder;
  const std::string bad = folder.write("bad.xodr", "<OpenDRIVE>");
  const ProgramRun page = run_roadbed({"export", bad, "-o", folder / "a.html"});
  const ProgramRun picture = run_roadbed({"export", bad, "-o", folder / "a.svg"});
  EXPECT_EQ(page.status, 3);
  EXPECT_EQ(page.err, picture.err);
}

TEST(DiffPageCommand, WritesAPageBesideItsAnswer) {
  const TemporaryFolder folder;
  std::string text = bytes_of(kTown);
  text.replace(text.find("\"driving\""), 9, "\"parking\"");
  const std::string changed = folder.write("new.xodr", text), page = folder / "d.html";
  const ProgramRun plain = run_roadbed({"diff", kTown, changed});
  const ProgramRun run = run_roadbed({"diff", kTown, changed, "-o", page});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.out, plain.out);
  EXPECT_TRUE(holds(bytes_of(page), "; driving before, parking after\""));
  EXPECT_EQ(run_roadbed({"diff", kTown, changed, "-o", page}).status, 3);
  EXPECT_EQ(run_roadbed({"diff", kTown, changed, "-o", page, "--force"}).status, 1);
  EXPECT_EQ(run_roadbed({"diff", kTown, changed, "-o", folder / "d.svg"}).status, 2);
}

}  // namespace
}  // namespace roadbed::tests
