#ifndef CLEAVE_CLIENT_IO_IMPURITY_LAYER_FILES_H_
#define CLEAVE_CLIENT_IO_IMPURITY_LAYER_FILES_H_

#include <string>
#include <vector>

#include "cleave/v1/scene.pb.h"
#include "core/base/faults.h"

namespace cleave {

// Puts what the files of impurity layers hold in the place of their names, because servers see no
// files: pictures become curves, point data shares, painted surfaces their triangles. Relative
// paths count from `folder`. Returns every fault by field, impurities.layers[2].pattern.image.file;
// a layer with a fault stays as it was.
std::vector<Fault> ReadLayerFiles(const std::string& folder, v1::Impurities& impurities);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_IMPURITY_LAYER_FILES_H_
