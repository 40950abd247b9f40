#include <cstddef>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "client/io/bake/bake_codec.h"
#include "core/base/bytes.h"
#include "core/base/status.h"

namespace cleave {
namespace {

// MDD is big-endian throughout.
template <typename T>
void PutBigEndian(T value, std::string& out) {
  uint32_t bits = 0;
  static_assert(sizeof(T) == sizeof(bits));
  std::memcpy(&bits, &value, sizeof(bits));
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(bits >> shift));
}

class Pc2 : public BakeCodec {
 public:
  Pc2(const BakeContext& context, bool velocities) : context_(context), velocities_(velocities) {}

  std::string Begin() const override {
    std::string out("POINTCACHE2\0", 12);
    ByteWriter writer(out);
    writer.Put<int32_t>(1);  // version
    writer.Put(static_cast<int32_t>(context_.surface.topology.points.size()));
    writer.Put(static_cast<float>(context_.timing.first_frame));
    writer.Put(static_cast<float>(context_.timing.stride()));
    writer.Put(static_cast<int32_t>(context_.timing.count));
    return out;
  }
  absl::Status Note(int64_t, const BakeFrame&) override { return absl::OkStatus(); }
  void Encode(int64_t, const BakeFrame& frame, std::string& out) const override {
    ByteWriter writer(out);
    for (const Vec3& vector : velocities_ ? frame.velocities : frame.points) {
      for (const double value : vector) writer.Put(static_cast<float>(value));
    }
  }

 private:
  const BakeContext& context_;
  const bool velocities_;
};

class Mdd : public BakeCodec {
 public:
  Mdd(const BakeContext& context, bool velocities)
      : context_(context),
        velocities_(velocities),
        times_(static_cast<size_t>(context.timing.count), 0.0f) {}

  std::string Begin() const override { return Head(); }
  absl::Status Note(int64_t, const BakeFrame& frame) override {
    const BakeTiming& timing = context_.timing;
    times_[static_cast<size_t>(frame.index)] =
        static_cast<float>(static_cast<double>(frame.frame - timing.first_frame) / timing.rate());
    return absl::OkStatus();
  }
  void Encode(int64_t, const BakeFrame& frame, std::string& out) const override {
    for (const Vec3& vector : velocities_ ? frame.velocities : frame.points) {
      for (const double value : vector) PutBigEndian(static_cast<float>(value), out);
    }
  }
  std::string Head() const override {
    std::string out;
    PutBigEndian(static_cast<int32_t>(context_.timing.count), out);
    PutBigEndian(static_cast<int32_t>(context_.surface.topology.points.size()), out);
    for (const float time : times_) PutBigEndian(time, out);
    return out;
  }

 private:
  const BakeContext& context_;
  const bool velocities_;
  std::vector<float> times_;  // s
};

}  // namespace

absl::StatusOr<std::unique_ptr<BakeCodec>> MakePointCache(const BakeContext& context,
                                                          PointCacheKind kind, bool velocities) {
  constexpr int64_t kMost = std::numeric_limits<int32_t>::max();
  const auto points = static_cast<int64_t>(context.surface.topology.points.size());
  if (points > kMost || context.timing.count > kMost) {
    return absl::InvalidArgumentError(absl::StrCat(points, " points and ", context.timing.count,
                                                   " frames: a point cache counts up to ", kMost));
  }
  std::unique_ptr<BakeCodec> codec;
  if (kind == PointCacheKind::kPc2) {
    codec = std::make_unique<Pc2>(context, velocities);
  } else {
    codec = std::make_unique<Mdd>(context, velocities);
  }
  return codec;
}

}  // namespace cleave
