#ifndef CLEAVE_PROTO_CONVERT_IMPURITY_PREVIEW_H_
#define CLEAVE_PROTO_CONVERT_IMPURITY_PREVIEW_H_

#include "cleave/v1/impurity.pb.h"
#include "core/model/impurity_preview.h"
#include "core/picture/impurity_picture.h"

namespace cleave {

// Options of a picture as a request has them, and as they are: its title and up are the scene's.
void WritePictureOptions(const ImpurityPictureOptions& options, v1::PictureOptions& message);
ImpurityPictureOptions PictureOptionsFromMessage(const v1::PictureOptions& message);

// The answer to a request, but for its warnings and its picture.
v1::PreviewImpurityResponse MessageFromPreview(const ImpurityPreview& preview, bool with_edges);

}  // namespace cleave

#endif  // CLEAVE_PROTO_CONVERT_IMPURITY_PREVIEW_H_
