#include "client/io/bake/bake.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <system_error>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "client/io/bake/bake_codec.h"
#include "client/io/bake/baked_surface.h"
#include "client/io/bake/growing_file.h"
#include "client/io/export/obj.h"
#include "client/io/export/surface_materials.h"
#include "client/io/series/data_key.h"
#include "client/io/series/frame_check.h"
#include "client/io/series/write_aside.h"
#include "core/base/faults.h"
#include "core/base/status.h"
#include "core/base/stopwatch.h"
#include "core/damage/named_pieces.h"
#include "core/mesh/incidence.h"

namespace cleave {
namespace {

// What a kill costs at most, against what marking costs.
constexpr double kSecondsBetweenMarks = 2;

absl::Status CheckOptions(const FrameSource& frames, const BakeOptions& options) {
  Faults faults;
  if (frames.count <= 0) faults.Error("frames", "there are none to bake");
  if (options.name.empty() || absl::StrContains(options.name, '/')) {
    faults.Error("name", absl::StrCat("\"", options.name, "\" is not a file name"));
  }
  if (options.playback_rate && !(*options.playback_rate >= 1e-3 && *options.playback_rate <= 1e5)) {
    faults.Error("playback_rate",
                 absl::StrCat(*options.playback_rate, " frames/s is outside [0.001, 100000]"));
  }
  const double length = std::hypot(options.up[0], options.up[1], options.up[2]);
  if (!(length > 0 && std::isfinite(length))) {
    faults.Error("up", "must be finite and not zero");
  }
  return faults.ToStatus();
}

// A file to be baked.
struct Target {
  std::string path;
  absl::string_view format;  // with everything that its bytes depend on but the context
  std::function<absl::StatusOr<std::unique_ptr<BakeCodec>>(const BakeContext&)> codec;
};

class Bake {
 public:
  Bake(const TetMesh& mesh, const FrameSource& frames, const BakeOptions& options,
       const Progress& progress)
      : mesh_(mesh),
        frames_(frames),
        options_(options),
        progress_(progress),
        incidence_(BuildIncidence(mesh)),
        materials_(mesh) {}

  absl::StatusOr<BakeResult> Run() {
    NamedPieces pieces(mesh_, incidence_);
    CLEAVE_RETURN_IF_ERROR(NamePieces(pieces));
    timing_ = {frames_.count, first_.frame, last_.frame,
               first_.time,   last_.time,   options_.playback_rate};
    surface_ = BakeSurface(mesh_, incidence_, pieces, last_.broken_edges, options_.render_mesh);
    result_.gaps = surface_.gaps;
    if (surface_.pieces.empty() || surface_.topology.triangles.empty()) {
      return absl::InvalidArgumentError("the mesh has no tets, so there are no pieces to bake");
    }
    CLEAVE_RETURN_IF_ERROR(MakeDirectories(options_.folder));
    switch (options_.format) {
      case BakeFormat::kPc2:
        CLEAVE_RETURN_IF_ERROR(WriteCaches(PointCacheKind::kPc2, "pc2"));
        break;
      case BakeFormat::kMdd:
        CLEAVE_RETURN_IF_ERROR(WriteCaches(PointCacheKind::kMdd, "mdd"));
        break;
      case BakeFormat::kGlb:
        CLEAVE_RETURN_IF_ERROR(Write({PathOf("glb"), "glb", MakeGlb}));
        break;
      case BakeFormat::kUsda:
        CLEAVE_RETURN_IF_ERROR(Write({PathOf("usda"), "usda", MakeUsda}));
        break;
    }
    return std::move(result_);
  }

 private:
  // Goes through all frames, for the pieces at the end have their names from how they came about.
  // Fills `first_` and `last_`.
  absl::Status NamePieces(NamedPieces& pieces) {
    for (int64_t position = 0; position < frames_.count; ++position) {
      if (frames_.pass_by) {
        const auto name = [&](const Frame& frame) -> absl::Status {
          CLEAVE_RETURN_IF_ERROR(CheckFrame(frame, mesh_, incidence_.edge_count(),
                                            -std::numeric_limits<double>::infinity()));
          pieces.Break(frame.broken_edges);
          return absl::OkStatus();
        };
        CLEAVE_RETURN_IF_ERROR(frames_.pass_by(position, name));
      }
      CLEAVE_ASSIGN_OR_RETURN(Frame frame, frames_.read(position));
      CLEAVE_RETURN_IF_ERROR(
          CheckFrame(frame, mesh_, incidence_.edge_count(),
                     position > 0 ? last_.time : -std::numeric_limits<double>::infinity()));
      std::vector<int32_t> edges;
      std::set_difference(frame.broken_edges.begin(), frame.broken_edges.end(),
                          last_.broken_edges.begin(), last_.broken_edges.end(),
                          std::back_inserter(edges));
      pieces.Break(edges);
      if (position == 0) first_ = frame;
      last_ = std::move(frame);
      CLEAVE_RETURN_IF_ERROR(Show(position + 1, 1));
    }
    return absl::OkStatus();
  }

  // Tells of a frame gone through, of all in `passes`; Cancelled where that was the last.
  absl::Status Show(int64_t done, int64_t passes) const {
    if (!progress_ || progress_(done, passes * frames_.count)) return absl::OkStatus();
    return absl::CancelledError(
        absl::StrCat("export stopped after ", done, " of ", passes * frames_.count, " frames"));
  }

  std::string PathOf(absl::string_view ending) const {
    const std::string file = absl::StrCat(options_.name, ".", ending);
    return options_.folder.empty() ? file : absl::StrCat(options_.folder, "/", file);
  }

  // Everything that is known before the first frame goes in, so that files of other data are told
  // apart at once.
  DataKey StartKey(absl::string_view format) const {
    const auto& up = options_.up;
    DataKey key(mesh_,
                absl::StrFormat("bake %s %s, %d frames, rate %.17g, up %.17g %.17g %.17g, %d%s",
                                format, options_.name, frames_.count,
                                options_.playback_rate.value_or(0), up[0], up[1], up[2],
                                options_.velocities ? 1 : 0, RenderMeshKey(options_.render_mesh)));
    key.Add(first_);
    key.Add(last_);
    // Names of pieces stand before the first frame and depend on all.
    Frame names;
    names.broken_edges = surface_.point_pieces;
    key.Add(names);
    return key;
  }

  absl::Status WriteCaches(PointCacheKind kind, absl::string_view ending) {
    CLEAVE_RETURN_IF_ERROR(WriteObj(StartKey("obj").Comment()));
    if (options_.velocities) {
      const std::string path = PathOf(absl::StrCat("velocity.", ending));
      const std::string format = absl::StrCat("velocity ", ending);
      CLEAVE_RETURN_IF_ERROR(Write({path, format, [&](const BakeContext& context) {
                                      return MakePointCache(context, kind, true);
                                    }}));
      result_.also.push_back(path);
    }
    return Write({PathOf(ending), ending, [&](const BakeContext& context) {
                    return MakePointCache(context, kind, false);
                  }});
  }

  // The surface at rest. Normals would be wrong in every other frame.
  absl::Status WriteObj(const std::string& comment) {
    ShownSurface shown;
    for (const SurfacePoint& point : surface_.topology.points) shown.points.push_back(point.rest);
    shown.rest_points = shown.points;
    shown.triangles = surface_.topology.triangles;
    shown.inside = surface_.topology.inside;
    shown.pieces = surface_.triangle_pieces;
    shown.regions = surface_.triangle_regions;
    shown.uvs = surface_.uvs;
    CLEAVE_ASSIGN_OR_RETURN(
        const std::string bytes,
        EncodeObj(shown, materials_,
                  {comment, options_.name, absl::StrCat(options_.name, ".mtl"), false}));
    CLEAVE_RETURN_IF_ERROR(WriteAside(PathOf("mtl"), EncodeMtl(materials_)));
    CLEAVE_RETURN_IF_ERROR(WriteAside(PathOf("obj"), bytes));
    result_.also.push_back(PathOf("obj"));
    result_.also.push_back(PathOf("mtl"));
    return absl::OkStatus();
  }

  // Tries what stands: the whole file, then the part; then begins anew.
  absl::Status Write(const Target& target) {
    const DataKey start = StartKey(target.format);
    std::optional<FileMark> whole = FindMark(ReadStart(absl::StrCat(target.path, ".json"), 4096));
    std::error_code error;
    const auto size = std::filesystem::file_size(target.path, error);
    if (whole && (error || size != static_cast<uintmax_t>(whole->bytes))) whole.reset();
    GrowingFile file(target.path);
    const std::optional<FileMark> part = file.Part();
    result_.path = target.path;
    result_.written = 0;
    result_.kept = 0;
    for (const std::optional<FileMark>& mark : {whole, part, std::optional<FileMark>(FileMark{})}) {
      if (!mark || (mark->units > 0 && mark->start_key != start.Comment())) continue;
      CLEAVE_ASSIGN_OR_RETURN(const bool fits, WriteAfter(target, start, *mark, file));
      if (fits) return absl::OkStatus();
    }
    return absl::InternalError(absl::StrCat(target.path, ": was not begun"));
  }

  // Goes through all frames, and writes those after `mark`. False if the frames up to there are not
  // those that it was made from; then nothing has changed.
  absl::StatusOr<bool> WriteAfter(const Target& target, const DataKey& start, const FileMark& mark,
                                  GrowingFile& file) {
    const BakeContext context{surface_,           materials_,      timing_,
                              options_.name,      start.Comment(), options_.up,
                              options_.velocities};
    CLEAVE_ASSIGN_OR_RETURN(const auto codec, target.codec(context));
    const int64_t units = codec->passes() * frames_.count;
    if (mark.units > units) return false;
    if (mark.units == 0) {
      CLEAVE_RETURN_IF_ERROR(file.Begin());
      CLEAVE_RETURN_IF_ERROR(file.Append(codec->Begin()));
    }
    DataKey key = start;
    std::unique_ptr<BakedMotion> motion;
    std::string bytes;
    Stopwatch since_mark;
    double marked = 0;
    for (int64_t unit = 0; unit < units; ++unit) {
      const int64_t position = unit % frames_.count;
      if (position == 0) {
        motion = std::make_unique<BakedMotion>(mesh_, incidence_, surface_, last_.broken_edges);
      }
      if (frames_.pass_by) {
        // A crumb keeps the turn that it had last, and velocities are since the frame before.
        CLEAVE_RETURN_IF_ERROR(frames_.pass_by(position, [&](const Frame& left_out) {
          key.Add(left_out);
          return motion->Advance(left_out);
        }));
      }
      CLEAVE_ASSIGN_OR_RETURN(const Frame frame, frames_.read(position));
      CLEAVE_RETURN_IF_ERROR(motion->Advance(frame));
      key.Add(frame);
      const BakeFrame baked{position, frame.frame, frame.time, motion->points(),
                            motion->velocities()};
      CLEAVE_RETURN_IF_ERROR(codec->Note(unit / frames_.count, baked));
      if (unit + 1 == mark.units) {
        if (key.Comment() != mark.key) return false;
        if (mark.units == units) {
          result_.kept = frames_.count;
          return true;
        }
        CLEAVE_RETURN_IF_ERROR(file.GoOn(mark));
      } else if (unit >= mark.units) {
        bytes.clear();
        codec->Encode(unit / frames_.count, baked, bytes);
        CLEAVE_RETURN_IF_ERROR(file.Append(bytes));
      }
      const absl::Status shown = Show(unit + 1, codec->passes());
      const bool is_last = unit + 1 == units;
      if (unit >= mark.units && !is_last &&
          (!shown.ok() || since_mark.Seconds() - marked > kSecondsBetweenMarks)) {
        CLEAVE_RETURN_IF_ERROR(file.Save({start.Comment(), key.Comment(), unit + 1, 0}));
        marked = since_mark.Seconds();
      }
      CLEAVE_RETURN_IF_ERROR(shown);
    }
    CLEAVE_RETURN_IF_ERROR(file.Append(codec->End()));
    const int64_t whole_bytes = file.bytes();
    CLEAVE_RETURN_IF_ERROR(file.Finish(codec->Head()));
    result_.kept = mark.units / codec->passes();
    result_.written = frames_.count - result_.kept;
    return Describe(target, {start.Comment(), key.Comment(), units, whole_bytes});
  }

  // FILE.json. True, or the error of writing it.
  absl::StatusOr<bool> Describe(const Target& target, const FileMark& mark) {
    std::string out = absl::StrFormat(
        "{%s,\n \"format\": \"%s\", \"unit\": \"m\", \"up\": [%.9g, %.9g, %.9g],\n"
        " \"frames\": %d, \"first_frame\": %d, \"last_frame\": %d, \"first_time\": %.9g,\n"
        " \"simulated_frames_per_second\": %.9g, \"playback_frames_per_second\": %.9g,\n"
        " \"points\": %d, \"triangles\": %d,\n \"pieces\": [",
        EncodeMark(mark), target.format, options_.up[0], options_.up[1], options_.up[2],
        timing_.count, timing_.first_frame, timing_.last_frame, timing_.first_time,
        timing_.simulated_rate(), timing_.rate(), surface_.topology.points.size(),
        surface_.topology.triangles.size());
    for (size_t i = 0; i < surface_.pieces.size(); ++i) {
      const BakedPiece& piece = surface_.pieces[i];
      absl::StrAppendFormat(&out,
                            "%s\n  {\"piece\": %d, \"smallest_node\": %d, \"nodes\": %d, "
                            "\"volume\": %.9g, \"center\": [%.9g, %.9g, %.9g]}",
                            i == 0 ? "" : ",", i, piece.smallest_node, piece.nodes, piece.volume,
                            piece.center[0], piece.center[1], piece.center[2]);
    }
    out += "\n ]}\n";
    CLEAVE_RETURN_IF_ERROR(WriteAside(absl::StrCat(target.path, ".json"), out));
    return true;
  }

  const TetMesh& mesh_;
  const FrameSource& frames_;
  const BakeOptions& options_;
  const Progress& progress_;
  const Incidence incidence_;
  const SurfaceMaterials materials_;
  Frame first_;
  Frame last_;
  BakeTiming timing_;
  BakedSurface surface_;
  BakeResult result_;
};

}  // namespace

absl::StatusOr<BakeResult> WriteBake(const TetMesh& mesh, const FrameSource& frames,
                                     const BakeOptions& options, const Progress& progress) {
  CLEAVE_RETURN_IF_ERROR(CheckOptions(frames, options));
  if (frames.surface_only) {
    return absl::FailedPreconditionError(
        "the recording is of a surface view, which does not tell of nodes before a crack shows "
        "them: no bake");
  }
  return Bake(mesh, frames, options, progress).Run();
}

}  // namespace cleave
