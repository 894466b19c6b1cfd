// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Blending.h"
#include "Core/Render/Scene/Cropping.h"
#include "Core/Render/Scene/Lights.h"
#include "Core/Render/Scene/Material.h"
#include "Core/Render/Scene/PathOptions.h"
#include "Core/Render/Scene/TranslucentLayers.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace inr {

enum class RenderMode : std::uint8_t {
  RayMarching, ///< the medium emits and absorbs
  PathTracing  ///< it scatters light
};

/// One picture to make: a plain value that holds everything a host's camera and scene say.
/// Matrices act on column vectors. Pixel (0, 0) is the bottom left one.
struct Frame
{
  int width = 0;
  int height = 0;

  /// Normalised device coordinates (x, y, z in [-1, 1], z = -1 near) to world space, homogeneous.
  glm::dmat4 clipToWorld{1.0};
  /// World space to continuous point indices of the volume's native grid: point i of the grid is at
  /// i. Composes the actor's transform, direction, origin and spacing.
  glm::dmat4 worldToIndex{1.0};

  /// Directions in world space to where lengths of the medium are measured: unitDistance, and what
  /// samples are apart. A host that scales a volume does not make it thinner or denser by that.
  glm::dmat3 worldToMedium{1.0};

  /// Window-space depth in [0, 1] of what is already drawn, width * height values, 1 = nothing.
  /// Null when nothing opaque was drawn. Must outlive the call.
  const float* opaqueDepth = nullptr;
  /// Translucent surfaces that the picture is to be laid over, see there; null when there are none.
  /// Light that paths lead inside the volume does not meet them. Not for projections.
  std::shared_ptr<const TranslucentLayers> layers;
  /// World-space half spaces; a point p is kept where dot(plane, (p, 1)) >= 0 for all of them.
  std::vector<glm::dvec4> clippingPlanes;
  /// What of the volume is shown; paths know only boxes, see CroppedBox::full.
  std::optional<Cropping> cropping;
  /// Such half spaces that bound the piece of the medium that this picture shows, others the rest.
  /// Pictures of neighbouring pieces, blended in order of depth, make the one of the whole: where a
  /// ray's samples are does not depend on the piece, and light comes from everywhere.
  /// Not for projections.
  std::vector<glm::dvec4> piece;

  /// How the field's gradients are lit by `lights` where ray marching composites; none: colours are
  /// as the transfer function has them.
  std::optional<Material> shading;
  /// The scene's, for what is lit: none of them shines on a medium that only emits and absorbs.
  std::vector<Light> lights;

  RenderMode mode = RenderMode::RayMarching;
  Blending blending; ///< for ray marching; paths know compositing only
  PathOptions paths; ///< for path tracing
  /// Which of the host's views it is for: a picture that a time limit leaves unfinished goes on
  /// when the same is asked for again for that view, though others were drawn for a few others in
  /// between (see PerView) that differ from it in camera and size. An accelerator may begin anew
  /// behind these. Any number; the picture does not depend on it.
  int view = 0;
  /// Of path tracing: the picture is the mean of so many paths through each pixel, above 0; with a
  /// time limit, of those that were traced in time.
  int samplesPerPixel = 64;

  /// Length of the medium to which the transfer function's opacity refers; above 0.
  double unitDistance = 1;
  /// Distance between samples in voxels, along the axis in which the voxels are densest; 1/1000 to
  /// 1,000,000.
  double sampleDistance = 0.5;

  /// Samples where little can be seen stand for up to four times the sample distance.
  bool adaptiveSampling = true;

  /// Where ray marching composites, what a sample stands for has the colours of all values between
  /// that of the sample before and its own, as if the field were linear there (see
  /// PreIntegratedLookup): no peak in the transfer function is too thin, and rays need no random
  /// offsets. Macro-cells narrower than the distance may be skipped if both ends are invisible.
  /// Light falls as on the gradient at the sample. Off: a sample's own colour. Ignored where there
  /// is an error tolerance and a cache.
  bool preIntegration = false;

  /// Multiplies the pixel's footprint that chooses the cache level: 1 makes a voxel at most a
  /// seventh larger than a pixel, as its ray sees it (see ProjectedVoxel), 0 reads the full
  /// resolution everywhere; not negative.
  double levelOfDetailScale = 1;

  /// Takes the place of levelOfDetailScale, adaptiveSampling and preIntegration where it is given:
  /// by how many 255ths a channel of the picture may differ from the one with all samples, each
  /// from the full resolution, for 99.9 % of the pixels that show something. 0: not at all; finite,
  /// not negative. Where nothing is lit, cropped (but to a box) or projected, and samples are a
  /// voxel apart or less, they come from coarser levels and are further apart wherever that stays
  /// within it; see LevelChooser. Everything else, paths, and volumes whose values may leave the
  /// ranges of their macro-cells (MacroCells::rangesHold) are drawn as with 0. What the precision
  /// of the cache rounds comes on top (see PrecisionWithin), and up to 0.26 in opaque media, as
  /// rays end at 0.999 of opacity; and between voxels of the full resolution the field is taken to
  /// be linear. Of pieces, all together keep to it. Ignored without a cache.
  std::optional<double> errorTolerance;

  /// Seconds after which a picture is handed over as it is, with coarser levels where finer ones
  /// are not there yet; what is missing is loaded in the time that is left. One ray or path through
  /// each pixel may take longer: through the CPU's cache, what has none through some pixels after
  /// twice the limit, and a quarter of a second at least, lets everything through there (see
  /// FrameStatistics::blank). 0: as long as it takes to be complete. Without a cache rays take no
  /// notice of it, and paths end between two rounds.
  double timeLimit = 0;
  /// Pictures, this one included, that the host makes in these seconds, as of volumes in a view:
  /// each has an equal part of them, and of the quarter of a second.
  int sharedBy = 1;

  /// Offsets of the samples along their rays, but for preIntegration, extremes and isosurfaces, and
  /// paths are random in (seed, frameIndex, pixel).
  std::uint64_t seed = 0;
  std::uint64_t frameIndex = 0;
};

/// Whether two frames make the same picture: all but the time and the samples per pixel that they
/// may take, and opaque depth and layers by their values.
bool IsSamePicture(const Frame& a, const Frame& b);

/// The values of a frame's opaque depth; empty when it has none.
std::vector<float> CopyOfDepth(const Frame& frame);

} // namespace inr
