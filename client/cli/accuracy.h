#ifndef CLEAVE_CLIENT_CLI_ACCURACY_H_
#define CLEAVE_CLIENT_CLI_ACCURACY_H_

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "cleave/v1/session.pb.h"
#include "core/stream/rungs.h"

namespace cleave {

// How accurate frames shall be.
struct AccuracyOptions {
  std::string rung_name;  // --rung; empty: not said
  double tolerance = 0;   // --tolerance, m; 0: not said

  std::optional<Rung> rung() const { return ParseRung(rung_name); }
  bool asked() const { return !rung_name.empty() || tolerance > 0; }
  // The options as they were typed, for a command to go on with; begins with a blank.
  std::string Words() const;
};

// --rung and --tolerance, one of the two. The help says whose accuracy it is, as in "of what is
// sent", and what holds without them.
void AddAccuracyOptions(CLI::App& verb, AccuracyOptions& options, const std::string& whose,
                        const std::string& without);

// What a session that is created keeps.
void KeepAccuracy(const AccuracyOptions& options, v1::CreateSessionRequest& request);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_ACCURACY_H_
