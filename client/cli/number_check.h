#ifndef CLEAVE_CLIENT_CLI_NUMBER_CHECK_H_
#define CLEAVE_CLIENT_CLI_NUMBER_CHECK_H_

#include <CLI/App.hpp>
#include <cstdint>

namespace cleave {

// Checks of options that say what is allowed as faults of scenes do, `0 is outside [0.1, 100]`, and
// refuse NaN, which compares as neither too small nor too large.

// A number in [low, high].
CLI::Validator NumberWithin(double low, double high);
// A number in (low, high].
CLI::Validator NumberAbove(double low, double high);
// A whole number in [low, high].
CLI::Validator CountWithin(int64_t low, int64_t high);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_NUMBER_CHECK_H_
