#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "client/io/gallery/gallery.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

GalleryFinding FindingOf(bool control, bool holds) {
  GalleryFinding finding;
  finding.text = "It breaks";
  finding.control = control;
  finding.holds = holds;
  finding.met = holds != control ? 5 : 0;
  finding.trials = 5;
  finding.needed = 4;
  finding.conditions = {{"lift", "at least 3", {5, 1, 4, 3, 2}}};
  return finding;
}

Gallery GalleryOf(const GalleryFinding& finding) {
  GalleryScene scene{"slab", "A slab", "Fig. 1", {"iso"}, {}, {}};
  scene.groups = {{"lattice", 1, {2, 3, 4, 5, 6}, {finding}}};
  return {"0123456789abcdef", "seeds 2-6", {scene}};
}

TEST(GalleryPage, TellsVerdictsOfCriteriaAndControls) {
  EXPECT_EQ(VerdictText(FindingOf(false, true)), "met");
  EXPECT_EQ(VerdictText(FindingOf(false, false)), "not met");
  EXPECT_EQ(VerdictText(FindingOf(true, true)), "fails, as it should");
  EXPECT_EQ(VerdictText(FindingOf(true, false)), "passes: no evidence");
  GalleryFinding finding = FindingOf(true, false);
  finding.met = 0;
  finding.unmeasured = 5;
  EXPECT_EQ(VerdictText(finding), "not measured: no evidence");
  finding = FindingOf(false, false);
  finding.trials = 0;
  EXPECT_EQ(VerdictText(finding), "not run");
  finding.asked = false;
  EXPECT_EQ(VerdictText(finding), "not asked of coarse bodies");
}

TEST(GalleryPage, CountsVerdictsOfWhatWasRun) {
  Gallery gallery = GalleryOf(FindingOf(false, true));
  std::vector<GalleryFinding>& findings = gallery.scenes[0].groups[0].findings;
  findings.push_back(FindingOf(true, true));
  findings.push_back(FindingOf(false, false));
  findings.push_back(FindingOf(false, false));
  findings.back().trials = 0;
  EXPECT_EQ(CountVerdicts(gallery).good, 2);
  EXPECT_EQ(CountVerdicts(gallery).all, 3);
  EXPECT_THAT(GalleryPage(gallery), HasSubstr("<b>2 of 3</b>"));
}

TEST(GalleryPage, ShowsMedianRangeBoundAndWhatWasNotMeasured) {
  GalleryFinding finding = FindingOf(false, true);
  EXPECT_THAT(GalleryPage(GalleryOf(finding)), HasSubstr("3 (1 to 5)</td>"));
  EXPECT_THAT(GalleryPage(GalleryOf(finding)), HasSubstr("at least 3"));
  EXPECT_THAT(GalleryPage(GalleryOf(finding)), HasSubstr("5 of 5"));
  finding.conditions[0].values = {2, std::nan("")};
  EXPECT_THAT(GalleryPage(GalleryOf(finding)), HasSubstr("2, 1 not measured"));
  finding.conditions[0].values = {std::nan("")};
  EXPECT_THAT(GalleryPage(GalleryOf(finding)), HasSubstr(">not measured<"));
}

TEST(GalleryPage, EscapesWhatItIsTold) {
  GalleryFinding finding = FindingOf(false, true);
  finding.text = "A & B <script>";
  finding.conditions[0].text = "|n.a| < 1";
  Gallery gallery = GalleryOf(finding);
  gallery.scenes[0].title = "\"A\" & 'B'";
  gallery.scenes[0].failures = {"failed: <no mesh>"};
  gallery.scenes[0].pictures = {{"<v>", "png", false}};
  const std::string page = GalleryPage(gallery);
  EXPECT_THAT(page, HasSubstr("A &amp; B &lt;script&gt;"));
  EXPECT_THAT(page, HasSubstr("|n.a| &lt; 1"));
  EXPECT_THAT(page, HasSubstr("failed: &lt;no mesh&gt;"));
  EXPECT_THAT(page, HasSubstr("alt=\"&quot;A&quot; &amp; 'B': &lt;v&gt;\""));
  EXPECT_THAT(page, Not(HasSubstr("<script>")));
}

TEST(GalleryPage, HoldsItsPicturesAndMarksThoseOfControls) {
  Gallery gallery = GalleryOf(FindingOf(false, true));
  gallery.scenes[0].pictures = {{"iso", "abc", true}};
  const std::string page = GalleryPage(gallery);
  EXPECT_THAT(page, HasSubstr("<figure class=\"control\"><img src=\"data:image/png;base64,YWJj\""));
}

TEST(VerdictTable, HasARowForEachConditionWithTheValuesOfAllSeeds) {
  GalleryFinding finding = FindingOf(true, false);
  finding.text = "It \"breaks\", along fibres";
  finding.conditions.push_back({"pieces", "at most 2", {2, std::nan(""), 1, 2.5, 1e-9}});
  EXPECT_EQ(
      VerdictTable(GalleryOf(finding)),
      "scene,layout,coarseness,criterion,control,measured,bound,seeds,values,met,trials,verdict\n"
      "slab,lattice,1,\"It \"\"breaks\"\", along fibres\",control,\"lift\",\"at least 3\",2 3 4 5 "
      "6,"
      "5 1 4 3 2,5,5,\"passes: no evidence\"\n"
      "slab,lattice,1,\"It \"\"breaks\"\", along fibres\",control,\"pieces\",\"at most 2\",2 3 4 5 "
      "6,"
      "2 nan 1 2.5 1e-09,5,5,\"passes: no evidence\"\n");
}

TEST(SceneAnswers, ListsVariantsOfCriteriaAndWhichOnlyControlsHave) {
  const auto scenes = ParseSceneList(
      R"({"scenes":[{"name":"s","title":"t","paper":"p","variants":["a","b","c"],"pictured":["a"],"coarsest":1.5,
      "criteria":[{"control":false,"variants":["a"]},{"control":true,"variants":["b","a"]}]}]})");
  ASSERT_TRUE(scenes.ok()) << scenes.status();
  EXPECT_THAT((*scenes)[0].variants, ::testing::ElementsAre("a", "b"));
  EXPECT_THAT((*scenes)[0].controls, ::testing::ElementsAre("b"));
  EXPECT_THAT((*scenes)[0].pictured, ::testing::ElementsAre("a"));
  EXPECT_EQ((*scenes)[0].coarsest, 1.5);
}

TEST(SceneAnswers, ReadsFindings) {
  const auto groups = ParseFindings(
      R"({"groups":[{"layout":"lattice","coarseness":2,"seeds":[2,3],"findings":[{"text":"f",
      "control":true,"asked":true,"holds":false,"met":1,"unmeasured":1,"trials":2,"needed":2,
      "conditions":[{"text":"c","bound":"below 1","values":[0.5,null]}]}]}]})");
  ASSERT_TRUE(groups.ok()) << groups.status();
  const GalleryFinding& finding = (*groups)[0].findings[0];
  EXPECT_EQ((*groups)[0].coarseness, 2);
  EXPECT_EQ(finding.met, 1);
  EXPECT_EQ(finding.conditions[0].values[0], 0.5);
  EXPECT_TRUE(std::isnan(finding.conditions[0].values[1]));
}

TEST(SceneAnswers, NamesTheMemberThatDoesNotFit) {
  EXPECT_EQ(ParseFindings("no").status().message(), "the scene runner's answer is no JSON object");
  EXPECT_EQ(ParseFindings(R"({"groups":[{"layout":3}]})").status().message(),
            "the scene runner's answer has no fitting \"layout\"");
  EXPECT_EQ(ParseSceneList("{}").status().message(),
            "the scene runner's answer has no fitting \"scenes\"");
}

}  // namespace
}  // namespace cleave
