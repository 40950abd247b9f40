#ifndef CLEAVE_CORE_SCENE_IMPURITIES_H_
#define CLEAVE_CORE_SCENE_IMPURITIES_H_

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/vec3.h"
#include "core/scene/polyline.h"

// Impurities of a scene and the layers that artists make them of; as scene.h, which includes this.

namespace cleave {

// What impurities do to strength.
enum class ImpurityEffect {
  kDegradation,  // down to a tenth
  kUpgradation,  // up to ten times
};

// How edges take strength from the potencies of their nodes.
enum class ImpurityModel {
  kGraph,         // bonds that a node loses weaken those that it has left
  kStatic,        // lost bonds do not count
  kUncorrelated,  // the strengths of kStatic, dealt out to the edges at random
  kOff,           // none: the pure body, for comparison
};

enum class ImpurityMode {
  kExpected,  // every edge has the expected strength
  kSampled,   // every edge has full or extreme strength, by its probability
};

enum class NoiseDistribution { kGaussian, kUniform };

// A share of the potency for the nodes of a set.
struct PotencyPatch {
  std::string node_set;
  double share = 1;  // of the potency, [0, 1]
};

// A share for every node of the mesh.
struct NodeValues {
  std::vector<double> shares;  // [0, 1]
  // In place of shares, a VTU or PLY file beside the scene file and its point array; clients read
  // it and send the shares.
  std::string file = {};
  std::string array = {};
};

// A random number of mean 0 and variance 1 at every place, which potency multiplies.
struct NoiseField {
  NoiseDistribution distribution = NoiseDistribution::kGaussian;
  // m; values at a distance r correlate by exp(-r^2 / (2 length^2)). 0: every node on its own.
  double correlation_length = 0;
};

enum class BandShape {
  kPlanes,     // across the axis
  kCylinders,  // round the axis
  kSpheres,    // round the centre
};

// Parallel bands of share 1.
struct BandField {
  BandShape shape = BandShape::kPlanes;
  Vec3 center{0, 0, 0};  // m
  Vec3 axis{0, 0, 1};    // any length but 0; of planes and cylinders
  double position = 0;   // m from the centre to the middle of the band
  double width = 0;      // m
  std::optional<double> spacing =
      std::nullopt;  // m from middle to middle of further bands; absent: one band
};

// Balls of share 1 at random places within the body.
struct PocketField {
  int32_t count = 0;
  double radius = 0;  // m
};

// A cutter led along curves and pushed into the body, as a laser is.
struct Strokes {
  std::vector<Polyline> curves;  // a stroke each; where they lie along `direction` does not matter
  Vec3 direction{0, 0, -1};      // the way it cuts, any length but 0
  std::optional<double> depth;   // m below the first surface that it meets; absent: right through
  double radius = 0;             // m, half the width of the groove; 0: a knife
};

// A curve of a flat drawing.
struct DrawnCurve {
  std::vector<std::array<double, 2>> points;  // in units of the drawing, x to the right, y up
  std::vector<double> half_widths;            // a point each, or empty: lines without width
};

// A picture that clients turn into curves; its width is one unit, its middle the origin.
struct ImageDrawing {
  std::string file;         // PNG or JPEG, beside the scene file
  double threshold = 0.5;   // pixels darker than this are drawn, (0, 1)
  bool bright = false;      // pixels brighter than it are drawn instead
  bool keep_width = false;  // curves are as wide as the lines of the picture
  double tolerance = 0.5;   // pixels that curves may stray from the middle of lines
};

// A drawing, placed in space and pushed through the body along an axis.
struct SegmentPattern {
  std::vector<DrawnCurve> curves;
  std::optional<ImageDrawing> image;  // in place of curves
  Vec3 origin{0, 0, 0};               // m, where the drawing's origin goes
  Vec3 direction{0, 0, -1};           // the way one looks at the drawing and it cuts
  Vec3 up{0, 1, 0};                   // the drawing's y, but for what lies along `direction`
  double rotation = 0;                // rad, counterclockwise as one looks at it
  double scale = 1;                   // m a unit of the drawing
  std::optional<double> depth;        // m, as of strokes
};

// What a texture shows beyond its border.
enum class TextureWrap {
  kRepeat,
  kClamp,   // the texel at the border
  kMirror,  // itself, every other time reflected
};

// Which part of a picture is the share.
enum class TextureChannel { kLuminance, kRed, kGreen, kBlue, kAlpha };

// A picture on a surface by texture coordinates, linear between the middles of texels.
struct SurfaceTexture {
  int32_t width = 0;            // texels
  int32_t height = 0;           // texels
  std::vector<uint8_t> values;  // a texel each, rows from the top; 255 is share 1
  // u, v of the three corners, a triangle each; (0, 0) is the picture's lower left corner, (1, 1)
  // its upper right.
  std::vector<std::array<float, 6>> uvs;
  TextureWrap wrap = TextureWrap::kRepeat;
  bool invert = false;  // shares are 1 less the values
  // In place of size and values, a PNG or JPEG beside the scene file, and what of it counts;
  // clients read it.
  std::string file = {};
  TextureChannel channel = TextureChannel::kLuminance;
};

// Values on a surface, carried inward like a volumetric texture: within `depth` every node has the
// value of the closest point of the surface.
struct SurfacePaint {
  // [0, 1], a vertex of the surface each; without vertices, a node of the mesh each, of which those
  // on its boundary count.
  std::vector<double> shares;
  std::vector<Vec3> vertices;                     // m; of a triangle surface
  std::vector<std::array<int32_t, 3>> triangles;  // of vertices, from 0
  double depth = 0;                               // m
  // In place of vertices and triangles, a surface beside the scene file, and the property of its
  // vertices that is the shares; clients read it.
  std::string file = {};
  std::string array = {};
  std::optional<SurfaceTexture> texture = std::nullopt;  // in place of shares
};

using ImpuritySource = std::variant<std::monostate, NodeValues, NoiseField, BandField, PocketField,
                                    Strokes, SegmentPattern, SurfacePaint>;

// How a layer joins what lies below it.
enum class Blend {
  kMax,      // the larger potency; of factors, the one farther from 1 in ratio
  kAdd,      // the sum of potencies; the product of factors
  kReplace,  // the layer in place of what is below, by its share
};

// How shares fall from 1 to 0.
enum class FalloffShape {
  kLinear,
  kSmooth,  // without kinks: 3 t^2 - 2 t^3
};

// One source of impurities. Sources give every node a share in [0, 1], or a random number; strokes
// and patterns mark the edges that they cross, whose ends have share 1.
struct ImpurityLayer {
  std::string name;
  ImpuritySource source;
  std::string node_set;  // nodes, and edges with both ends, that the layer is held to; empty: all
  std::optional<double> potency;  // alpha where the share is 1, [0, 100]; absent: potencies stay
  // w, [0, inf]: what the thresholds of edges count, 0 cuts. Of marked edges; where the source
  // marks none, 1 + (weakening - 1) times the smaller share of the ends. Absent: thresholds stay.
  std::optional<double> weakening;
  Blend blend = Blend::kMax;
  double falloff = 0;  // m beyond the source over which shares fall to 0
  FalloffShape falloff_shape = FalloffShape::kLinear;
  std::optional<uint32_t> seed;  // absent: of the scene, and another for every layer
};

// Impurities of the nodes: alpha = potency * map + noise * xi (method note, section 4), and layers
// over it.
struct Impurities {
  ImpurityEffect effect = ImpurityEffect::kDegradation;
  ImpurityModel model = ImpurityModel::kGraph;
  ImpurityMode mode = ImpurityMode::kExpected;
  double potency = 0;
  // The map, in [0, 1]: a share a node of the mesh; or patches, of which later ones win, and 0
  // elsewhere; or neither, 1 everywhere.
  std::vector<double> map = {};
  std::vector<PotencyPatch> patches = {};
  double noise = 0;  // standard deviation
  NoiseDistribution distribution = NoiseDistribution::kGaussian;
  double steepness = 5;      // k
  double pure_offset = 0.2;  // a0
  // omega; absent: 1 for degradation, 0.2 for upgradation
  std::optional<double> degree_weight = std::nullopt;
  std::vector<ImpurityLayer> layers = {};  // from below
};

// Whether any layer changes what thresholds of edges count.
inline bool WeakensEdges(const Impurities& impurities) {
  for (const ImpurityLayer& layer : impurities.layers) {
    if (layer.weakening.has_value()) return true;
  }
  return false;
}

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_IMPURITIES_H_
