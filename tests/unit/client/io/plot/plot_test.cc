#include "client/io/plot/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "client/io/plot/axis.h"
#include "tests/unit/client/io/xml_reader.h"

namespace cleave {
namespace {

using ::cleave::testing::XmlElement;
using ::cleave::testing::XmlReader;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<PlotSample> PullAndBreak(size_t count) {
  std::vector<PlotSample> samples;
  for (size_t i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(count - 1);
    PlotSample sample;
    sample.time = 0.2 * part;
    sample.force = part < 0.6 ? 2500 * part : 1500 * std::exp(-20 * (part - 0.6));
    sample.broken_edges = part < 0.6 ? 0 : static_cast<int64_t>(400 * (part - 0.6));
    sample.pieces = part < 0.8 ? 1 : 3;
    samples.push_back(sample);
  }
  return samples;
}

std::vector<std::string> Texts(const XmlElement& root) {
  std::vector<std::string> texts;
  for (const XmlElement* text : root.All("text")) texts.push_back(text->text);
  return texts;
}

TEST(Axis, EndsAndStepsAreRound) {
  const Axis axis = MakeAxis(0, 0.0234, 5, true, false);
  EXPECT_EQ(axis.prefix, "m");
  EXPECT_THAT(axis.labels, ElementsAre("0", "5", "10", "15", "20", "25"));
  EXPECT_DOUBLE_EQ(axis.high, 0.025);
  EXPECT_THAT(MakeAxis(-3, 7.2, 5, false, false).labels,
              ElementsAre("-4", "-2", "0", "2", "4", "6", "8"));
  EXPECT_THAT(MakeAxis(0, 3e4, 3, true, false).labels, ElementsAre("0", "10", "20", "30"));
}

TEST(Axis, CountsStepByWholeNumbersAndEqualEndsMoveApart) {
  EXPECT_THAT(MakeAxis(0, 2, 8, false, true).labels, ElementsAre("0", "1", "2"));
  EXPECT_GT(MakeAxis(0, 0, 4, false, true).high, 0);
  EXPECT_GT(MakeAxis(5, 5, 4, true, false).high, 5);
  EXPECT_GT(MakeAxis(0, 0, 4, true, false).high, 0);
}

TEST(Plot, IsXmlWithAxesUnitsAndMarks) {
  const auto svg = EncodePlot(PullAndBreak(200), {.title = "bar & <hole>"});
  ASSERT_TRUE(svg.ok()) << svg.status();
  const auto root = XmlReader::Read(*svg);
  ASSERT_TRUE(root.ok()) << root.status();
  EXPECT_EQ(root->name, "svg");
  const std::vector<std::string> texts = Texts(*root);
  EXPECT_THAT(texts, Contains("bar &amp; &lt;hole&gt;"));
  EXPECT_THAT(texts, Contains("Pull force [kN]"));
  EXPECT_THAT(texts, Contains("Time [ms]"));
  EXPECT_THAT(texts, Contains("Broken edges"));
  EXPECT_THAT(texts, Contains("Pieces"));
  EXPECT_THAT(texts, Contains("peak 1.49 kN"));
  EXPECT_THAT(texts, Contains(HasSubstr("first break")));
  EXPECT_EQ(root->All("path").size(), 5u);  // three curves, two of them filled
}

TEST(Plot, CurvesStayInsideTheirPanels) {
  const auto root = XmlReader::Read(*EncodePlot(PullAndBreak(200), {}));
  ASSERT_TRUE(root.ok()) << root.status();
  for (const XmlElement* path : root->All("path")) {
    std::string numbers = path->attributes.at("d");
    for (char& c : numbers) {
      if (c == 'M' || c == 'L' || c == 'Z') c = ' ';
    }
    std::istringstream stream(numbers);
    double x = 0;
    double y = 0;
    int points = 0;
    while (stream >> x >> y) {
      EXPECT_GE(x, 80);
      EXPECT_LE(x, 830);
      EXPECT_TRUE((y >= 64 && y <= 330) || (y >= 372 && y <= 560)) << y;
      ++points;
    }
    EXPECT_GT(points, 2);
  }
}

TEST(Plot, LongRunsAreThinnedAndKeepTheirPeak) {
  std::vector<PlotSample> samples = PullAndBreak(100'000);
  samples[31'234].force = 9000;
  const auto svg = EncodePlot(samples, {});
  ASSERT_TRUE(svg.ok()) << svg.status();
  EXPECT_LT(svg->size(), 400'000u);
  EXPECT_THAT(*svg, HasSubstr("peak 9 kN"));
}

TEST(Plot, OneQuietSampleIsEnough) {
  const std::vector<PlotSample> samples(1);
  const auto svg = EncodePlot(samples, {});
  ASSERT_TRUE(svg.ok()) << svg.status();
  EXPECT_TRUE(XmlReader::Read(*svg).ok());
}

TEST(Plot, BadSamplesAreNamedAtOnce) {
  EXPECT_FALSE(EncodePlot({}, {}).ok());
  std::vector<PlotSample> samples = PullAndBreak(5);
  samples[1].force = std::numeric_limits<double>::quiet_NaN();
  samples[3].time = 0;
  samples[4].pieces = -1;
  const std::string message(EncodePlot(samples, {}).status().message());
  EXPECT_THAT(message, HasSubstr("samples[1]"));
  EXPECT_THAT(message, HasSubstr("samples[3]"));
  EXPECT_THAT(message, HasSubstr("samples[4]"));
}

}  // namespace
}  // namespace cleave
