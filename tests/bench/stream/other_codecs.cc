#include "tests/bench/stream/other_codecs.h"

#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/stream/section_coder.h"

#ifdef CLEAVE_HAS_DRACO
#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#endif
#ifdef CLEAVE_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace cleave {
namespace {

std::string Compress(const void* data, size_t size) {
  std::string coded(ZSTD_compressBound(size), '\0');
  coded.resize(ZSTD_compress(coded.data(), coded.size(), data, size, 3));
  return coded;
}

std::string Decompress(const std::string& coded) {
  std::string raw(ZSTD_getFrameContentSize(coded.data(), coded.size()), '\0');
  ZSTD_decompress(raw.data(), raw.size(), coded.data(), coded.size());
  return raw;
}

class RawZstd : public OtherCodec {
 public:
  const char* name() const override { return "zstd-3 on floats (lossless)"; }
  std::string Encode(const std::vector<float>& positions, double /*tolerance*/) override {
    return Compress(positions.data(), positions.size() * sizeof(float));
  }
  void Decode(const std::string& coded) override { Decompress(coded); }
};

// Rounded to the grid, less the frame before, byte planes, zstd-3.
class DeltaZstd : public OtherCodec {
 public:
  const char* name() const override { return "delta, byte planes, zstd-3"; }
  std::string Encode(const std::vector<float>& positions, double tolerance) override {
    last_.resize(positions.size());
    std::vector<int32_t> residuals(positions.size());
    for (size_t at = 0; at < positions.size(); ++at) {
      const auto q = static_cast<int32_t>(std::floor(positions[at] / (2 * tolerance) + 0.5));
      residuals[at] = q - last_[at];
      last_[at] = q;
    }
    const std::string planes = ToBytePlanes(residuals);
    return Compress(planes.data(), planes.size());
  }
  void Decode(const std::string& coded) override {
    decoded_.resize(last_.size());
    std::vector<int32_t> residuals(last_.size());
    FromBytePlanes(Decompress(coded), residuals);
    for (size_t at = 0; at < residuals.size(); ++at) decoded_[at] += residuals[at];
  }

 private:
  std::vector<int32_t> last_, decoded_;
};

int BitsFor(const std::vector<float>& positions, double tolerance) {
  const auto [low, high] = std::minmax_element(positions.begin(), positions.end());
  return std::clamp(static_cast<int>(std::ceil(std::log2((*high - *low) / (2 * tolerance) + 1))), 1,
                    30);
}

#ifdef CLEAVE_HAS_DRACO
class DracoFrame : public OtherCodec {
 public:
  const char* name() const override { return "Draco a frame, order kept"; }
  std::string Encode(const std::vector<float>& positions, double tolerance) override {
    draco::PointCloudBuilder builder;
    builder.Start(static_cast<draco::PointIndex::ValueType>(positions.size() / 3));
    const int attribute =
        builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    builder.SetAttributeValuesForAllPoints(attribute, positions.data(), 0);
    const std::unique_ptr<draco::PointCloud> cloud = builder.Finalize(false);
    draco::ExpertEncoder encoder(*cloud);
    encoder.SetEncodingMethod(draco::POINT_CLOUD_SEQUENTIAL_ENCODING);
    encoder.SetAttributeQuantization(attribute, BitsFor(positions, tolerance));
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeToBuffer(&buffer).ok()) return {};
    return std::string(buffer.data(), buffer.size());
  }
  void Decode(const std::string& coded) override {
    draco::DecoderBuffer buffer;
    buffer.Init(coded.data(), coded.size());
    draco::Decoder().DecodePointCloudFromBuffer(&buffer).ok();
  }
};
#endif

#ifdef CLEAVE_HAS_MESHOPTIMIZER
class MeshoptZstd : public OtherCodec {
 public:
  const char* name() const override { return "meshoptimizer and zstd-3 a frame"; }
  std::string Encode(const std::vector<float>& positions, double tolerance) override {
    nodes_ = positions.size() / 3;
    std::vector<int32_t> q(positions.size());
    for (size_t at = 0; at < q.size(); ++at) {
      q[at] = static_cast<int32_t>(std::floor(positions[at] / (2 * tolerance) + 0.5));
    }
    std::vector<unsigned char> coded(meshopt_encodeVertexBufferBound(nodes_, 12));
    coded.resize(meshopt_encodeVertexBuffer(coded.data(), coded.size(), q.data(), nodes_, 12));
    return Compress(coded.data(), coded.size());
  }
  void Decode(const std::string& coded) override {
    const std::string raw = Decompress(coded);
    std::vector<int32_t> q(3 * nodes_);
    meshopt_decodeVertexBuffer(q.data(), nodes_, 12,
                               reinterpret_cast<const unsigned char*>(raw.data()), raw.size());
  }

 private:
  size_t nodes_ = 0;
};
#endif

}  // namespace

std::vector<std::unique_ptr<OtherCodec>> MakeOtherCodecs() {
  std::vector<std::unique_ptr<OtherCodec>> codecs;
  codecs.push_back(std::make_unique<RawZstd>());
  codecs.push_back(std::make_unique<DeltaZstd>());
#ifdef CLEAVE_HAS_DRACO
  codecs.push_back(std::make_unique<DracoFrame>());
#endif
#ifdef CLEAVE_HAS_MESHOPTIMIZER
  codecs.push_back(std::make_unique<MeshoptZstd>());
#endif
  return codecs;
}

std::vector<std::string> MissingCodecs() {
  std::vector<std::string> missing;
#ifndef CLEAVE_HAS_DRACO
  missing.emplace_back("Draco");
#endif
#ifndef CLEAVE_HAS_MESHOPTIMIZER
  missing.emplace_back("meshoptimizer");
#endif
  return missing;
}

}  // namespace cleave
