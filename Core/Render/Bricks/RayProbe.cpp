// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/RayProbe.h"

namespace inr {

RayProbe::RayProbe(const CachedScene& scene, OnMiss onMiss)
    : Scene(scene), Stops(onMiss == OnMiss::Stop),
      Gradients(*scene.bricks, scene.format, scene.kernel)
{}

bool RayProbe::find(const Ray& ray, int level, double place, float contribution,
                    RequestList& requests, float& value)
{
  if (!this->Run.covers(level, place) && !this->open(ray, level, place, contribution, requests)) {
    return false;
  }
  this->Batch.path[0] = 0;
  this->Batch.along[0] = this->Run.along(place);
  this->Scene.kernel.sample(this->Scene.format, this->Batch, 1);
  value = this->Batch.value[0];
  return true;
}

bool RayProbe::open(const Ray& ray, int level, double place, float contribution,
                    RequestList& requests)
{
  const BrickCache& cache = this->Scene.bricks->cache();
  const double step = this->Scene.settings.step;
  BrickWay wanted(cache.hierarchy().view(), level, ray);
  wanted.moveTo(place * step);
  std::int32_t slot = this->Scene.bricks->find(wanted.brick());
  if (slot < 0) {
    requests.add(wanted.brick(), this->Stops ? 1.0f : contribution);
    if (this->Stops) {
      return false;
    }
  }
  BrickWay served = wanted;
  while (slot < 0) { // the coarsest level is there
    served = BrickWay(cache.hierarchy().view(), served.level() + 1, ray);
    served.moveTo(place * step);
    slot = this->Scene.bricks->find(served.brick());
  }
  cache.touch(slot);
  this->Run.open(wanted, served, cache.view(slot), step);
  this->Brick = this->Run.served();
  this->Batch.paths[0] = this->Run.path();
  return true;
}

bool RayProbe::findGradient(float contribution, RequestList& requests, glm::vec3& gradient)
{
  const int first = 0;
  const auto missing =
      this->Stops ? BrickGradients::Missing::Stop : BrickGradients::Missing::OneSided;
  const bool found = this->Gradients.find(this->Batch, &this->Brick, &first, 1, missing,
                                          contribution, requests) == 1;
  gradient = this->Gradients.latest(0);
  return found;
}

} // namespace inr
