#ifndef CLEAVE_CLIENT_CLI_REGION_H_
#define CLEAVE_CLIENT_CLI_REGION_H_

#include <CLI/App.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "cleave/v1/frame.pb.h"

namespace cleave {

// What a viewer looks at.
struct RegionOptions {
  std::vector<int32_t> nodes;  // --region-node
  std::vector<double> box;     // --region-box, m: least corner, largest corner; empty: none
  std::string outside;         // --outside: a rung's name or metres; empty: not said

  // Error: InvalidArgument for --outside without a region.
  absl::Status Check() const;
  // Nothing where there is no region.
  std::optional<v1::RegionOfInterest> message() const;
};

void AddRegionOptions(CLI::App& verb, RegionOptions& options);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_REGION_H_
