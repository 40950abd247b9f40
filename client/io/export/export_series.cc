#include "client/io/export/export_series.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "client/io/export/obj.h"
#include "client/io/export/ply.h"
#include "client/io/export/surface_grid.h"
#include "client/io/export/volume_sequence.h"
#include "client/io/export/vtu.h"
#include "client/io/series/data_key.h"
#include "client/io/series/surface_sequence.h"
#include "client/io/series/write_aside.h"
#include "core/base/state_hash.h"
#include "core/base/status.h"

namespace cleave {
namespace {

// How a format goes on to a frame, and what it makes of it.
struct Format {
  // Called for every frame to be written, also where its file stands: later frames depend on it.
  std::function<absl::Status(const Frame& frame)> advance;
  std::function<absl::Status(const Frame& frame)> pass_by;  // for a frame that gets no file
  std::function<absl::StatusOr<std::string>(const Frame& frame, const std::string& comment)> encode;
};

// Tells potencies apart in a key.
std::string PotencyName(const std::vector<double>& potencies) {
  StateHash hash;
  hash.Update(potencies.data(), potencies.size() * sizeof(double));
  return absl::StrCat(hash.Digest());
}

int64_t GapsOf(const SurfaceSequence& sequence) {
  return sequence.embedded() == nullptr ? 0 : sequence.embedded()->gaps();
}

// What series carry beside positions, from options for the lot.
SequenceOptions Carried(const FrameSource& frames, const ExportOptions& options) {
  return {.strains = !frames.surface_only,
          .damages = true,
          .displacements = true,
          .velocities = !frames.surface_only,
          .node_potencies = options.node_potencies,
          .sources = true,
          .render_mesh = options.render_mesh};
}

class SeriesWriter {
 public:
  SeriesWriter(const TetMesh& mesh, const ExportOptions& options, absl::string_view ending,
               absl::string_view format)
      : options_(options),
        nodes_(mesh.node_count()),
        ending_(ending),
        key_(mesh, absl::StrCat(format, " ", PotencyName(options.node_potencies),
                                RenderMeshKey(options.render_mesh))) {}

  absl::Status Write(const FrameSource& frames, const Format& format, const Progress& progress) {
    if (frames.count <= 0) return absl::InvalidArgumentError("there are no frames to export");
    CLEAVE_RETURN_IF_ERROR(CheckPotencies());
    CLEAVE_RETURN_IF_ERROR(MakeDirectories(options_.folder));
    for (int64_t position = 0; position < frames.count; ++position) {
      if (frames.pass_by) {
        CLEAVE_RETURN_IF_ERROR(frames.pass_by(position, [&](const Frame& frame) {
          key_.Add(frame);
          return format.pass_by(frame);
        }));
      }
      CLEAVE_ASSIGN_OR_RETURN(const Frame frame, frames.read(position));
      CLEAVE_RETURN_IF_ERROR(format.advance(frame));
      key_.Add(frame);
      const std::string file = absl::StrFormat("%s_%06d.%s", options_.name, frame.frame, ending_);
      const std::string path = PathOf(file);
      // The comment stands in the first lines; a file is only ever renamed into place whole.
      if (absl::StrContains(ReadStart(path, 256), key_.Comment())) {
        ++result_.kept;
      } else {
        CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, format.encode(frame, key_.Comment()));
        CLEAVE_RETURN_IF_ERROR(WriteAside(path, bytes));
        ++result_.written;
      }
      entries_.push_back({frame.time, file});
      if (progress && !progress(position + 1, frames.count)) {
        return absl::CancelledError(
            absl::StrCat("export stopped after ", position + 1, " of ", frames.count, " frames"));
      }
    }
    return absl::OkStatus();
  }

  absl::Status WriteCollection() {
    if (entries_.empty()) return absl::OkStatus();
    CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, EncodePvd(entries_));
    result_.collection = PathOf(absl::StrCat(options_.name, ".pvd"));
    return WriteAside(result_.collection, bytes);
  }

  ExportResult result(int64_t gaps) const {
    ExportResult result = result_;
    result.gaps = gaps;
    return result;
  }

 private:
  absl::Status CheckPotencies() const {
    const auto count = static_cast<int64_t>(options_.node_potencies.size());
    if (count == 0 || count == nodes_) return absl::OkStatus();
    return absl::InvalidArgumentError(
        absl::StrCat("node_potencies: has ", count, " items; the mesh has ", nodes_, " nodes"));
  }

  std::string PathOf(const std::string& file) const {
    return options_.folder.empty() ? file : absl::StrCat(options_.folder, "/", file);
  }

  const ExportOptions& options_;
  const int64_t nodes_;
  const std::string ending_;
  DataKey key_;
  std::vector<PvdEntry> entries_;
  ExportResult result_;
};

}  // namespace

absl::StatusOr<ExportResult> WriteVtuSeries(const TetMesh& mesh, const FrameSource& frames,
                                            VtuContent content, const ExportOptions& options,
                                            const Progress& progress) {
  if (content == VtuContent::kVolume && frames.surface_only) {
    return absl::FailedPreconditionError(
        "the recording is of a surface view, which does not tell of all nodes: no volume");
  }
  SequenceOptions carried = Carried(frames, options);
  if (content == VtuContent::kVolume) carried.render_mesh = nullptr;
  SurfaceSequence sequence(mesh, carried);
  std::optional<VolumeSequence> volume;
  if (content == VtuContent::kVolume) volume.emplace(mesh, sequence, options.node_potencies);
  Format format;
  format.pass_by = [&](const Frame& frame) -> absl::Status {
    CLEAVE_RETURN_IF_ERROR(sequence.PassBy(frame));
    if (volume) volume->Advance(frame);
    return absl::OkStatus();
  };
  format.advance = [&](const Frame& frame) -> absl::Status {
    CLEAVE_RETURN_IF_ERROR(sequence.Advance(frame));
    if (volume) volume->Advance(frame);
    return absl::OkStatus();
  };
  format.encode = [&](const Frame& frame, const std::string& comment) {
    return EncodeVtu(volume ? volume->Grid(frame) : SurfaceGrid(sequence), comment);
  };
  SeriesWriter writer(mesh, options, "vtu", volume ? "vtu volume" : "vtu surface");
  const absl::Status written = writer.Write(frames, format, progress);
  const absl::Status collected = writer.WriteCollection();
  CLEAVE_RETURN_IF_ERROR(written);
  CLEAVE_RETURN_IF_ERROR(collected);
  return writer.result(GapsOf(sequence));
}

absl::StatusOr<ExportResult> WritePlySeries(const TetMesh& mesh, const FrameSource& frames,
                                            const ExportOptions& options,
                                            const Progress& progress) {
  SurfaceSequence sequence(mesh, Carried(frames, options));
  Format format;
  format.pass_by = [&](const Frame& frame) { return sequence.PassBy(frame); };
  format.advance = [&](const Frame& frame) { return sequence.Advance(frame); };
  format.encode = [&](const Frame&, const std::string& comment) {
    return EncodePly(sequence.surface(), comment);
  };
  SeriesWriter writer(mesh, options, "ply", "ply");
  CLEAVE_RETURN_IF_ERROR(writer.Write(frames, format, progress));
  return writer.result(GapsOf(sequence));
}

absl::StatusOr<ExportResult> WriteObjSeries(const TetMesh& mesh, const FrameSource& frames,
                                            const ExportOptions& options,
                                            const Progress& progress) {
  SurfaceSequence sequence(mesh, {.render_mesh = options.render_mesh});
  const SurfaceMaterials materials(mesh);
  const ObjOptions look{"", options.name, absl::StrCat(options.name, ".mtl"), true};
  Format format;
  format.pass_by = [&](const Frame& frame) { return sequence.PassBy(frame); };
  format.advance = [&](const Frame& frame) { return sequence.Advance(frame); };
  format.encode = [&](const Frame&, const std::string& comment) {
    ObjOptions of_frame = look;
    of_frame.comment = comment;
    return EncodeObj(sequence.surface(), materials, of_frame);
  };
  SeriesWriter writer(mesh, options, "obj", absl::StrCat("obj ", options.name));
  CLEAVE_RETURN_IF_ERROR(writer.Write(frames, format, progress));
  CLEAVE_RETURN_IF_ERROR(WriteAside(options.folder.empty()
                                        ? look.material_file
                                        : absl::StrCat(options.folder, "/", look.material_file),
                                    EncodeMtl(materials)));
  return writer.result(GapsOf(sequence));
}

}  // namespace cleave
