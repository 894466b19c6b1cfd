// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures of pieces of a volume, blended in order of depth, against the picture of the whole.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/PathScene.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace test::pieces {

const glm::i64vec3 Dims(33, 33, 33);

/// Smooth, and nowhere so opaque that what is behind is left out.
float Waves(const glm::vec3& u)
{
  return 0.5f + 0.25f * std::sin(9.0f * u.x) * std::cos(7.0f * u.y) + 0.2f * std::sin(11.0f * u.z);
}

/// Most of it faint, so that samples are joined; nothing below 0.3 is visible.
inr::TransferFunction Medium()
{
  inr::TransferFunction medium;
  medium.table = {{1, 0.2f, 0, 0},       {1, 0.2f, 0, 0},   {1, 0.2f, 0, 0},      {1, 0.2f, 0, 0},
                  {0.3f, 1, 0, 0.0005f}, {0, 1, 0, 0.004f}, {0.1f, 0.5f, 1, 0.1f}};
  return medium;
}

inr::MacroCells Cells()
{
  inr::MacroCells cells = inr::MakeMacroCells(Dims, 4);
  const glm::i64vec3 fine = cells.dims * std::int64_t{8};
  for (std::int64_t k = 0; k < fine.x * fine.y * fine.z; ++k) {
    const glm::i64vec3 at(k % fine.x, k / fine.x % fine.y, k / fine.x / fine.y);
    const glm::i64vec3 cell = at / std::int64_t{8};
    const glm::dvec3 u =
        (glm::dvec3(cell) + glm::dvec3(at % std::int64_t{8}) / 7.0) * cells.spacing;
    const float value = Waves(glm::vec3(u));
    inr::ValueRange& range = cells.ranges[static_cast<std::size_t>(
        cell.x + cells.dims.x * (cell.y + cells.dims.y * cell.z))];
    range.extend(value - 0.1f);
    range.extend(value + 0.1f);
  }
  return cells;
}

inr::Renderer MakeRenderer(bool cached)
{
  inr::Renderer renderer = FieldRenderer(Dims, Waves, Cells(), 2, cached);
  renderer.setTransferFunction(Medium());
  return renderer;
}

/// Along a slanted direction, +z most of all.
inr::Frame Slanted(double levelOfDetailScale)
{
  inr::Frame frame = ParallelFrame(40, {-4, -4}, {36, 36}, -30, 80);
  frame.clipToWorld = glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(0, 1, 0.2)) * frame.clipToWorld;
  frame.levelOfDetailScale = levelOfDetailScale;
  frame.lights = {inr::Light{}};
  return frame;
}

/// Slices of the volume from the viewer on, none of them at a voxel.
std::vector<std::vector<glm::dvec4>> Slices()
{
  const glm::dvec4 first(0.2, -0.1, 1, -9.123);
  const glm::dvec4 second(0, 0, 1, -20.771);
  return {{-first, -second}, {first, -second}, {second}};
}

/// Premultiplied pictures, the nearest first.
inr::Image Blend(const std::vector<inr::Image>& pictures)
{
  inr::Image result = pictures.front();
  for (std::size_t picture = 1; picture < pictures.size(); ++picture) {
    for (std::size_t k = 0; k < result.pixels.size(); k += 4) {
      const float transmittance = 1.0f - result.pixels[k + 3];
      for (std::size_t channel = 0; channel < 4; ++channel) {
        result.pixels[k + channel] += transmittance * pictures[picture].pixels[k + channel];
      }
    }
  }
  return result;
}

struct PiecesOf
{
  PiecesOf(inr::Renderer& renderer, inr::Frame frame)
  {
    for (const auto& slice : Slices()) {
      frame.piece = slice;
      this->pictures.emplace_back();
      const inr::FrameStatistics piece = renderer.render(frame, this->pictures.back());
      this->samples.push_back(piece.samples);
    }
  }
  std::vector<inr::Image> pictures;
  std::vector<std::int64_t> samples;
};

void ExpectPiecesOfWhole(bool cached, const inr::Frame& frame)
{
  inr::Renderer renderer = MakeRenderer(cached);
  inr::Image whole;
  const std::int64_t samples = renderer.render(frame, whole).samples;
  const PiecesOf pieces(renderer, frame);
  const inr::Image blended = Blend(pieces.pictures);
  for (std::size_t k = 0; k < whole.pixels.size(); ++k) {
    ASSERT_NEAR(blended.pixels[k], whole.pixels[k], 1e-5f) << k;
  }
  // Gradients, and what the network says of the beginnings of pieces, are counted, too.
  if (!frame.shading && (cached || !frame.preIntegration)) {
    EXPECT_EQ(pieces.samples[0] + pieces.samples[1] + pieces.samples[2], samples);
  }
  for (const std::int64_t count : pieces.samples) {
    EXPECT_GT(count, samples / 10);
  }
}

TEST(Pieces, MakeTheWholeFromTheNetwork) { ExpectPiecesOfWhole(false, Slanted(0)); }

TEST(Pieces, MakeTheWholeFromTheCache)
{
  for (const double scale : {0.0, 1.0, 2.7}) {
    ExpectPiecesOfWhole(true, Slanted(scale));
  }
}

TEST(Pieces, MakeTheWholeOfEverySampleDistance)
{
  for (const double distance : {0.07, 0.9, 3.0}) {
    for (const bool adaptive : {false, true}) {
      inr::Frame frame = Slanted(1);
      frame.sampleDistance = distance;
      frame.adaptiveSampling = adaptive;
      ExpectPiecesOfWhole(true, frame);
    }
  }
}

TEST(Pieces, MakeTheWholeWhenPreIntegrated)
{
  for (const double distance : {0.3, 2.0}) {
    inr::Frame frame = Slanted(1);
    frame.sampleDistance = distance;
    frame.preIntegration = true;
    ExpectPiecesOfWhole(true, frame);
    ExpectPiecesOfWhole(false, frame);
  }
}

TEST(Pieces, MakeTheWholeWhenShaded)
{
  inr::Frame frame = Slanted(1);
  frame.shading = inr::Material{};
  ExpectPiecesOfWhole(true, frame);
  ExpectPiecesOfWhole(false, frame);
}

/// Cuts through surfaces, so that many a crossing is in an interval of samples that two pieces
/// share.
void ExpectSurfacesOfWhole(bool cached, const inr::Frame& frame)
{
  inr::Renderer renderer = MakeRenderer(cached);
  inr::TransferFunction glass;
  glass.table = {{1, 0.2f, 0, 0.3f}, {0.3f, 1, 0, 0.2f}, {0.1f, 0.5f, 1, 0.4f}};
  renderer.setTransferFunction(glass);
  const inr::Image whole = Render(renderer, frame);
  const PiecesOf pieces(renderer, frame);
  const inr::Image blended = Blend(pieces.pictures);
  for (std::size_t k = 0; k < whole.pixels.size(); ++k) {
    ASSERT_NEAR(blended.pixels[k], whole.pixels[k], 1e-5f) << k;
  }
  for (const inr::Image& piece : pieces.pictures) {
    EXPECT_GT(std::count_if(piece.pixels.begin(), piece.pixels.end(),
                            [](float value) { return value > 0.01f; }),
              1000);
  }
}

TEST(Pieces, MakeTheWholeOfSurfaces)
{
  inr::Frame frame = Slanted(0);
  frame.blending.mode = inr::BlendMode::Isosurface;
  frame.blending.isosurfaces = {0.45, 0.52, 0.58, 0.65, 0.72};
  for (const double distance : {0.25, 1.0, 4.0}) {
    frame.sampleDistance = distance;
    ExpectSurfacesOfWhole(true, frame);
    ExpectSurfacesOfWhole(false, frame);
  }
  frame.levelOfDetailScale = 2.7;
  ExpectSurfacesOfWhole(true, frame);
  frame.shading = inr::Material{};
  ExpectSurfacesOfWhole(true, frame);
}

TEST(Pieces, ARayBesideThePieceIsAMiss)
{
  inr::Frame frame = Slanted(0);
  frame.piece = {{0, 0, 1, -100}};
  inr::Renderer renderer = MakeRenderer(true);
  inr::Image image;
  EXPECT_EQ(renderer.render(frame, image).rays, 0);
}

/// Mean of a channel over the picture, from pictures that have nothing to do with each other.
Estimate MeanOf(const std::vector<inr::Image>& pictures, std::size_t channel)
{
  double sum = 0;
  double squares = 0;
  for (const inr::Image& picture : pictures) {
    double total = 0;
    for (std::size_t k = channel; k < picture.pixels.size(); k += 4) {
      total += picture.pixels[k];
    }
    sum += total;
    squares += total * total;
  }
  const auto count = static_cast<double>(pictures.size());
  const double mean = sum / count;
  return {mean, std::sqrt((squares / count - mean * mean) / (count - 1))};
}

TEST(Pieces, ArePassedThroughByLight)
{
  inr::Renderer renderer = MakeRenderer(false);
  inr::Frame frame = Slanted(0);
  frame.mode = inr::RenderMode::PathTracing;
  frame.unitDistance = 0.2; // several scatterings, from piece to piece
  frame.samplesPerPixel = 1;
  frame.paths.ambientLight = {0.2f, 0.3f, 0.4f};
  std::vector<inr::Image> wholes;
  std::vector<inr::Image> blended;
  for (std::uint64_t k = 0; k < 150; ++k) {
    frame.frameIndex = k;
    wholes.push_back(Render(renderer, frame));
    frame.frameIndex = 1000 + k;
    blended.push_back(Blend(PiecesOf(renderer, frame).pictures));
  }
  for (std::size_t channel = 0; channel < 4; ++channel) {
    const Estimate whole = MeanOf(wholes, channel);
    const Estimate sum = MeanOf(blended, channel);
    const double error = std::hypot(whole.error, sum.error);
    EXPECT_LT(std::abs(whole.mean - sum.mean), Unlikely * error) << channel;
    EXPECT_LT(error, 0.03 * whole.mean) << "nothing is known";
  }
}

} // namespace test::pieces
