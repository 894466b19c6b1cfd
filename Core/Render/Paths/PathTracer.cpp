// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Paths/PathTracer.h"

#include "Core/Error.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace inr {

namespace {

std::vector<PathLight> PathLights(const InnerRays& inner, const std::vector<Light>& lights)
{
  std::vector<PathLight> made;
  for (const Light& light : lights) {
    made.push_back(MakePathLight(inner, light));
  }
  return made;
}

std::uint64_t PieceNumber(const std::vector<glm::dvec4>& piece)
{
  std::uint64_t number = 0;
  for (const glm::dvec4& plane : piece) {
    for (int k = 0; k < 4; ++k) {
      std::uint64_t bits;
      std::memcpy(&bits, &plane[k], sizeof(bits));
      number = RandomBits(number, bits);
    }
  }
  return number;
}

/// As paths do that meet nothing.
void WriteNothing(const Tile& tile, Image& rgba, Image* depth)
{
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    std::fill_n(rgba.pixel(tile.x, y), 4 * tile.width, 0.0f);
    if (depth != nullptr) {
      std::fill_n(depth->pixel(tile.x, y), tile.width, 0.0f);
    }
  }
}

/// The paths of a tile, each asking for one value in a round.
class TileOfPaths
{
public:
  TileOfPaths(const PathScene& scene, const SeenSpans& seen, const Tile& tile)
      : Scene(scene), Place(tile)
  {
    this->Paths.reserve(static_cast<std::size_t>(tile.width) * tile.height);
    for (int k = 0; k < tile.width * tile.height; ++k) {
      this->Paths.emplace_back(scene, this->x(k), this->y(k));
      PathState& path = this->Paths.back();
      Confine(path, seen.of(path.ray, this->x(k), this->y(k)));
      if (path.ray.length > 0) {
        this->Live.push_back(k);
      }
    }
    this->Statistics.rays = static_cast<std::int64_t>(this->Live.size());
  }

  void trace(FieldSampler& sampler)
  {
    for (this->place(); !this->Live.empty(); this->place()) {
      const auto count = static_cast<std::int64_t>(this->Live.size());
      sampler.sample(this->Points.data(), count, this->Values.data());
      this->Statistics.samples += count;
      this->collide();
    }
    for (const PathState& path : this->Paths) {
      this->Statistics.work.scatterings += path.bounces;
      this->Statistics.work.cells += path.walker.visited();
    }
  }

  void write(Image& rgba, Image* depth) const
  {
    for (int k = 0; k < this->Place.width * this->Place.height; ++k) {
      const PathState& path = this->Paths[static_cast<std::size_t>(k)];
      const glm::vec4 color =
          ShownColor(this->Scene, path, this->Scene.rays.pixel(this->x(k), this->y(k)));
      std::copy_n(&color.x, 4, rgba.pixel(this->x(k), this->y(k)));
      if (depth != nullptr) {
        *depth->pixel(this->x(k), this->y(k)) = path.collided ? this->depthOf(path) : 0.0f;
      }
    }
  }

  const FrameStatistics& statistics() const { return this->Statistics; }

private:
  /// Of a path that leaves the camera nothing can be seen outside a span.
  static void Confine(PathState& path, const SeenSpan& seen)
  {
    path.t = std::max(seen.begin, 0.0);
    path.ray.length = std::min(path.ray.length, seen.end);
  }

  int x(int k) const { return this->Place.x + k % this->Place.width; }
  int y(int k) const { return this->Place.y + k / this->Place.width; }

  float depthOf(const PathState& path) const
  {
    return static_cast<float>(this->Scene.rays.windowDepth(path.firstCollision));
  }

  void place()
  {
    this->Samples.resize(this->Live.size());
    this->Points.resize(this->Live.size());
    std::size_t alive = 0;
    for (const int k : this->Live) {
      if (PlaceSample(this->Scene, this->Paths[static_cast<std::size_t>(k)], this->Samples[alive],
                      this->Points[alive])) {
        this->Live[alive++] = k;
      }
    }
    this->Live.resize(alive);
    this->Values.resize(alive);
  }

  void collide()
  {
    std::size_t alive = 0;
    for (std::size_t live = 0; live < this->Live.size(); ++live) {
      const int k = this->Live[live];
      const PathSample& sample = this->Samples[live];
      PathState& path = this->Paths[static_cast<std::size_t>(k)];
      float value = this->Values[live];
      this->Statistics.work.lightSteps += path.towardsLight ? 1 : 0;
      if (std::isnan(value)) { // FieldSampler::Hidden
        PassBy(path);
        this->Live[alive++] = k;
        continue;
      }
      this->Statistics.clamped += ClampToRange(sample.range, value) ? 1 : 0;
      if (Collide(this->Scene, path, sample.majorant, value)) {
        this->Live[alive++] = k;
      }
    }
    this->Live.resize(alive);
  }

  const PathScene& Scene;
  Tile Place;
  FrameStatistics Statistics;
  std::vector<PathState> Paths;
  std::vector<int> Live;           ///< indices into Paths
  std::vector<PathSample> Samples; ///< of the live ones
  std::vector<FieldPoint> Points;
  std::vector<float> Values;
};

} // namespace

void Accumulator::reset(int width, int height, int channels)
{
  this->Width = width;
  this->Height = height;
  this->Channels = channels;
  this->Count = 0;
  this->Sums.assign(static_cast<std::size_t>(width) * height * channels, 0.0);
}

void Accumulator::add(const Image& sample)
{
  if (sample.width != this->Width || sample.height != this->Height ||
      sample.channels != this->Channels) {
    throw Error(ErrorCode::InvalidArgument,
                "an accumulator takes pictures of the shape it was reset to");
  }
  for (std::size_t k = 0; k < this->Sums.size(); ++k) {
    this->Sums[k] += sample.pixels[k];
  }
  ++this->Count;
}

void Accumulator::mean(Image& picture) const
{
  picture = Image(this->Width, this->Height, this->Channels);
  const double weight = this->Count > 0 ? 1.0 / static_cast<double>(this->Count) : 0.0;
  std::transform(this->Sums.begin(), this->Sums.end(), picture.pixels.begin(),
                 [weight](double sum) { return static_cast<float>(sum * weight); });
}

PathTracer::PathTracer(const Frame& frame, const RayGeometry& geometry, const glm::i64vec3& dims,
                       const Majorants& majorants, const ColorLookup& colors, int levels)
    : Picture(frame), Inner(frame, geometry, dims, this->Planes),
      Lights(PathLights(this->Inner, frame.lights)), Scene{StreamsOf(frame),
                                                           geometry.view(),
                                                           this->Inner,
                                                           majorants.view(),
                                                           MakeCellScale(majorants.view().grid(0),
                                                                         glm::dvec3(dims)),
                                                           colors,
                                                           this->Lights.data(),
                                                           static_cast<int>(this->Lights.size()),
                                                           frame.paths,
                                                           frame.levelOfDetailScale,
                                                           glm::dvec3(dims),
                                                           geometry.lengthPerUnit() /
                                                               frame.unitDistance,
                                                           levels,
                                                           PieceNumber(frame.piece)},
      Seen(geometry.view(), majorants.view(), glm::dvec3(dims), frame.levelOfDetailScale, levels)
{}

FrameStatistics PathTracer::trace(const Tile& tile, FieldSampler& sampler, Image& rgba,
                                  Image* depth) const
{
  if (this->Seen.isEmpty(tile)) {
    WriteNothing(tile, rgba, depth);
    return {};
  }
  TileOfPaths paths(this->Scene, this->Seen, tile);
  paths.trace(sampler);
  paths.write(rgba, depth);
  return paths.statistics();
}

} // namespace inr
