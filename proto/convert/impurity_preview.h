#ifndef CLEAVE_PROTO_CONVERT_IMPURITY_PREVIEW_H_
#define CLEAVE_PROTO_CONVERT_IMPURITY_PREVIEW_H_

#include "cleave/v1/impurity.pb.h"
#include "core/model/impurity_preview.h"

namespace cleave {

// The answer to a request, but for its warnings.
v1::PreviewImpurityResponse MessageFromPreview(const ImpurityPreview& preview, bool with_edges);

}  // namespace cleave

#endif  // CLEAVE_PROTO_CONVERT_IMPURITY_PREVIEW_H_
