#include "client/cli/accuracy.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/number_check.h"
#include "core/scene/limits.h"
#include "proto/convert/rung.h"

namespace cleave {

std::string AccuracyOptions::Words() const {
  std::string words;
  if (!rung_name.empty()) absl::StrAppend(&words, " --rung ", rung_name);
  if (tolerance > 0) absl::StrAppend(&words, " --tolerance ", tolerance);
  return words;
}

void AddAccuracyOptions(CLI::App& verb, AccuracyOptions& options, const std::string& whose,
                        const std::string& without) {
  std::vector<std::string> names;
  for (const Rung rung : kRungs) names.emplace_back(RungName(rung));
  CLI::Option* rung =
      verb.add_option("--rung", options.rung_name,
                      absl::StrCat("Accuracy ", whose,
                                   ": preview (errors up to 1e-3 of the body's diagonal), standard "
                                   "(1e-4), fine (1e-5), lossless. Default: ",
                                   without))
          ->check(CLI::IsMember(names))
          ->type_name("RUNG");
  verb.add_option("--tolerance", options.tolerance,
                  "Instead of a rung: largest error of a coordinate, in metres")
      ->check(NumberWithin(1e-15, limits::kMaxLength))
      ->type_name("METRES")
      ->excludes(rung);
}

void KeepAccuracy(const AccuracyOptions& options, v1::CreateSessionRequest& request) {
  request.set_rung(RungMessage(options.rung()));
  if (options.tolerance > 0)
    request.mutable_scene()->mutable_output()->set_tolerance(options.tolerance);
}

}  // namespace cleave
