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

/// `view`: "whole", "near" or "far".
inline std::vector<Scene> Scenes(const inr::VolumeInfo& volume, const std::string& name,
                                 const std::string& view)
{
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
  inr::RendererOptions options = Cached();
  options.cache.precision = inr::CachePrecision::Float32;
  return options;
}

inline inr::RendererOptions Uncached()
{
  inr::RendererOptions options = Cached();
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
