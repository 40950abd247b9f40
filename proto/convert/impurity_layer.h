#ifndef CLEAVE_PROTO_CONVERT_IMPURITY_LAYER_H_
#define CLEAVE_PROTO_CONVERT_IMPURITY_LAYER_H_

#include <string>
#include <vector>

#include "cleave/v1/scene.pb.h"
#include "core/base/faults.h"
#include "core/scene/impurities.h"

namespace cleave {

// The layer that a message describes, as SceneFromMessage; `field` is its path in faults.
ImpurityLayer LayerFromMessage(const v1::ImpurityLayer& message, const std::string& field,
                               Faults& faults);

// The message that describes a layer; LayerFromMessage gives the same layer back.
void WriteLayer(const ImpurityLayer& layer, v1::ImpurityLayer& message);

// The parts of a pattern that a traced picture is made with and gives.
ImageDrawing ImageFromMessage(const v1::ImageDrawing& message);
void WriteCurves(const std::vector<DrawnCurve>& curves,
                 google::protobuf::RepeatedPtrField<v1::DrawnCurve>& message);

}  // namespace cleave

#endif  // CLEAVE_PROTO_CONVERT_IMPURITY_LAYER_H_
