#ifndef CLEAVE_PROTO_CONVERT_PROBE_H_
#define CLEAVE_PROTO_CONVERT_PROBE_H_

#include "absl/status/statusor.h"
#include "cleave/v1/material.pb.h"
#include "core/base/faults.h"
#include "core/base/stop_flag.h"
#include "core/probe/probe.h"
#include "core/scene/material_probe.h"

namespace cleave {

// The probe that a request asks for. Reports in `faults` what a request can say and a probe cannot;
// ValidateProbe may be run on the result in any case.
MaterialProbe ProbeFromMessage(const v1::ProbeMaterialRequest& message, Faults& faults);

// The answer to a request: checks it and runs the probe. Errors: every fault of the request, in
// `faults`; then the answer is empty. Cancelled when `stop` was requested.
absl::StatusOr<v1::ProbeMaterialResponse> AnswerProbe(const v1::ProbeMaterialRequest& request,
                                                      const StopFlag& stop, Faults& faults);

// All presets.
v1::ListMaterialPresetsResponse PresetsMessage();

}  // namespace cleave

#endif  // CLEAVE_PROTO_CONVERT_PROBE_H_
