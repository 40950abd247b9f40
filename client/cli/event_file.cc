#include "client/cli/event_file.h"

#include <filesystem>
#include <iterator>
#include <system_error>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/cli/json_line.h"
#include "core/base/frame_line.h"

namespace cleave {
namespace {

template <typename Numbers>
std::string NumberList(const Numbers& numbers) {
  std::vector<std::string> values;
  for (const auto number : numbers) values.push_back(JsonNumber(static_cast<double>(number)));
  return JsonList(values);
}

JsonLine Begin(const v1::FrameEvents& events, const char* what, const v1::BreakPlace& place) {
  JsonLine line;
  line.Add("frame", events.frame()).Add("event", what).Add("time", place.time());
  return line;
}

std::string End(JsonLine& line, const v1::BreakPlace& place) {
  line.AddJson("rest", NumberList(place.rest()))
      .AddJson("position", NumberList(place.position()))
      .Add("energy", place.energy());
  return line.Str() + "\n";
}

void AddPart(const v1::Piece& part, JsonLine& line) {
  line.Add("volume", part.volume())
      .Add("node_count", part.node_count())
      .Add("first_node", int64_t{part.first_node()});
}

}  // namespace

std::string EventLines(const v1::FrameEvents& events) {
  std::string lines;
  for (const v1::Piece& piece : events.pieces()) {
    JsonLine line;
    line.Add("frame", events.frame()).Add("event", "piece").Add("piece", int64_t{piece.piece()});
    AddPart(piece, line);
    lines += line.Str() + "\n";
  }
  for (const v1::EdgeBreak& broken : events.edge_breaks()) {
    JsonLine line = Begin(events, "edge_break", broken.place());
    line.Add("edge", int64_t{broken.edge()})
        .AddJson("nodes", NumberList(broken.nodes()))
        .AddJson("pieces", NumberList(broken.pieces()));
    lines += End(line, broken.place());
  }
  for (const v1::PieceSplit& split : events.splits()) {
    JsonLine line = Begin(events, "split", split.place());
    line.Add("piece", int64_t{split.kept().piece()});
    AddPart(split.kept(), line);
    std::vector<int32_t> pieces;
    for (const v1::Separation& separation : split.separations())
      pieces.push_back(separation.part().piece());
    line.AddJson("separated", NumberList(pieces));
    lines += End(line, split.place());
    for (const v1::Separation& separation : split.separations()) {
      JsonLine off = Begin(events, "separation", separation.place());
      off.Add("piece", int64_t{separation.part().piece()})
          .Add("from", int64_t{split.kept().piece()});
      AddPart(separation.part(), off);
      lines += End(off, separation.place());
    }
  }
  return lines;
}

absl::StatusOr<std::unique_ptr<EventFile>> EventFile::Open(const std::string& path,
                                                           int64_t last_frame) {
  if (std::ifstream in(path, std::ios::binary); in) {
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    size_t size = 0;
    int64_t before = 0;
    for (size_t end; (end = bytes.find('\n', size)) != std::string::npos; size = end + 1) {
      const int64_t frame = FrameOfLine(absl::string_view(bytes).substr(size, end - size));
      if (frame < before || frame > last_frame) break;
      before = frame;
    }
    std::error_code error;
    if (size < bytes.size()) std::filesystem::resize_file(path, size, error);
    if (error) return absl::InternalError(absl::StrCat("cutting ", path, ": ", error.message()));
  }
  std::unique_ptr<EventFile> file(new EventFile(path));
  if (!file->out_) return absl::InternalError(absl::StrCat(path, " cannot be written"));
  return file;
}

absl::Status EventFile::Append(const v1::FrameEvents& events) {
  out_ << EventLines(events) << std::flush;
  if (!out_) return absl::InternalError(absl::StrCat("writing ", path_, " failed"));
  return absl::OkStatus();
}

}  // namespace cleave
