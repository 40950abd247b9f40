#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "client/io/gallery/gallery.h"

namespace cleave {
namespace {

// RFC 4180.
std::string Quoted(absl::string_view text) {
  return absl::StrCat("\"", absl::StrReplaceAll(text, {{"\"", "\"\""}}), "\"");
}

void AppendValue(std::string* out, double value) {
  absl::StrAppend(out, std::isnan(value) ? "nan" : absl::StrFormat("%.6g", value));
}

}  // namespace

std::string VerdictTable(const Gallery& gallery) {
  std::string table =
      "scene,layout,coarseness,criterion,control,measured,bound,seeds,values,met,trials,verdict\n";
  for (const GalleryScene& scene : gallery.scenes) {
    for (const GalleryGroup& group : scene.groups) {
      for (const GalleryFinding& finding : group.findings) {
        for (const GalleryCondition& condition : finding.conditions) {
          absl::StrAppend(&table, scene.name, ",", group.layout, ",", group.coarseness, ",",
                          Quoted(finding.text), ",", finding.control ? "control" : "", ",",
                          Quoted(condition.text), ",", Quoted(condition.bound), ",",
                          absl::StrJoin(group.seeds, " "), ",",
                          absl::StrJoin(condition.values, " ", AppendValue), ",", finding.met, ",",
                          finding.trials, ",", Quoted(VerdictText(finding)), "\n");
        }
      }
    }
  }
  return table;
}

}  // namespace cleave
