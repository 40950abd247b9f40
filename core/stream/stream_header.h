#ifndef CLEAVE_CORE_STREAM_STREAM_HEADER_H_
#define CLEAVE_CORE_STREAM_STREAM_HEADER_H_

#include <cstdint>
#include <span>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/base/vec3.h"
#include "core/stream/rungs.h"
#include "core/stream/stream_mesh.h"

namespace cleave {

// The ids that FORMAT.md defines. New ones are added there, never redefined.
inline constexpr uint16_t kFormatMajor = 1;
inline constexpr uint16_t kFormatMinor = 0;
inline constexpr uint16_t kOrderClient = 1;             // nodes in the order of the client's mesh
inline constexpr uint16_t kOrderMortonLevel = 2;        // from coarse to fine (node_order.h)
inline constexpr uint16_t kPredictorTemporal = 1;       // rest, last frame, or linear, by chunk
inline constexpr uint16_t kPredictorInterpolation = 2;  // from coarser nodes; needs order 2
inline constexpr uint16_t kPredictorExact = 3;          // as 1, to the bit; tolerance 0
inline constexpr uint16_t kCoderZstdPlanes = 1;         // zstd over byte planes
inline constexpr uint16_t kCoderContextRans = 2;        // residual_coder.h; needs predictor 2
inline constexpr uint16_t kViewState = 1;               // every node and every broken edge
inline constexpr uint16_t kViewSurface = 2;     // what surfaces are drawn from; needs predictor 2
inline constexpr uint64_t kFeatureRegions = 1;  // some pieces may be coarser; needs predictor 2
inline constexpr uint64_t kKnownRequiredFeatures = kFeatureRegions;

// What holds for a whole stream; FORMAT.md, section "Stream header".
struct StreamHeader {
  uint16_t format_major = kFormatMajor;
  uint16_t format_minor = kFormatMinor;
  uint64_t required_features = 0;  // a reader refuses bits that it does not know
  uint64_t optional_features = 0;  // a reader ignores bits that it does not know
  std::string mesh_sha256;         // 32 raw bytes: names the mesh asset that ids refer to
  std::string rest_sha256;         // 32 raw bytes: of the rest positions that keyframes start from
  uint64_t node_count = 0;
  uint64_t edge_count = 0;
  uint64_t tet_count = 0;
  uint16_t order_id = kOrderClient;
  uint16_t predictor_id = kPredictorTemporal;
  uint16_t coder_id = kCoderZstdPlanes;
  uint16_t view_id = kViewState;
  uint32_t chunk_nodes = 16384;     // nodes in every positions section but the last, [1, 65536]
  uint32_t keyframe_interval = 24;  // frames
  double tolerance = 0;             // m, largest error of a coordinate; 0 with predictor 3
  double domain_bound = 0;          // m, see MakeStreamHeader
  double frames_per_second = 24;
  Vec3 bbox_min{};  // m, of the rest positions
  Vec3 bbox_max{};  // m
  Vec3 origin{};    // m, where quantised coordinates are zero

  // The grid on which positions lie: a coordinate is origin + integer * unit. For predictor 1 the
  // unit is a step, for predictor 2 a 64th of one.
  double step() const;
  double diagonal() const;  // m, of the rest bounding box
  double UnitOf(double tolerance) const;
  bool is_surface() const { return view_id == kViewSurface; }
  bool has_regions() const { return (required_features & kFeatureRegions) != 0; }
};

// What the maker of a stream chooses.
struct StreamParameters {
  std::string mesh_sha256;  // 32 raw bytes
  uint64_t edge_count = 0;  // Incidence::edge_count()
  uint64_t tet_count = 0;
  double tolerance = 0;  // m; 0: that of `rung`
  Rung rung = Rung::kStandard;
  uint32_t keyframe_interval = 24;  // frames, [1, 1e6]
  double frames_per_second = 24;    // [1e-3, 1e9]
  uint32_t chunk_nodes = 16384;     // [1, 65536]; 16384 keeps every section below 256 KiB
  uint16_t predictor_id = kPredictorTemporal;
  uint16_t coder_id = kCoderZstdPlanes;
  uint16_t view_id = kViewState;
  bool regions = false;  // its encoder may be given a region of interest; needs predictor 2
};

// Sets the ids that code a body with these rest positions (m) best at the parameters' tolerance:
// predictor 2 and coder 2 where their grid reaches 256 of its diagonals, else predictor 1, whose
// grid is coarser.
void ChooseIds(std::span<const Vec3> rest_positions, StreamParameters& parameters);

// Sets the ids that keep every coordinate to the bit, wherever it is; tolerance must be 0.
void ChooseExact(StreamParameters& parameters);

// Fills a header for a body with these rest positions (m), choosing the origin (centre of the
// bounding box) and the domain bound: |decoded - x| <= tolerance always holds for the decoder's
// doubles, and where |x| <= domain_bound also after they are rounded to float32. The bound is 32
// times the body's farthest coordinate, or as much of that as costs the grid at most a sixteenth of
// its step; where even the body itself costs an eighth or more, it is 0 and nothing is promised
// (the tolerance is finer than float32 there). Errors: InvalidArgument that names every field at
// fault; the tolerance must be in [1e-15, 1e9] m and at least 2^-30 (predictor 2: 2^-23) of the
// farthest coordinate. With predictor 3 it must be 0, and every double is kept.
absl::StatusOr<StreamHeader> MakeStreamHeader(const StreamParameters& parameters,
                                              std::span<const Vec3> rest_positions);

std::string SerializeStreamHeader(const StreamHeader& header);

// Size in bytes of the stream header that `bytes` begin with, so that it can be cut from a file.
// `bytes` needs to hold at least kStreamHeaderPrefixBytes. Errors: as ParseStreamHeader.
inline constexpr size_t kStreamHeaderPrefixBytes = 12;
absl::StatusOr<size_t> StreamHeaderSize(absl::string_view bytes);

// Reads exactly one header. Errors: DataLoss (truncated, checksum), Unimplemented (version, feature
// or id that this reader does not know), InvalidArgument (values out of range).
absl::StatusOr<StreamHeader> ParseStreamHeader(absl::string_view bytes);

// SHA-256 of positions as they lie in memory: little-endian doubles x, y, z of each node.
std::string RestPositionsSha256(std::span<const Vec3> rest_positions);

// The grid step for a tolerance (m) that may differ from the header's; FORMAT.md, "Quantisation".
double QuantisationStep(double tolerance, double domain_bound);

// OK when a stream with this header is of this mesh: the rest positions' digest, and for predictor
// 2 the number of edges and that they ascend as FORMAT.md numbers them. Error: FailedPrecondition.
absl::Status CheckStreamMesh(const StreamHeader& header, const StreamMesh& mesh);

// OK when a stream of these rest positions may use the tolerance.
absl::Status CheckTolerance(double tolerance, const StreamHeader& header);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_STREAM_HEADER_H_
