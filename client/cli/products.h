#ifndef CLEAVE_CLIENT_CLI_PRODUCTS_H_
#define CLEAVE_CLIENT_CLI_PRODUCTS_H_

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/interrupt.h"
#include "client/cli/run_folder.h"

namespace cleave {

// What a run makes of its frames when it has reached its goal.
struct ProductOptions {
  bool vtu = false;      // DIR/vtu/cleave.pvd
  bool ply = false;      // DIR/ply
  bool preview = false;  // DIR/contact_sheet.png and DIR/preview.webp
  bool plot = false;     // DIR/plot.svg
  bool any() const { return vtu || ply || preview || plot; }
  // The options as they were typed, for a command to go on with; begins with a blank.
  std::string Words() const;
};

void AddProductOptions(CLI::App& verb, ProductOptions& options);

// Makes them, and returns their paths. Cancelled on a signal: what is finished stays.
absl::StatusOr<std::vector<std::string>> MakeProducts(const RunFolder& folder,
                                                      const ProductOptions& options,
                                                      Interrupt& interrupt);

// The plot of force, broken edges and pieces over time, from a run's reports and its scene.
absl::Status MakePlot(const RunFolder& folder, const std::string& reports_path,
                      const std::string& target);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_PRODUCTS_H_
