#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "client/io/gallery/gallery.h"
#include "client/io/plot/drawing.h"

namespace cleave {
namespace {

constexpr absl::string_view kStyle = R"(
:root { color-scheme: light dark; --line: #8884; --good: #1a7f37; --bad: #c62828; --mute: #777; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
section { border-top: 1px solid var(--line); margin-top: 2.5rem; padding-top: 1rem; }
.mute, figcaption, caption { color: var(--mute); font-size: 0.875rem; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(17rem, 1fr)); gap: 1rem; }
figure { margin: 0; } figure img { width: 100%; border-radius: 4px; }
figure.control img { opacity: 0.75; }
table { border-collapse: collapse; width: 100%; margin: 1rem 0; }
caption { text-align: left; padding: 0.25rem 0; }
th, td { text-align: left; vertical-align: top; padding: 0.35rem 0.75rem 0.35rem 0;
  border-bottom: 1px solid var(--line); }
td.number { white-space: nowrap; font-variant-numeric: tabular-nums; }
.good { color: var(--good); font-weight: 600; } .bad { color: var(--bad); font-weight: 600; }
.tag { border: 1px solid var(--line); border-radius: 3px; font-size: 0.75rem; padding: 0 0.3rem; }
)";

std::string Number(double value) { return absl::StrFormat("%.3g", value); }

// The median, and between what the others lie.
std::string ValuesText(const std::vector<double>& values) {
  std::vector<double> measured;
  for (const double value : values) {
    if (!std::isnan(value)) measured.push_back(value);
  }
  if (measured.empty()) return values.empty() ? "" : "not measured";
  std::sort(measured.begin(), measured.end());
  const size_t half = measured.size() / 2;
  const double median =
      measured.size() % 2 == 1 ? measured[half] : (measured[half - 1] + measured[half]) / 2;
  std::string text = Number(median);
  if (measured.size() > 1)
    absl::StrAppend(&text, " (", Number(measured.front()), " to ", Number(measured.back()), ")");
  if (measured.size() < values.size())
    absl::StrAppend(&text, ", ", values.size() - measured.size(), " not measured");
  return text;
}

absl::string_view VerdictClass(const GalleryFinding& finding) {
  switch (VerdictOf(finding)) {
    case Verdict::kMet:
      return "good";
    case Verdict::kNotMet:
      return "bad";
    default:
      return "mute";
  }
}

void AddFinding(const GalleryFinding& finding, std::string& page) {
  const size_t rows = std::max<size_t>(1, finding.conditions.size());
  absl::StrAppend(&page, "<tr><td rowspan=\"", rows, "\">", EscapedForXml(finding.text),
                  finding.control ? " <span class=\"tag\">control</span>" : "", "</td>");
  for (size_t row = 0; row < rows; ++row) {
    if (row > 0) page += "<tr>";
    const GalleryCondition condition =
        row < finding.conditions.size() ? finding.conditions[row] : GalleryCondition{};
    absl::StrAppend(&page, "<td>", EscapedForXml(condition.text), "</td><td class=\"number\">",
                    ValuesText(condition.values), "</td><td class=\"number\">",
                    EscapedForXml(condition.bound), "</td>");
    if (row == 0) {
      absl::StrAppend(&page, "<td class=\"number\" rowspan=\"", rows, "\">", finding.met, " of ",
                      finding.trials, "</td><td rowspan=\"", rows, "\" class=\"",
                      VerdictClass(finding), "\">", VerdictText(finding), "</td>");
    }
    page += "</tr>\n";
  }
}

void AddGroup(const GalleryGroup& group, std::string& page) {
  absl::StrAppend(&page, "<table><caption>", EscapedForXml(group.layout), " mesh, seeds ",
                  absl::StrJoin(group.seeds, ", "));
  if (group.coarseness != 1)
    absl::StrAppend(&page, ", cells ", Number(group.coarseness), " times as long as at full size");
  page +=
      "</caption>\n<tr><th>Criterion</th><th>Measured</th><th>Median (range)</th><th>Bound</th>"
      "<th>Seeds that meet it</th><th>Verdict</th></tr>\n";
  for (const GalleryFinding& finding : group.findings) AddFinding(finding, page);
  page += "</table>\n";
}

void AddScene(const GalleryScene& scene, std::string& page) {
  absl::StrAppend(&page, "<section id=\"", EscapedForXml(scene.name), "\"><h2>",
                  EscapedForXml(scene.title), "</h2>\n<p class=\"mute\">",
                  EscapedForXml(scene.name), ", after the paper's ", EscapedForXml(scene.paper));
  if (scene.runs_done < scene.runs)
    absl::StrAppend(&page, "; ", scene.runs_done, " of ", scene.runs, " runs done");
  page += "</p>\n<div class=\"pictures\">\n";
  for (const GalleryPicture& picture : scene.pictures) {
    absl::StrAppend(&page, picture.control ? "<figure class=\"control\">" : "<figure>",
                    "<img src=\"data:image/png;base64,", absl::Base64Escape(picture.png),
                    "\" alt=\"", EscapedForXml(absl::StrCat(scene.title, ": ", picture.variant)),
                    "\"><figcaption>", EscapedForXml(picture.variant),
                    picture.control ? " <span class=\"tag\">control</span>" : "",
                    "</figcaption></figure>\n");
  }
  page += "</div>\n";
  for (const GalleryGroup& group : scene.groups) AddGroup(group, page);
  for (const std::string& failure : scene.failures)
    absl::StrAppend(&page, "<p class=\"bad\">", EscapedForXml(failure), "</p>\n");
  page += "</section>\n";
}

}  // namespace

Verdict VerdictOf(const GalleryFinding& finding) {
  if (!finding.asked) return Verdict::kNotAsked;
  if (finding.trials == 0) return Verdict::kNotRun;
  return finding.holds ? Verdict::kMet : Verdict::kNotMet;
}

absl::string_view VerdictText(const GalleryFinding& finding) {
  switch (VerdictOf(finding)) {
    case Verdict::kMet:
      return finding.control ? "fails, as it should" : "met";
    case Verdict::kNotMet:
      if (!finding.control) return "not met";
      return finding.met > 0 ? "passes: no evidence" : "not measured: no evidence";
    case Verdict::kNotAsked:
      return "not asked of coarse bodies";
    case Verdict::kNotRun:
      return "not run";
  }
  return "";
}

VerdictCount CountVerdicts(const Gallery& gallery) {
  VerdictCount count;
  for (const GalleryScene& scene : gallery.scenes) {
    for (const GalleryGroup& group : scene.groups) {
      for (const GalleryFinding& finding : group.findings) {
        const Verdict verdict = VerdictOf(finding);
        if (verdict == Verdict::kNotAsked || verdict == Verdict::kNotRun) continue;
        ++count.all;
        if (verdict == Verdict::kMet) ++count.good;
      }
    }
  }
  return count;
}

std::string GalleryPage(const Gallery& gallery) {
  const VerdictCount count = CountVerdicts(gallery);
  std::string page = absl::StrCat(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Cleave: gallery</title>\n<style>",
      kStyle,
      "</style></head><body>\n<h1>Gallery</h1>\n"
      "<p>Each scene stands for a figure of the paper. Magnitudes are Cleave's own; what is "
      "claimed "
      "are orderings and geometry. A control lacks what makes its criterion true: it must fail "
      "it.</p>\n<p><b>",
      count.good, " of ", count.all, "</b> verdicts are as they should be.</p>\n",
      "<p class=\"mute\">Build ", EscapedForXml(gallery.build), "; ",
      EscapedForXml(gallery.settings), "</p>\n");
  for (const GalleryScene& scene : gallery.scenes) AddScene(scene, page);
  page += "</body></html>\n";
  return page;
}

}  // namespace cleave
