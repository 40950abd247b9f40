#ifndef CLEAVE_TESTS_BENCH_STREAM_OTHER_CODECS_H_
#define CLEAVE_TESTS_BENCH_STREAM_OTHER_CODECS_H_

#include <memory>
#include <string>
#include <vector>

namespace cleave {

// Another way to store frames, to compare with. Frames are given in order.
class OtherCodec {
 public:
  virtual ~OtherCodec() = default;
  virtual const char* name() const = 0;
  // Positions are x, y, z of each node, m; lossy codecs keep to the tolerance (m).
  virtual std::string Encode(const std::vector<float>& positions, double tolerance) = 0;
  virtual void Decode(const std::string& coded) = 0;
};

// zstd on raw floats, delta and zstd, and what of Draco and meshoptimizer is installed.
std::vector<std::unique_ptr<OtherCodec>> MakeOtherCodecs();
// Which of the two this was built without.
std::vector<std::string> MissingCodecs();

}  // namespace cleave

#endif  // CLEAVE_TESTS_BENCH_STREAM_OTHER_CODECS_H_
