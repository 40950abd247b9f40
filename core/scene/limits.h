#ifndef CLEAVE_CORE_SCENE_LIMITS_H_
#define CLEAVE_CORE_SCENE_LIMITS_H_

#include <cstdint>

#include "core/mesh/mesh_limits.h"  // IWYU pragma: export

// Every bound that validation holds inputs to, with its reason; those of meshes and lengths are in
// mesh_limits.h.

namespace cleave::limits {

// Bread crumb to diamond, with room for scenes in unusual units.
inline constexpr double kMaxYoungsModulus = 1e13;  // Pa
// Linear tets lock, and the energy loses its digits, as the material nears incompressibility.
inline constexpr double kMaxPoissonRatio = 0.4999;
inline constexpr double kLockingPoissonRatio = 0.45;  // a warning from here on
inline constexpr double kFloppyPoissonRatio = 0.1;  // a collapsed tet costs little energy below it
// More families cost more than they show: three span all stiffness directions.
inline constexpr int64_t kMaxFibreFamilies = 4;
inline constexpr double kHardFibreRatio = 1e6;      // of Young's modulus; a warning from here on
inline constexpr double kMaxStrengthRatio = 3;      // beyond it damage smears and follows no fibre
inline constexpr int64_t kMaxCurvePoints = 10'000;  // every tet looks at every segment
inline constexpr double kMaxPotency = 100;          // strength stops changing well below it
inline constexpr double kMaxPotencyNoise = 10;
inline constexpr double kMaxSteepness = 100;  // k: strengths span a factor of 2 k
inline constexpr double kMaxPureOffset = 10;  // a0: impure and pure hardly differ from here on
inline constexpr int64_t kMaxImpurityLayers = 100;   // each is a pass over nodes and edges
inline constexpr int64_t kMaxPockets = 10'000;       // nodes look at all that are near
inline constexpr int64_t kMaxBladePoints = 100'000;  // of a layer; edges look at all that are near
inline constexpr int64_t kMaxPaintTriangles = 2'000'000;  // sent inside the scene
inline constexpr int64_t kMaxTextureSide = 65'536;        // texels
inline constexpr int64_t kMaxTexels = int64_t{1} << 24;   // sent inside the scene
inline constexpr double kMaxTextureCoordinate = 1e4;      // floats have a texel's digits below it
inline constexpr double kMaxTracingTolerance = 100;       // pixels; coarser, a drawing is lost
inline constexpr double kMaxDrawingUnit = 1e6;            // coordinates of a drawing
// b of Basquin's law: beyond it life hardly depends on load, or jumps from 0 to infinity with it.
inline constexpr double kMinFatigueExponent = -1;
inline constexpr double kMaxFatigueExponent = -0.01;
inline constexpr double kMaxDegradationExponent = 1000;  // strength falls at the last cycle only
// Of strands: softer ones carry nothing worth solving for, as any tet of such a factor
// (fracture.h).
inline constexpr double kMinResidualFactor = 1e-3;
inline constexpr double kMaxResidualFactor = 0.999;  // at 1 tearing would take nothing
inline constexpr double kMaxStretchLimit = 100;      // no string of matter reaches it
inline constexpr double kMaxDensity = 1e6;           // kg/m^3; osmium has 22 590

inline constexpr double kMaxPressure =
    kMaxYoungsModulus;                        // Pa; more crushes any material to nothing
inline constexpr double kMaxForce = 1e15;     // N, the weight of a mountain
inline constexpr double kMaxIntensity = 1e9;  // of a load, times its value

inline constexpr int64_t kMaxColliders = 100;              // every node near the body looks at each
inline constexpr int64_t kMaxColliderTriangles = 200'000;  // sent inside the scene
inline constexpr double kMaxFriction = 10;                 // from here on nothing slides
inline constexpr double kMinContactStiffness = 0.01;       // softer, bodies pass through each other
inline constexpr double kMaxContactStiffness = 1000;       // harder, solves crawl
inline constexpr double kMaxColliderMass = 1e12;           // kg

// Of a render mesh: those who show it take about half a kilobyte a triangle, 4 GB of these.
inline constexpr int64_t kMaxRenderTriangles = 8'000'000;

inline constexpr double kMaxSleepSpeed = 1;  // m/s; what is faster is not at rest by any measure
inline constexpr double kMaxSleepSeconds = 3600;  // longer, leave sleep out

inline constexpr double kMaxStepSeconds = 10;      // beyond it backward Euler only damps
inline constexpr double kCoarseStepSeconds = 0.1;  // a warning from here on
inline constexpr double kMaxMassDamping = 1e6;  // 1/s; nothing moves on for more than a microsecond
inline constexpr double kMaxStiffnessDamping = 100;  // s; what takes minutes to give is a fluid
inline constexpr double kMinFramesPerSecond = 1e-3;
inline constexpr double kMaxFramesPerSecond = 1e9;
inline constexpr int64_t kMaxFrames = 10'000'000;
inline constexpr int32_t kMaxStepsPerFrame = 100'000;

inline constexpr int32_t kMaxNewtonIterations = 1000;
inline constexpr int32_t kMaxStepHalvings = 20;
inline constexpr int32_t kMaxPasses = 100'000;

inline constexpr int32_t kMaxIntervalFrames = 1'000'000;

// A probe answers within a second and a message: 0.75 MB of tangents, 1 MB of curves.
inline constexpr int64_t kMaxProbeGradients = 1'000;
inline constexpr int64_t kMaxPullDirections = 16;
inline constexpr int32_t kMaxProbeSamples = 1'000;
inline constexpr double kMaxProbeStretch = 1'000;  // St. Venant-Kirchhoff grows with its 4th power
inline constexpr double kMinProbeStrain = -0.95;   // bars pressed flat have no digits left
inline constexpr double kMaxProbeStrain = 100;

// Enough for any scene drawn by a person. Each selector costs a pass over the nodes.
inline constexpr int64_t kMaxListItems = 1'000;
inline constexpr int64_t kMaxKeyframes = 1'000'000;
inline constexpr int64_t kMaxNameBytes = 200;

inline constexpr double kMaxUnitScale = 1e9;

}  // namespace cleave::limits

#endif  // CLEAVE_CORE_SCENE_LIMITS_H_
