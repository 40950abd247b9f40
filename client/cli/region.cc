#include "client/cli/region.h"

#include <limits>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/cli/number_check.h"
#include "core/scene/limits.h"
#include "proto/convert/rung.h"

namespace cleave {
namespace {

std::string CheckOutside(const std::string& text) {
  double metres = 0;
  if (ParseRung(text).has_value()) return "";
  if (absl::SimpleAtod(text, &metres) && metres > 0 && metres <= limits::kMaxLength) return "";
  return absl::StrCat("\"", text, "\" is neither a rung nor metres in (0, ", limits::kMaxLength,
                      "]");
}

}  // namespace

std::optional<v1::RegionOfInterest> RegionOptions::message() const {
  if (nodes.empty() && box.empty()) return std::nullopt;
  v1::RegionOfInterest region;
  region.mutable_nodes()->Add(nodes.begin(), nodes.end());
  for (size_t at = 0; at < box.size(); ++at) {
    (at < 3 ? region.mutable_box()->add_min(box[at]) : region.mutable_box()->add_max(box[at]));
  }
  double metres = 0;
  if (const std::optional<Rung> rung = ParseRung(outside); rung.has_value()) {
    region.set_outside_rung(RungMessage(rung));
  } else if (absl::SimpleAtod(outside, &metres)) {
    region.set_outside_tolerance(metres);
  }
  return region;
}

absl::Status RegionOptions::Check() const {
  if (outside.empty() || message().has_value()) return absl::OkStatus();
  return absl::InvalidArgumentError("--outside needs --region-node or --region-box");
}

void AddRegionOptions(CLI::App& verb, RegionOptions& options) {
  verb.add_option(
          "--region-node", options.nodes,
          "Only pieces with this node (and those of --region-box) are as accurate as asked; "
          "again for more")
      ->check(CountWithin(0, std::numeric_limits<int32_t>::max()))
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("NODE");
  verb.add_option("--region-box", options.box,
                  "Only pieces that are now in this box, in metres: least x, y, z, largest x, y, z")
      ->expected(6)
      ->check(NumberWithin(-limits::kMaxLength, limits::kMaxLength))
      ->type_name("METRES");
  verb.add_option("--outside", options.outside,
                  "Accuracy of all other pieces, a rung or metres. Default: preview")
      ->check(CheckOutside, "RUNG|METRES")
      ->type_name("RUNG|METRES");
}

}  // namespace cleave
