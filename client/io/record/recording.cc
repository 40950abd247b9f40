#include "client/io/record/recording.h"

#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/io/record/file_access.h"
#include "core/base/status.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/stream_file.h"

namespace cleave {
namespace {

// What the frame source shares between its calls.
struct Player {
  std::unique_ptr<FileAccess> file;
  StreamFileReader reader;
  FrameDecoder decoder;
  std::vector<size_t> positions;  // in the reader's rows, by ascending frame number
};

absl::Status Named(const std::string& path, const absl::Status& status) {
  return absl::Status(status.code(), absl::StrCat(path, ": ", status.message()));
}

}  // namespace

absl::StatusOr<Recording> OpenRecording(const std::string& path, const StreamMesh& mesh) {
  CLEAVE_ASSIGN_OR_RETURN(std::unique_ptr<FileAccess> file, FileAccess::Open(path));
  auto reader = StreamFileReader::Open(*file);
  if (!reader.ok()) return Named(path, reader.status());
  auto decoder = FrameDecoder::Create(reader->header_bytes(), mesh);
  if (!decoder.ok()) return Named(path, decoder.status());
  std::map<int64_t, size_t> newest;  // later rows of a number are of later epochs
  for (size_t i = 0; i < reader->rows().size(); ++i) newest[reader->rows()[i].frame] = i;
  auto player = std::make_shared<Player>(
      Player{std::move(file), *std::move(reader), *std::move(decoder), {}});
  Recording recording;
  recording.header = player->reader.header();
  recording.ended = player->reader.has_footer();
  for (const auto& [number, position] : newest) {
    player->positions.push_back(position);
    recording.rows.push_back(player->reader.rows()[position]);
  }
  recording.frames.surface_only = recording.header.is_surface();
  recording.frames.count = static_cast<int64_t>(newest.size());
  recording.frames.read = [player, path](int64_t position) -> absl::StatusOr<Frame> {
    if (position < 0 || position >= static_cast<int64_t>(player->positions.size()))
      return absl::OutOfRangeError(absl::StrCat(path, ": has no frame at position ", position));
    const absl::Status status =
        player->reader.Seek(player->positions[static_cast<size_t>(position)], player->decoder);
    if (!status.ok()) return Named(path, status);
    return player->decoder.frame();
  };
  return recording;
}

}  // namespace cleave
