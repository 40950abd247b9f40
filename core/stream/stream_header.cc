#include "core/stream/stream_header.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "core/base/bytes.h"
#include "core/base/crc32c.h"
#include "core/base/faults.h"
#include "core/base/sha256.h"
#include "core/base/status.h"
#include "core/stream/stream_state.h"

namespace cleave {
namespace {

constexpr absl::string_view kMagic = "CLVS";
constexpr size_t kFixedBytes = 252;  // without extensions and checksum
constexpr size_t kMaxHeaderBytes = 65536;
constexpr size_t kDigestBytes = 32;
constexpr uint16_t kOptionalExtension = 0x8000;

double Farthest(const StreamHeader& header) {
  double farthest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    farthest =
        std::max({farthest, std::abs(header.bbox_min[axis]), std::abs(header.bbox_max[axis])});
  }
  return farthest;
}

bool IsKnown(const StreamHeader& header) {
  const bool temporal =
      header.order_id == kOrderClient && header.predictor_id == kPredictorTemporal;
  const bool interpolation =
      header.order_id == kOrderMortonLevel && header.predictor_id == kPredictorInterpolation;
  const bool exact = header.order_id == kOrderClient && header.predictor_id == kPredictorExact;
  const bool view =
      header.view_id == kViewState || (header.view_id == kViewSurface && interpolation);
  return view && (interpolation || !header.has_regions()) &&
         (((temporal || exact) && header.coder_id == kCoderZstdPlanes) ||
          (interpolation &&
           (header.coder_id == kCoderZstdPlanes || header.coder_id == kCoderContextRans)));
}

void CheckRange(absl::string_view field, double value, double low, double high, Faults& faults) {
  if (!(value >= low && value <= high)) {
    faults.Error(field, absl::StrCat(value, " is outside [", low, ", ", high, "]"));
  }
}

// What must hold for headers that are made and for those that are read.
void CheckValues(const StreamHeader& header, Faults& faults) {
  constexpr double kMaxIds = std::numeric_limits<int32_t>::max();
  if (header.mesh_sha256.size() != kDigestBytes) {
    faults.Error("mesh_sha256", absl::StrCat(header.mesh_sha256.size(), " bytes; must be 32"));
  }
  CheckRange("node_count", static_cast<double>(header.node_count), 1, kMaxIds, faults);
  CheckRange("edge_count", static_cast<double>(header.edge_count), 0, kMaxIds, faults);
  CheckRange("tet_count", static_cast<double>(header.tet_count), 0, kMaxIds, faults);
  CheckRange("chunk_nodes", header.chunk_nodes, 1, 65536, faults);
  CheckRange("keyframe_interval", header.keyframe_interval, 1, 1e6, faults);
  CheckRange("frames_per_second", header.frames_per_second, 1e-3, 1e9, faults);
  for (int axis = 0; axis < 3; ++axis) {
    CheckRange("bbox_min", header.bbox_min[axis], -1e12, 1e12, faults);
    CheckRange("bbox_max", header.bbox_max[axis], header.bbox_min[axis], 1e12, faults);
    CheckRange("origin", header.origin[axis], header.bbox_min[axis], header.bbox_max[axis], faults);
  }
  if (header.view_id != kViewState &&
      !(header.is_surface() && header.order_id == kOrderMortonLevel)) {
    faults.Error("view_id", absl::StrCat(header.view_id, " is not 1, or 2 with predictor 2"));
  }
  if (header.has_regions() && header.predictor_id != kPredictorInterpolation) {
    faults.Error("regions", "only predictor 2 can code pieces apart");
  }
  CheckRange("domain_bound", header.domain_bound, 0, 0x1p22 * header.tolerance, faults);
  if (!faults.ok()) return;
  if (const absl::Status status = CheckTolerance(header.tolerance, header); !status.ok()) {
    faults.Error("tolerance", status.message());
  }
}

}  // namespace

double QuantisationStep(double tolerance, double domain_bound) {
  // Half a step, the rounding to float32 of a coordinate within the bound, and the roundings of the
  // decoder's own arithmetic (the last factor) together stay within the tolerance.
  return 2.0 * (tolerance - domain_bound * 0x1p-24) * (1.0 - 0x1p-16);
}

double StreamHeader::step() const { return QuantisationStep(tolerance, domain_bound); }

double StreamHeader::diagonal() const {
  double length = 0;
  for (int axis = 0; axis < 3; ++axis) length = std::hypot(length, bbox_max[axis] - bbox_min[axis]);
  return length;
}

double StreamHeader::UnitOf(double frame_tolerance) const {
  const double step = QuantisationStep(frame_tolerance, domain_bound);
  return predictor_id == kPredictorInterpolation ? step / kUnitsPerStep : step;
}

absl::Status CheckTolerance(double tolerance, const StreamHeader& header) {
  if (header.predictor_id == kPredictorExact) {
    if (tolerance == 0) return absl::OkStatus();
    return absl::InvalidArgumentError(
        absl::StrCat("tolerance of ", tolerance, " m; a stream of exact positions has 0"));
  }
  // Rest positions must fit the grid.
  const double finest = header.predictor_id == kPredictorInterpolation ? 0x1p-23 : 0x1p-30;
  const double low = std::max({1e-15, Farthest(header) * finest, header.domain_bound * 0x1p-22});
  if (!(tolerance >= low && tolerance <= 1e9)) {
    return absl::InvalidArgumentError(
        absl::StrCat("tolerance of ", tolerance, " m is outside [", low, ", 1e9] m"));
  }
  return absl::OkStatus();
}

std::string RestPositionsSha256(std::span<const Vec3> rest_positions) {
  static_assert(sizeof(Vec3) == 24);
  return Sha256::Of(absl::string_view(reinterpret_cast<const char*>(rest_positions.data()),
                                      rest_positions.size_bytes()));
}

void ChooseIds(std::span<const Vec3> rest_positions, StreamParameters& parameters) {
  const absl::StatusOr<StreamHeader> header = MakeStreamHeader(parameters, rest_positions);
  if (!header.ok()) return;  // for its maker to report
  StreamHeader finer = *header;
  finer.predictor_id = kPredictorInterpolation;
  const double reach = finer.UnitOf(finer.tolerance) * kMaxQuantised;
  const bool reaches =
      reach >= 256 * finer.diagonal() && CheckTolerance(finer.tolerance, finer).ok();
  parameters.predictor_id = reaches ? kPredictorInterpolation : kPredictorTemporal;
  parameters.coder_id = reaches ? kCoderContextRans : kCoderZstdPlanes;
}

void ChooseExact(StreamParameters& parameters) {
  parameters.predictor_id = kPredictorExact;
  parameters.coder_id = kCoderZstdPlanes;
}

absl::StatusOr<StreamHeader> MakeStreamHeader(const StreamParameters& parameters,
                                              std::span<const Vec3> rest_positions) {
  StreamHeader header;
  header.mesh_sha256 = parameters.mesh_sha256;
  header.rest_sha256 = RestPositionsSha256(rest_positions);
  header.node_count = rest_positions.size();
  header.edge_count = parameters.edge_count;
  header.tet_count = parameters.tet_count;
  header.chunk_nodes = parameters.chunk_nodes;
  header.keyframe_interval = parameters.keyframe_interval;
  header.frames_per_second = parameters.frames_per_second;
  header.tolerance = parameters.tolerance;
  header.predictor_id = parameters.predictor_id;
  header.coder_id = parameters.coder_id;
  header.view_id = parameters.view_id;
  header.required_features = parameters.regions ? kFeatureRegions : 0;
  header.order_id =
      parameters.predictor_id == kPredictorInterpolation ? kOrderMortonLevel : kOrderClient;

  Faults faults;
  if (!rest_positions.empty()) header.bbox_min = header.bbox_max = rest_positions.front();
  for (size_t node = 0; node < rest_positions.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      const double x = rest_positions[node][axis];
      if (!std::isfinite(x)) {
        faults.Error(absl::StrCat("rest_positions[", node, "]"), absl::StrCat(x, " is not finite"));
      }
      header.bbox_min[axis] = std::min(header.bbox_min[axis], x);
      header.bbox_max[axis] = std::max(header.bbox_max[axis], x);
    }
  }
  for (int axis = 0; axis < 3; ++axis)
    header.origin[axis] = 0.5 * header.bbox_min[axis] + 0.5 * header.bbox_max[axis];
  const bool exact = header.predictor_id == kPredictorExact;
  if (header.tolerance == 0 && !exact)
    header.tolerance = RungTolerance(parameters.rung, header.diagonal());
  const double farthest = Farthest(header);
  const double affordable = header.tolerance * 0x1p20;
  if (exact) {
    header.domain_bound = 0;  // float32 is not to the bit
  } else if (farthest <= affordable) {
    header.domain_bound = std::min(affordable, std::max(32 * farthest, header.tolerance * 0x1p10));
  } else if (farthest <= 2 * affordable) {
    header.domain_bound = 2 * farthest;
  }
  CheckValues(header, faults);
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());
  return header;
}

std::string SerializeStreamHeader(const StreamHeader& header) {
  std::string bytes;
  ByteWriter writer(bytes);
  writer.PutBytes(kMagic);
  writer.Put(header.format_major);
  writer.Put(header.format_minor);
  writer.Put(static_cast<uint32_t>(kFixedBytes + sizeof(uint32_t)));
  writer.Put<uint32_t>(0);
  writer.Put(header.required_features);
  writer.Put(header.optional_features);
  writer.PutBytes(header.mesh_sha256);
  writer.PutBytes(header.rest_sha256);
  writer.Put(header.node_count);
  writer.Put(header.edge_count);
  writer.Put(header.tet_count);
  writer.Put(header.order_id);
  writer.Put(header.predictor_id);
  writer.Put(header.coder_id);
  writer.Put(header.view_id);
  writer.Put(header.chunk_nodes);
  writer.Put(header.keyframe_interval);
  writer.Put(header.tolerance);
  writer.Put(header.domain_bound);
  writer.Put(header.frames_per_second);
  writer.Put(header.bbox_min);
  writer.Put(header.bbox_max);
  writer.Put(header.origin);
  bytes.resize(kFixedBytes, '\0');
  writer.Put(Crc32c(bytes));
  return bytes;
}

absl::StatusOr<size_t> StreamHeaderSize(absl::string_view bytes) {
  ByteReader reader(bytes);
  const absl::string_view magic = reader.GetBytes(kMagic.size());
  const auto major = reader.Get<uint16_t>();
  reader.Get<uint16_t>();  // a higher minor version only adds what may be skipped
  const auto size = reader.Get<uint32_t>();
  if (!reader.ok()) return absl::DataLossError("stream header is truncated");
  if (magic != kMagic) return absl::DataLossError("no stream header: the magic is not CLVS");
  if (major != kFormatMajor) {
    return absl::UnimplementedError(
        absl::StrCat("stream format ", major, " is not known; this reader knows ", kFormatMajor));
  }
  if (size < kFixedBytes + sizeof(uint32_t) || size > kMaxHeaderBytes) {
    return absl::DataLossError(absl::StrCat("stream header of ", size, " bytes is outside [",
                                            kFixedBytes + sizeof(uint32_t), ", ", kMaxHeaderBytes,
                                            "]"));
  }
  return size;
}

absl::StatusOr<StreamHeader> ParseStreamHeader(absl::string_view bytes) {
  CLEAVE_ASSIGN_OR_RETURN(const size_t size, StreamHeaderSize(bytes));
  if (bytes.size() != size) {
    return absl::DataLossError(
        absl::StrCat("stream header has ", bytes.size(), " bytes; it declares ", size));
  }
  const absl::string_view covered = bytes.substr(0, size - sizeof(uint32_t));
  ByteReader checksum(bytes.substr(covered.size()));
  if (checksum.Get<uint32_t>() != Crc32c(covered)) {
    return absl::DataLossError("stream header fails its checksum");
  }

  ByteReader reader(covered);
  StreamHeader header;
  reader.GetBytes(kMagic.size());
  header.format_major = reader.Get<uint16_t>();
  header.format_minor = reader.Get<uint16_t>();
  reader.Get<uint32_t>();  // size
  reader.Get<uint32_t>();  // reserved
  header.required_features = reader.Get<uint64_t>();
  header.optional_features = reader.Get<uint64_t>();
  header.mesh_sha256 = std::string(reader.GetBytes(kDigestBytes));
  header.rest_sha256 = std::string(reader.GetBytes(kDigestBytes));
  header.node_count = reader.Get<uint64_t>();
  header.edge_count = reader.Get<uint64_t>();
  header.tet_count = reader.Get<uint64_t>();
  header.order_id = reader.Get<uint16_t>();
  header.predictor_id = reader.Get<uint16_t>();
  header.coder_id = reader.Get<uint16_t>();
  header.view_id = reader.Get<uint16_t>();
  header.chunk_nodes = reader.Get<uint32_t>();
  header.keyframe_interval = reader.Get<uint32_t>();
  header.tolerance = reader.Get<double>();
  header.domain_bound = reader.Get<double>();
  header.frames_per_second = reader.Get<double>();
  header.bbox_min = reader.Get<Vec3>();
  header.bbox_max = reader.Get<Vec3>();
  header.origin = reader.Get<Vec3>();
  reader.GetBytes(reader.left() - (covered.size() - kFixedBytes));  // reserved
  while (reader.left() > 0) {
    const auto type = reader.Get<uint16_t>();
    reader.Get<uint16_t>();  // reserved
    reader.GetBytes(reader.Get<uint32_t>());
    if (!reader.ok()) return absl::DataLossError("stream header has a truncated extension");
    if ((type & kOptionalExtension) == 0) {
      return absl::UnimplementedError(
          absl::StrCat("stream header extension ", type, " is required and not known"));
    }
  }

  const uint64_t unknown = header.required_features & ~kKnownRequiredFeatures;
  if (unknown != 0) {
    return absl::UnimplementedError(
        absl::StrCat("stream needs features that are not known: 0x", absl::Hex(unknown)));
  }
  if (!IsKnown(header)) {
    return absl::UnimplementedError(absl::StrCat(
        "stream has order ", header.order_id, ", predictor ", header.predictor_id, ", coder ",
        header.coder_id, ", view ", header.view_id, ", which this reader does not know together"));
  }
  Faults faults;
  CheckValues(header, faults);
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());
  return header;
}

}  // namespace cleave
