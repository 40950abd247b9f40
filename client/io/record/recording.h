#ifndef CLEAVE_CLIENT_IO_RECORD_RECORDING_H_
#define CLEAVE_CLIENT_IO_RECORD_RECORDING_H_

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/io/series/frame_source.h"
#include "core/stream/frame_log.h"
#include "core/stream/stream_header.h"
#include "core/stream/stream_mesh.h"

namespace cleave {

// A recorded stream as exporters and pictures take it.
struct Recording {
  StreamHeader header;
  std::vector<IndexRow> rows;  // of the frames in `frames`, by ascending frame number
  FrameSource frames;          // keeps the file open for as long as it is held
  bool ended = true;           // false: nobody ended the file, it was cut or is still written
};

// Opens a .clv of this mesh. Where a session was rewound, a frame is given as it was last. Errors:
// those of FileAccess, StreamFileReader and FrameDecoder::Create.
absl::StatusOr<Recording> OpenRecording(const std::string& path, const StreamMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_RECORD_RECORDING_H_
