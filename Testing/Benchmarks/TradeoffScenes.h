// SPDX-License-Identifier: BSD-3-Clause
//
// The scenes of bench_tradeoff, and the pictures that it compares with; see there.
#pragma once

#include "Testing/Benchmarks/FrameScenes.h"
#include "Testing/Benchmarks/TradeoffKnobs.h"
#include "Testing/Benchmarks/VoxelField.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

constexpr int PictureSize = 256;
constexpr double ReferenceStep = 0.125;

/// From closer by, so that a voxel is several pixels.
inline inr::Frame NearView(const inr::VolumeInfo& volume)
{
  const glm::dvec3 extent(volume.dims);
  inr::Frame frame = View(volume);
  const glm::dvec3 eye = 0.5 * extent + glm::dvec3(0.35, 0.25, 0.75) * extent.x;
  frame.clipToWorld =
      glm::inverse(glm::perspective(glm::radians(35.0), 1.0, 0.02 * extent.x, 5 * extent.x) *
                   glm::lookAt(eye, 0.5 * extent, glm::dvec3(0, 1, 0)));
  return frame;
}

struct Scene
{
  std::string name;
  inr::TransferFunction function;
  inr::Frame frame; ///< by default settings
};

/// Linear between control points.
inline glm::vec4 ColorAt(float x, const std::vector<std::pair<float, glm::vec3>>& colors,
                         const std::vector<std::pair<float, float>>& opacities)
{
  const auto at = [x](const auto& points) {
    std::size_t next = 1;
    while (next + 1 < points.size() && points[next].first < x) {
      ++next;
    }
    const auto& [x0, value0] = points[next - 1];
    const auto& [x1, value1] = points[next];
    return value0 + (value1 - value0) * ((x - x0) / (x1 - x0));
  };
  return {at(colors), at(opacities)};
}

/// The view of the Richtmyer-Meshkov volume in the cINR paper's scene files, 4096 x 4096 x 3840
/// voxels there: the same camera about the middle of a volume that is smaller or another of that
/// instability, the same colours and opacities over all of its values. Opacities are of a voxel of
/// theirs.
inline Scene PaperScene(const inr::VolumeInfo& volume, const std::string& name)
{
  Scene scene{name, {}, {}};
  scene.function.low = volume.low;
  scene.function.high = volume.high;
  for (int k = 0; k < 1024; ++k) {
    scene.function.table.push_back(
        ColorAt(static_cast<float>(k) / 1023,
                {{0.0f, {0, 0, 1}}, {0.3f, {0, 1, 1}}, {0.6f, {1, 1, 0}}, {1.0f, {1, 0, 0}}},
                {{0.0f, 0.0f},
                 {0.0742f, 0.0f},
                 {0.2971f, 0.0858f},
                 {0.495f, 0.0299f},
                 {0.7525f, 0.1617f},
                 {0.9212f, 0.0f},
                 {1.0f, 0.0f}}));
  }
  const glm::dvec3 extent(volume.dims);
  const double scale = extent.x / 4096;
  const glm::dvec3 theirs(2048, 2048, 1920);
  const auto ours = [&](const glm::dvec3& place) {
    return 0.5 * (extent - 1.0) + scale * (place - theirs);
  };
  scene.frame.clipToWorld = glm::inverse(
      glm::perspective(glm::radians(60.0), 1.0, 0.05 * extent.x, 5 * extent.x) *
      glm::lookAt(ours({1751.41, 5195.08, -271.885}), ours({1935.66, 1963.64, 2628.78}),
                  glm::dvec3(-0.00590256, -0.668003, -0.743803)));
  scene.frame.unitDistance = scale;
  scene.frame.sampleDistance = 0.5;
  scene.frame.width = scene.frame.height = PictureSize;
  return scene;
}

/// `view`: "whole", "near", "far" or "paper".
inline std::vector<Scene> Scenes(const inr::VolumeInfo& volume, const std::string& name,
                                 const std::string& view)
{
  if (view == "paper") {
    return {PaperScene(volume, name)};
  }
  std::vector<Scene> scenes;
  for (const Look& look : Looks(volume)) {
    Scene scene{name + " " + look.name, look.function,
                view == "near" ? NearView(volume) : View(volume)};
    scene.frame.sampleDistance = 0.5;
    scene.frame.width = scene.frame.height = view == "far" ? PictureSize / 2 : PictureSize;
    scenes.push_back(scene);
  }
  return scenes;
}

/// One model, and the data it was made of.
struct Subject
{
  inr::ModelPointer model;
  inr::ModelPointer usual; ///< the model that its times are compared with
  std::shared_ptr<const inr::Evaluator> decoded;
  std::shared_ptr<const inr::Evaluator> original;
  inr::MacroCells decodedCells;
  inr::MacroCells originalCells;
};

inline Subject SubjectOf(const inr::ModelPointer& model, const inr::ModelPointer& usual,
                         const inr::VolumeData& voxels)
{
  const inr::Arena arena(Threads);
  const inr::VolumeInfo& info = model->volume;
  const int edge = inr::DefaultMacroCellSize(info.dims);
  const auto cells = [&](const inr::Evaluator& field) {
    return inr::MeasureQuality(field, voxels, info, edge, arena, {}).macroCells;
  };
  Subject subject;
  subject.model = model;
  subject.usual = usual;
  subject.original = std::make_shared<VoxelField>(info.dims, Normalised(voxels, info));
  subject.originalCells = cells(*subject.original);
  subject.decoded = std::make_shared<VoxelField>(info.dims, Decoded(model, arena));
  subject.decodedCells = cells(*subject.decoded);
  return subject;
}

struct References
{
  inr::Image a;
  inr::Image b;
  inr::Image c;
};

inline inr::Image Picture(inr::Renderer renderer, const Scene& scene, const inr::Frame& frame)
{
  renderer.setTransferFunction(scene.function);
  inr::Image picture;
  renderer.render(frame, picture);
  return picture;
}

inline inr::RendererOptions Exact()
{
  inr::RendererOptions options = Unrounded();
  options.cache.precision = inr::CachePrecision::Float32;
  return options;
}

inline inr::RendererOptions Uncached()
{
  inr::RendererOptions options = Unrounded();
  options.cached = false;
  return options;
}

inline inr::Renderer OfVoxels(const Subject& subject,
                              const std::shared_ptr<const inr::Evaluator>& field,
                              const inr::MacroCells& cells)
{
  return {field, subject.model->volume, cells, Uncached()};
}

/// What makes it exact.
inline inr::Frame Exact(inr::Frame frame, double step)
{
  frame.levelOfDetailScale = 0;
  frame.sampleDistance = step;
  frame.adaptiveSampling = false;
  return frame;
}

/// The references, and how far they are from each other.
inline References Refer(const Subject& subject, const Scene& scene, const inr::Frame& frame)
{
  const inr::Frame exact = Exact(frame, ReferenceStep);
  References all;
  all.a = Picture(inr::Renderer(subject.model, Exact()), scene, exact);
  all.b = Picture(inr::Renderer(subject.model, Uncached()), scene, exact);
  all.c = Picture(OfVoxels(subject, subject.original, subject.originalCells), scene, exact);
  Record(scene.name + ", references")
      .compare("a_b", all.b, all.a)
      .compare("b_c", all.c, all.b)
      .compare("a_c", all.c, all.a)
      .print();
  return all;
}

/// How exact reference a is: against the same voxels without a cache, and with half the step.
inline void CheckReference(const Subject& subject, const Scene& scene, const References& all)
{
  const inr::Image voxels = Picture(OfVoxels(subject, subject.decoded, subject.decodedCells), scene,
                                    Exact(scene.frame, ReferenceStep));
  const inr::Image finer =
      Picture(inr::Renderer(subject.model, Exact()), scene, Exact(scene.frame, ReferenceStep / 2));
  Record(scene.name + ", reference a")
      .compare("a_without_cache", voxels, all.a)
      .compare("a_half_step", finer, all.a)
      .print();
}
