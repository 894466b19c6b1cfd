// SPDX-License-Identifier: BSD-3-Clause
//
// A volume with empty and with busy parts for tests of blend modes.
#pragma once

#include "Testing/Core/Render/VoxelScene.h"

#include <memory>

/// Two lumps, a bright and a dark one, in a field that is otherwise the same; its voxels, what
/// VTK's conventions make of them, and renderers of both.
class BlendScene
{
public:
  static constexpr double Low = -20; ///< data value of a field's 0
  static constexpr double High = 180;
  static constexpr int CellEdge = 4;
  static constexpr std::int64_t SmallCache = 150000;

  struct Cache
  {
    std::int64_t bytes = 64 << 20;
    int threads = 1;
    int maximumRequests = 40;
    bool deterministic = false;
  };

  const glm::i64vec3 dims{45, 38, 41};

  /// At continuous point indices, normalised.
  double at(const glm::dvec3& index) const
  {
    return this->Values.at(glm::vec3((index + 0.5) / glm::dvec3(this->dims)));
  }

  /// Straight colour and opacity per unit distance of a normalised value.
  glm::dvec4 colorOf(double value) const
  {
    const double place = value * static_cast<double>(this->Table.table.size() - 1);
    const auto cell = std::min(static_cast<std::size_t>(place), this->Table.table.size() - 2);
    const double weight = place - static_cast<double>(cell);
    return glm::mix(glm::dvec4(this->Table.table[cell]), glm::dvec4(this->Table.table[cell + 1]),
                    weight);
  }

  inr::Renderer renderer(bool cached, bool ranges) const
  {
    inr::RendererOptions options;
    options.threads = 2;
    options.cached = cached;
    options.cache = Options(inr::CachePrecision::Float32, 9);
    return this->make(options, ranges);
  }
  inr::Renderer renderer(const Cache& cache) const
  {
    inr::RendererOptions options;
    options.threads = cache.threads;
    options.deterministic = cache.deterministic;
    options.cache = Options(inr::CachePrecision::Bits16, 9);
    options.cache.bytes = cache.bytes;
    options.cache.maximumRequests = cache.maximumRequests;
    return this->make(options, true);
  }

private:
  static float Lumps(const glm::vec3& u)
  {
    const auto lump = [&](const glm::vec3& center, float size) {
      const float away = glm::length(u - center) / size;
      return away < 1 ? (1 - away * away) * (1 - away * away) : 0.0f;
    };
    return 0.5f + 0.5f * lump({0.35f, 0.6f, 0.4f}, 0.3f) - 0.4f * lump({0.7f, 0.3f, 0.6f}, 0.25f);
  }

  /// Opaque at both ends, next to nothing where nothing is.
  static inr::TransferFunction MakeTable()
  {
    inr::TransferFunction function;
    function.low = Low;
    function.high = High;
    for (int k = 0; k < 65; ++k) {
      const float x = static_cast<float>(k) / 64;
      const float away = std::max(std::abs(x - 0.5f) - 0.03f, 0.0f);
      function.table.emplace_back(x, 1 - x, 0.25f, std::min(2.5f * away, 1.0f));
    }
    return function;
  }

  inr::MacroCells cells() const
  {
    inr::MacroCells cells = inr::MakeMacroCells(this->dims, CellEdge);
    cells.apron = 1.0 / glm::dvec3(this->dims);
    for (std::size_t k = 0; k < cells.ranges.size(); ++k) {
      const auto cell = static_cast<std::int64_t>(k);
      const glm::i64vec3 at = inr::GridPlace(cell, cells.dims);
      cells.ranges[k] = this->rangeAround(at * std::int64_t{CellEdge});
    }
    return cells;
  }

  /// Of all voxels that a cell's values, up to an apron of a voxel, are interpolated from.
  inr::ValueRange rangeAround(const glm::i64vec3& first) const
  {
    inr::ValueRange range;
    for (std::int64_t z = first.z - 2; z < first.z + CellEdge + 2; ++z) {
      for (std::int64_t y = first.y - 2; y < first.y + CellEdge + 2; ++y) {
        for (std::int64_t x = first.x - 2; x < first.x + CellEdge + 2; ++x) {
          range.extend(static_cast<float>(this->at(glm::dvec3(x, y, z))));
        }
      }
    }
    return range;
  }

  inr::Renderer make(const inr::RendererOptions& options, bool ranges) const
  {
    inr::VolumeInfo info = VolumeOf(this->dims);
    info.low = Low;
    info.high = High;
    inr::Renderer renderer(
        std::make_shared<FieldEvaluator>([this](const glm::vec3& u) { return this->Values.at(u); }),
        info, ranges ? this->cells() : inr::MacroCells{}, options);
    renderer.setTransferFunction(this->Table);
    return renderer;
  }

  Voxels Values{dims, Lumps};
  inr::TransferFunction Table = MakeTable();
};

/// That a picture comes by and by where time is short, and that it is then the one of all the time.
inline void ExpectRefinement(const BlendScene& scene, inr::Frame frame)
{
  BlendScene::Cache cache;
  cache.deterministic = true;
  cache.maximumRequests = 4;
  inr::Renderer renderer = scene.renderer(cache);
  frame.timeLimit = 1;
  inr::Image image;
  int frames = 1;
  while (!renderer.render(frame, image).complete) {
    ASSERT_LT(++frames, 500);
  }
  EXPECT_GT(frames, 3);
  frame.timeLimit = 0;
  EXPECT_EQ(image.pixels, Render(renderer, frame).pixels);
}
