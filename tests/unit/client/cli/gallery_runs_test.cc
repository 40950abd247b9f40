#include "client/cli/gallery_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "client/cli/child_program.h"
#include "client/io/series/write_aside.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(GallerySeeds, AreNumbersAndRanges) {
  EXPECT_THAT(*ParseSeeds("3"), ElementsAre(3));
  EXPECT_THAT(*ParseSeeds("2-4,9"), ElementsAre(2, 3, 4, 9));
}

TEST(GallerySeeds, OfOtherTextAreRefused) {
  for (const char* text : {"", "a", "3-1", "1-", "-1", "1,,2", "1-2-3", "99999999999"})
    EXPECT_THAT(ParseSeeds(text).status().message(), HasSubstr("is not like 2-6")) << text;
  EXPECT_EQ(ParseSeeds("2-4,3").status().message(), "--seeds: 3 is there twice");
  EXPECT_EQ(ParseSeeds("0-4294967295").status().message(), "--seeds: more than 1000");
}

TEST(GalleryRuns, AreOfEveryVariantAndPicturedOnce) {
  GalleryScene scene{"s", "t", "p", {"a", "b"}, {}, {"b"}};
  const auto runs = RunsOf({scene}, {2, 3}, {"lattice", "unstructured"}, 1);
  EXPECT_EQ(runs.size(), 8u);
  int pictured = 0;
  for (const GalleryRun& run : runs) {
    pictured += run.pictured ? 1 : 0;
    if (run.pictured) {
      EXPECT_TRUE(run.variant == "b" && run.seed == 2 && run.layout == "lattice");
    }
  }
  EXPECT_EQ(pictured, 1);
}

TEST(GalleryRuns, AreNoCoarserThanTheirSceneTakes) {
  const GalleryScene fine{"s", "t", "p", {"a"}, {}, {}, 1.5},
      coarse{"r", "t", "p", {"a"}, {}, {}, 4};
  const auto runs = RunsOf({fine, coarse}, {1}, {"lattice"}, 3);
  EXPECT_EQ(runs[0].coarseness, 1.5);
  EXPECT_EQ(runs[1].coarseness, 3);
}

class GalleryFolderTest : public testing::Test {
 protected:
  const TemporaryDirectory directory_;
  const std::string path_ = directory_.path();
};

TEST_F(GalleryFolderTest, KeepsRunsOfItsOwnBuildAndSettings) {
  const GalleryFolder folder(path_, "build1", 800);
  ASSERT_TRUE(folder.Make().ok());
  GalleryRun run{"tube", "5", "lattice", 2, 1.5, false};
  EXPECT_EQ(folder.Find(run), "");
  ASSERT_TRUE(folder.Keep(run, "{\"a\":1}\n").ok());
  EXPECT_EQ(folder.Find(run), "{\"a\":1}\n");
  EXPECT_EQ(GalleryFolder(path_, "build2", 800).Find(run), "");
  EXPECT_EQ(GalleryFolder(path_, "build1", 640).Find(run), "");
  run.coarseness = 2;
  EXPECT_EQ(folder.Find(run), "");
  ASSERT_TRUE(folder.Clear().ok());
  run.coarseness = 1.5;
  EXPECT_EQ(folder.Find(run), "");
}

TEST_F(GalleryFolderTest, AsksForThePictureOfARunThatHasOne) {
  const GalleryFolder folder(path_, "build1", 800);
  ASSERT_TRUE(folder.Make().ok());
  const GalleryRun run{"tube", "5", "lattice", 2, 1, true};
  ASSERT_TRUE(folder.Keep(run, "{}\n").ok());
  EXPECT_EQ(folder.Find(run), "");
  ASSERT_TRUE(WriteAside(folder.PicturePath(run), "png").ok());
  EXPECT_EQ(folder.Find(run), "{}\n");
  // The picture is not that of another build's run, which made none.
  const GalleryFolder later(path_, "build2", 800);
  GalleryRun unpictured = run;
  unpictured.pictured = false;
  ASSERT_TRUE(later.Keep(unpictured, "{}\n").ok());
  EXPECT_EQ(later.Find(run), "");
}

TEST(ChildProgram, GivesWhatItPrintedOrWhyItFailed) {
  auto child = ChildProgram::Start({"/bin/cat"}, "some text");
  ASSERT_TRUE(child.ok()) << child.status();
  EXPECT_EQ(*(*child)->Output(), "some text");
  child = ChildProgram::Start({"/bin/sh", "-c", "echo wrong >&2; exit 3"});
  ASSERT_TRUE(child.ok()) << child.status();
  EXPECT_EQ((*child)->Output().status().message(), "wrong");
  child = ChildProgram::Start({"/bin/sh", "-c", "exit 3"});
  ASSERT_TRUE(child.ok()) << child.status();
  EXPECT_EQ((*child)->Output().status().message(), "sh ended with exit code 3");
}

TEST(ChildProgram, IsAwaitedTogetherWithOthers) {
  auto lasting = ChildProgram::Start({"/bin/sh", "-c", "exec sleep 1000"});
  auto short_lived = ChildProgram::Start({"/bin/sh", "-c", "echo done"});
  ASSERT_TRUE(lasting.ok() && short_lived.ok());
  while (!(*short_lived)->Ended())
    ChildProgram::AwaitAny({lasting->get(), short_lived->get()}, 600'000);
  EXPECT_FALSE((*lasting)->Ended());
  EXPECT_EQ(*(*short_lived)->Output(), "done\n");
}

TEST(ChildProgram, EndsWhenItIsStopped) {
  auto child = ChildProgram::Start({"/bin/sh", "-c", "exec sleep 1000"});
  ASSERT_TRUE(child.ok()) << child.status();
  EXPECT_FALSE((*child)->Ended());
  (*child)->Stop();
  EXPECT_TRUE((*child)->Ended());
  EXPECT_THAT((*child)->Output().status().message(), HasSubstr("was ended by signal 9"));
}

}  // namespace
}  // namespace cleave
