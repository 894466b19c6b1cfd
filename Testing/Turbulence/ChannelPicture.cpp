// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Turbulence/ChannelPicture.h"

#include "Core/Error.h"
#include "Core/Render/Marching/RayMarching.h"
#include "Testing/Turbulence/ChannelSampler.h"

#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <vector>

namespace inr {
namespace {

constexpr double Invisible = 1e-6; // transmittance

glm::dvec3 Vector(const nlohmann::json& numbers)
{
  return {numbers.at(0).get<double>(), numbers.at(1).get<double>(), numbers.at(2).get<double>()};
}

glm::dmat4 ClipToWorld(const nlohmann::json& scene, double aspect)
{
  const glm::dvec3 eye = Vector(scene.at("position"));
  const glm::dmat4 view =
      glm::lookAt(eye, Vector(scene.at("focal_point")), Vector(scene.at("view_up")));
  const nlohmann::json& range = scene.at("clipping_range");
  const double angle = glm::radians(scene.at("view_angle").get<double>());
  return glm::inverse(
      glm::perspective(angle, aspect, range.at(0).get<double>(), range.at(1).get<double>()) * view);
}

glm::dmat4 WorldToIndex(const glm::i64vec3& dims)
{
  const glm::dvec3 spacing = TurbulentChannel::Size / glm::dvec3(dims);
  const glm::dmat4 scaled = glm::scale(glm::dmat4(1.0), 1.0 / spacing);
  return glm::translate(scaled, -0.5 * spacing);
}

ChannelScene SceneFrom(const nlohmann::json& json)
{
  ChannelScene scene;
  scene.dims = glm::i64vec3(Vector(json.at("dims")));
  Frame& frame = scene.frame;
  frame.width = json.at("size").at(0).get<int>();
  frame.height = json.at("size").at(1).get<int>();
  frame.clipToWorld = ClipToWorld(json, static_cast<double>(frame.width) / frame.height);
  frame.worldToIndex = WorldToIndex(scene.dims);
  frame.sampleDistance = json.at("sample_distance").get<double>();
  frame.unitDistance = json.at("unit_distance").get<double>();
  frame.seed = json.at("seed").get<std::uint64_t>();
  for (const nlohmann::json& node : json.at("colors")) {
    scene.colors[node.at(0).get<double>()] =
        glm::dvec4(node.at(1).get<double>(), node.at(2).get<double>(), node.at(3).get<double>(),
                   node.at(4).get<double>());
  }
  return scene;
}

void Check(const ChannelScene& scene)
{
  const glm::i64vec3& dims = scene.dims;
  if (dims.x < 1 || dims.y < 1 || dims.z < 1) {
    throw Error(ErrorCode::InvalidArgument, "a scene needs at least a voxel per axis");
  }
  if (scene.colors.empty()) {
    throw Error(ErrorCode::InvalidArgument, "a scene needs at least one of its colors");
  }
}

glm::dvec4 ColorAt(const std::map<double, glm::dvec4>& colors, double value)
{
  const auto above = colors.lower_bound(value);
  if (above == colors.begin()) {
    return above->second;
  }
  const auto below = std::prev(above);
  if (above == colors.end()) {
    return below->second;
  }
  return glm::mix(below->second, above->second,
                  (value - below->first) / (above->first - below->first));
}

/// One ray after the other.
class Marcher
{
public:
  Marcher(const ChannelSampler& field, const ChannelScene& scene, const RayGeometry& geometry)
      : Field(field), Scene(scene), Geometry(geometry)
  {}

  glm::dvec4 march(int x, int y)
  {
    const Frame& frame = this->Scene.frame;
    const Ray ray = this->Geometry.ray(x, y);
    const double end = ray.length / frame.sampleDistance;
    const double jitter = JitterOf(MarchSettings(), StreamsOf(frame).at(x, y));
    this->Color = glm::dvec4(0);
    for (double first = 0; first < end && this->Color.w < 1 - Invisible; first += AtOnce) {
      this->place(ray, first, std::min(end, first + AtOnce), end, jitter);
      this->composite();
    }
    return this->Color;
  }

  std::int64_t samples() const { return this->Samples; }

private:
  static constexpr int AtOnce = 4 * ChannelPoints;

  /// Sample k stands for the steps [k, k + 1) and is at k + jitter; the ray's end cuts the last.
  void place(const Ray& ray, double first, double last, double end, double jitter)
  {
    const double step = this->Scene.frame.sampleDistance;
    const double units = this->Geometry.lengthPerUnit() / this->Scene.frame.unitDistance;
    this->Points.clear();
    this->Lengths.clear();
    for (double k = first; k < last; ++k) {
      const glm::dvec3 last3 = glm::dvec3(this->Scene.dims) - 1.0;
      const glm::dvec3 index = ray.at(std::min(k + jitter, end) * step);
      this->Points.push_back((glm::clamp(index, glm::dvec3(0.0), last3) + 0.5) /
                             glm::dvec3(this->Scene.dims));
      this->Lengths.push_back(std::min(1.0, end - k) * step * units);
    }
  }

  void composite()
  {
    const std::size_t count = this->Points.size();
    this->Values.resize(count);
    this->Field.at(this->Points.data(), static_cast<std::int64_t>(count), this->Values.data());
    this->Samples += static_cast<std::int64_t>(count);
    for (std::size_t k = 0; k < count; ++k) {
      const glm::dvec4 color = ColorAt(this->Scene.colors, this->Values[k]);
      const double alpha = -std::expm1(this->Lengths[k] * std::log1p(-color.w));
      this->Color += glm::dvec4(glm::dvec3(color), 1.0) * ((1.0 - this->Color.w) * alpha);
    }
  }

  const ChannelSampler& Field;
  const ChannelScene& Scene;
  const RayGeometry& Geometry;
  std::vector<glm::dvec3> Points;
  std::vector<double> Lengths; ///< in units of opacity
  std::vector<double> Values;
  glm::dvec4 Color{0};
  std::int64_t Samples = 0;
};

} // namespace

ChannelScene ParseChannelScene(const std::string& json)
{
  try {
    const ChannelScene scene = SceneFrom(nlohmann::json::parse(json));
    Check(scene);
    return scene;
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::InvalidArgument,
                std::string("a scene lacks something: ") + error.what());
  }
}

Image DrawChannel(const TurbulentChannel& field, const ChannelScene& scene, const Arena& arena,
                  std::int64_t* samples)
{
  Check(scene);
  const RayGeometry geometry(scene.frame, scene.dims);
  const ChannelSampler sampler(field);
  Image picture(scene.frame.width, scene.frame.height, 4);
  std::atomic<std::int64_t> all{0};
  arena.forEachBlock(picture.height, 1, [&](std::int64_t row, std::int64_t) {
    Marcher marcher(sampler, scene, geometry);
    for (int x = 0; x < picture.width; ++x) {
      const glm::vec4 color(marcher.march(x, static_cast<int>(row)));
      std::copy_n(&color.x, 4, picture.pixel(x, static_cast<int>(row)));
    }
    all += marcher.samples();
  });
  if (samples != nullptr) {
    *samples = all;
  }
  return picture;
}

} // namespace inr
