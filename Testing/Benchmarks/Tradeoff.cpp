// SPDX-License-Identifier: BSD-3-Clause
//
// What each setting buys and costs: time of a frame and error of its picture, against
//
//   a: the model's own voxels, decoded as float32 and interpolated linearly, by the same marcher:
//      precision 32 bit, LevelOfDetailScale 0, constant step of an eighth of a voxel (the converged
//      reference A; that of bench_tolerance has a frame's own step);
//   b: the network itself at that step, without a cache;
//   c: the original voxels in place of the model's, likewise.
//
//   bench_tradeoff MODEL.inr NAME VOXELS.raw TYPE NX NY NZ MODE VIEW [USUAL.inr]
//
// prints one JSON object per line; tradeoff.py writes the result file. MODE: "volume", what the
// model made of the data; "knobs", one setting at a time that changes the picture; "tolerance",
// what takes the place of one of them; "inference", what the network computes with (where this
// processor can, see kernels.json); "grid", three at once; "loading", what changes how the
// cache fills (or several of these, with a "+" in between); "paths", path tracing; "model", this
// model beside the USUAL one; "memory", which part takes how much. VIEW: the volume as a "whole",
// from "near", where a voxel is several pixels, or as from "far": the whole in a quarter of the
// pixels; or, with other colours, as the paper shows its Richtmyer-Meshkov volume ("paper").
#include "Core/Model/ModelFile.h"
#include "Testing/Benchmarks/RawVolume.h"
#include "Testing/Benchmarks/TradeoffBench.h"
#include "Testing/Benchmarks/TradeoffMemory.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

namespace {

constexpr int PathPictureSize = 64;
constexpr int ReferencePaths = 512;

/// What the model made of the data, voxel by voxel.
void CompareVolumes(const inr::ModelPointer& pointer, const inr::VolumeData& voxels,
                    const std::string& name)
{
  const inr::Model& model = *pointer;
  const inr::Arena arena(Threads);
  const inr::Quality quality =
      inr::MeasureQuality(*inr::MakeEvaluator(pointer), voxels, model.volume,
                          inr::DefaultMacroCellSize(model.volume.dims), arena, {})
          .quality;
  const std::vector<float> original = Normalised(voxels, model.volume);
  std::vector<float> errors = Decoded(pointer, arena);
  for (std::size_t k = 0; k < errors.size(); ++k) {
    errors[k] = std::abs(errors[k] - original[k]);
  }
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  Record record(name + ", volume");
  record.add("parameters", static_cast<double>(model.parameters.size()));
  record.add("psnr", quality.psnr).add("ssim", quality.ssim);
  record.add("max", quality.maxError / (model.volume.high - model.volume.low));
  for (const double limit : {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5}) {
    const auto end = std::upper_bound(errors.begin(), errors.end(), static_cast<float>(limit));
    record.add("within_" + Text(limit), static_cast<double>(end - errors.begin()) / count);
  }
  record.print();
}

/// The model's voxels from rounded numbers, against those in float32.
void CompareInference(const inr::ModelPointer& model, const std::string& name,
                      const Numbers& numbers)
{
  const inr::Arena arena(Threads);
  const std::vector<float> exact = Decoded(model, arena);
  const std::vector<float> rounded = Decoded(model, arena, numbers.precision);
  double squares = 0;
  double largest = 0;
  for (std::size_t k = 0; k < exact.size(); ++k) {
    const double error = std::abs(static_cast<double>(rounded[k]) - static_cast<double>(exact[k]));
    squares += error * error;
    largest = std::max(largest, error);
  }
  const double mean = squares / static_cast<double>(exact.size());
  Record record(name + ", voxels in " + numbers.name);
  record.add("psnr_float", std::min(EqualPictures, -10 * std::log10(mean)));
  record.add("max", largest);
  record.print();
}

/// `parts`: some of "knobs", "tolerance", "inference", "loading" and "grid".
void TurnKnobs(const Subject& subject, const Scene& scene, const std::string& parts)
{
  const auto wanted = [&](const char* part) { return parts.find(part) != std::string::npos; };
  Bench bench(subject, scene, Refer(subject, scene, scene.frame));
  if (wanted("knobs")) {
    CheckReference(subject, scene, bench.references());
    bench.measure(PictureKnobs(scene.frame), "knobs");
  }
  if (wanted("tolerance")) {
    bench.measure(ToleranceKnob(scene.frame), "tolerance");
  }
  if (wanted("inference")) {
    bench.measure(InferenceKnob(scene.frame), "inference");
  }
  if (wanted("loading")) {
    bench.measure(LoadingKnobs(scene.frame, bench.wanted()), "loading");
  }
  if (wanted("grid")) {
    bench.measure(Grid(scene.frame), "grid");
  }
}

/// Pictures of this model beside those of the usual one.
void CompareModels(const Subject& subject, const Scene& scene)
{
  Bench bench(subject, scene, Refer(subject, scene, scene.frame));
  const std::string parameters = std::to_string(subject.model->parameters.size());
  bench.measure({{"parameters", parameters, Cached(), scene.frame, true},
                 {"parameters, network only", parameters, Uncached(), scene.frame, false}},
                "model");
}

void TracePaths(const Subject& subject, Scene scene)
{
  scene.name += ", paths";
  scene.frame = Lit(scene.frame);
  scene.frame.width = scene.frame.height = PathPictureSize;
  scene.frame.samplesPerPixel = 64;
  inr::Frame exact = scene.frame;
  exact.seed = 1; // other paths than those of the pictures
  exact.samplesPerPixel = ReferencePaths;
  Bench bench(subject, scene, Refer(subject, scene, exact));
  SingleKnobs knobs(scene.frame);
  for (const int paths : {1, 4, 16, 64}) {
    knobs.add("SamplesPerPixel", Text(paths), false,
              [&](Point& point) { point.frame.samplesPerPixel = paths; });
  }
  for (const double scale : {0.0, 2.0, 4.0}) {
    knobs.add("LevelOfDetailScale", Text(scale), false,
              [&](Point& point) { point.frame.levelOfDetailScale = scale; });
  }
  knobs.add("CacheMode", "network only", false, [](Point& point) { point.options.cached = false; });
  bench.measure(knobs.points, "paths");
}

void Run(char* const* arguments, const std::string& mode, const std::string& view,
         const char* usualModel)
{
  const RawVolume volume(arguments + 3);
  const inr::ModelPointer model = inr::ReadModel(arguments[1]);
  if (mode == "volume") {
    CompareVolumes(model, volume.data(), arguments[2]);
    return;
  }
  const std::string name = std::string(arguments[2]) + (view == "whole" ? "" : " " + view);
  if (mode == "memory") {
    for (const Scene& scene : Scenes(model->volume, name, view)) {
      MeasureMemory(arguments[1], scene);
    }
    return;
  }
  const inr::ModelPointer usual = usualModel != nullptr ? inr::ReadModel(usualModel) : model;
  const Subject subject = SubjectOf(model, usual, volume.data());
  if (mode == "inference") {
    for (const Numbers& numbers : RoundedNumbers()) {
      CompareInference(model, name, numbers);
    }
  }
  for (const Scene& scene : Scenes(subject.model->volume, name, view)) {
    if (mode == "model") {
      CompareModels(subject, scene);
    } else if (mode == "paths") {
      TracePaths(subject, scene);
    } else {
      TurnKnobs(subject, scene, mode);
    }
  }
}

} // namespace

int main(int argc, char* argv[])
{
  const std::string mode = argc >= 9 ? argv[8] : "";
  const std::string view = argc >= 10 ? argv[9] : "";
  if (view != "whole" && view != "near" && view != "far" && view != "paper") {
    std::cerr << "usage: bench_tradeoff MODEL.inr NAME VOXELS.raw TYPE NX NY NZ "
                 "volume|memory|knobs|tolerance|grid|loading|paths|model whole|near|far|paper "
                 "[USUAL.inr]\n";
    return 2;
  }
  try {
    Run(argv, mode, view, argc > 10 ? argv[10] : nullptr);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
