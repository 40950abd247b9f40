#ifndef CLEAVE_CLIENT_IO_SERIES_DATA_KEY_H_
#define CLEAVE_CLIENT_IO_SERIES_DATA_KEY_H_

#include <string>

#include "absl/strings/string_view.h"
#include "core/base/state_hash.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"
#include "core/stream/frame.h"

namespace cleave {

// Names the data that an exported file is made of, so that a file that stands already can be kept.
// What is made of a frame may depend on the frames before it (pieces, velocities), so each frame
// goes into the keys of all later ones.
class DataKey {
 public:
  // `format` names the format and every option that its bytes depend on.
  DataKey(const TetMesh& mesh, absl::string_view format);

  void Add(const Frame& frame);
  // "cleave " and 16 hexadecimal digits.
  std::string Comment() const;

 private:
  StateHash hash_;
};

// What a render mesh adds to the name of a format; nothing where it is null.
std::string RenderMeshKey(const RenderMesh* mesh);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SERIES_DATA_KEY_H_
