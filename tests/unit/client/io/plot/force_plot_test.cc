#include "client/io/plot/force_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/unit/client/io/xml_reader.h"

namespace cleave {
namespace {

using ::cleave::testing::XmlElement;
using ::cleave::testing::XmlReader;
using ::testing::HasSubstr;

TEST(ForcePlot, ShowsEveryCurveWithItsLargestForce) {
  const ForceCurve curves[] = {{"along <x>", {0, 0.01, 0.02}, {0, 2000, 100}},
                               {"across", {0, 0.01, 0.03}, {0, 900, 1200}}};
  const auto svg = EncodeForcePlot(curves, "wood & co");
  ASSERT_TRUE(svg.ok()) << svg.status();
  const auto root = XmlReader::Read(*svg);
  ASSERT_TRUE(root.ok()) << root.status();
  std::vector<std::string> texts;
  for (const XmlElement* text : root->All("text")) texts.push_back(text->text);
  EXPECT_THAT(texts, ::testing::IsSupersetOf({"wood &amp; co", "Displacement [mm]", "Force [kN]",
                                              "along &lt;x&gt;: 2 kN at 10 mm",
                                              "across: 1.2 kN at 30 mm"}));
  EXPECT_EQ(root->All("path").size(), 2u);
  EXPECT_EQ(root->All("circle").size(), 2u * 2);  // at the largest force, and in the legend
}

TEST(ForcePlot, NamesEverythingWrong) {
  EXPECT_THAT(std::string(EncodeForcePlot({}, "").status().message()), HasSubstr("none to plot"));
  const ForceCurve curves[] = {
      {"short", {0}, {0, 1}}, {"open", {0}, {std::numeric_limits<double>::infinity()}}, {}};
  const std::string message(EncodeForcePlot(curves, "").status().message());
  EXPECT_THAT(message, HasSubstr("curves[0]: has columns of different length"));
  EXPECT_THAT(message, HasSubstr("curves[1]: has a number that is not finite"));
  EXPECT_THAT(message, HasSubstr("curves[2]: has no points"));
}

}  // namespace
}  // namespace cleave
