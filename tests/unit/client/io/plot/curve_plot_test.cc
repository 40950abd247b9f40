#include "client/io/plot/curve_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "client/io/plot/axis.h"
#include "tests/unit/client/io/xml_reader.h"

namespace cleave {
namespace {

using ::cleave::testing::XmlElement;
using ::cleave::testing::XmlReader;
using ::testing::HasSubstr;

PlottedCurve Straight(double modulus, double end, bool fails) {
  PlottedCurve curve;
  curve.label = "along <x>";
  for (int k = 0; k <= 10; ++k) {
    curve.strain.push_back(end * k / 10);
    curve.nominal_stress.push_back(modulus * curve.strain.back());
    curve.true_stress.push_back(curve.nominal_stress.back() * (1 + 0.4 * curve.strain.back()));
  }
  curve.fails = fails;
  return curve;
}

TEST(CurvePlot, ShowsEveryCurveWithItsEndAndItsLabel) {
  const PlottedCurve curves[] = {Straight(1e9, 0.01, true), Straight(2e9, 0.005, false)};
  const auto svg = EncodeCurvePlot(curves, "wood & co", "E > 0");
  ASSERT_TRUE(svg.ok()) << svg.status();
  const auto root = XmlReader::Read(*svg);
  ASSERT_TRUE(root.ok()) << root.status();
  std::vector<std::string> texts;
  for (const XmlElement* text : root->All("text")) texts.push_back(text->text);
  EXPECT_THAT(texts, ::testing::IsSupersetOf({"Strain [%]", "Stress [MPa]"}));
  EXPECT_THAT(*svg, HasSubstr("wood &amp; co"));
  EXPECT_THAT(*svg, HasSubstr("E &gt; 0"));
  EXPECT_THAT(*svg, HasSubstr("along &lt;x&gt;"));
  // Two curves, and a cross of two strokes at the end of the first and in the legend.
  EXPECT_EQ(root->All("path").size(), 2u + 2 * 2);
  EXPECT_EQ(root->All("circle").size(), 2u);
  EXPECT_THAT(*svg, ::testing::Not(HasSubstr("true stress")));
}

TEST(CurvePlot, AddsTrueStressWhereItIsSeen) {
  const PlottedCurve curves[] = {Straight(1e6, 2, true)};
  const auto svg = EncodeCurvePlot(curves, "", "");
  ASSERT_TRUE(svg.ok()) << svg.status();
  EXPECT_THAT(*svg, HasSubstr("true stress"));
  EXPECT_EQ(XmlReader::Read(*svg)->All("path").size(), 2u + 2 * 2);
}

TEST(CurvePlot, DrawsABarThatBreaksAtOnce) {
  const PlottedCurve point{"nothing holds it", {0}, {0}, {0}, true};
  EXPECT_TRUE(EncodeCurvePlot({&point, 1}, "dust", "").ok());
}

TEST(CurvePlot, NamesEverythingWrong) {
  EXPECT_THAT(std::string(EncodeCurvePlot({}, "", "").status().message()),
              HasSubstr("none to plot"));
  PlottedCurve curves[] = {Straight(1, 1, true), Straight(1, 1, true), {}};
  curves[0].strain.pop_back();
  curves[1].true_stress[3] = std::nan("");
  const std::string message(EncodeCurvePlot(curves, "", "").status().message());
  EXPECT_THAT(message, HasSubstr("curves[0]: has columns of different length"));
  EXPECT_THAT(message, HasSubstr("curves[1]: has a number that is not finite"));
  EXPECT_THAT(message, HasSubstr("curves[2]: has no points"));
}

TEST(WithPrefix, KeepsThreeDigits) {
  EXPECT_EQ(WithPrefix(72.61e6, "Pa"), "72.6 MPa");
  EXPECT_EQ(WithPrefix(999.9, "N"), "1 kN");
  EXPECT_EQ(WithPrefix(-0.00213, "m"), "-2.13 mm");
  EXPECT_EQ(WithPrefix(0, "Pa"), "0 Pa");
}

}  // namespace
}  // namespace cleave
