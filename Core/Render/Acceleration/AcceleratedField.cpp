// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Acceleration/AcceleratedField.h"

#include "Core/NumberText.h"
#include "Core/Random.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace inr {

namespace {

/// Far more than rounding, far less than what a kernel gives that does not work.
constexpr float LargestDifference = 1e-3f;

/// A kernel that nobody has seen at work on a device like this one is not to be trusted unseen.
void RequireEqual(const std::vector<float>& device, const std::vector<float>& cpu)
{
  for (std::size_t k = 0; k < cpu.size(); ++k) {
    const float allowed = LargestDifference * (1.0f + std::abs(cpu[k]));
    if (!(std::abs(device[k] - cpu[k]) <= allowed)) {
      throw Error(ErrorCode::Device, "it gives " + NumberText(device[k]) + " where the CPU gives " +
                                         NumberText(cpu[k]));
    }
  }
}

void RequireAgreement(const Evaluator& device, const Evaluator& cpu)
{
  constexpr std::int64_t points = 1000;
  std::vector<glm::vec3> positions(points);
  for (std::size_t k = 0; k < positions.size(); ++k) {
    positions[k] = {RandomUnit(0, 3 * k), RandomUnit(0, 3 * k + 1), RandomUnit(0, 3 * k + 2)};
  }
  std::vector<float> values[2] = {std::vector<float>(points), std::vector<float>(points)};
  device.evaluate(positions.data(), points, values[0].data());
  cpu.evaluate(positions.data(), points, values[1].data());
  RequireEqual(values[0], values[1]);
}

/// One layer in the middle of the finest level, and one of the coarsest.
void RequireAgreement(const BrickSource& device, const BrickSource& cpu)
{
  const Hierarchy& levels = cpu.hierarchy();
  const auto layer = static_cast<std::size_t>(levels.voxelsPerBrick() / levels.brickDims().z);
  for (const BrickKey key : {KeyOf({0, levels.bricks(0) / std::int64_t{2}}), levels.coarsest()}) {
    std::vector<float> values[2] = {std::vector<float>(layer), std::vector<float>(layer)};
    const std::int64_t z = cpu.layersInside(key) / 2;
    device.inferLayer(key, z, values[0].data());
    cpu.inferLayer(key, z, values[1].data());
    RequireEqual(values[0], values[1]);
  }
}

bool IsSame(const Hierarchy& a, const Hierarchy& b)
{
  if (a.dims() != b.dims() || a.brickDims() != b.brickDims()) {
    return false;
  }
  int level = 0;
  while (level < a.levels() && a.points(level) == b.points(level)) {
    ++level;
  }
  return level == a.levels();
}

/// Whether `device`, which may be null, has done what `call` asks of it.
template <class Device, class Call>
bool Computes(AcceleratedField& field, const std::shared_ptr<const Device>& device,
              const Call& call)
{
  if (!device) {
    return false;
  }
  try {
    call(*device);
    return true;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Device) {
      throw;
    }
    field.fail(error, true);
    return false;
  }
}

class AcceleratedEvaluator : public Evaluator
{
public:
  AcceleratedEvaluator(std::shared_ptr<AcceleratedField> field,
                       std::shared_ptr<const Evaluator> cpu)
      : Field(std::move(field)), Cpu(std::move(cpu))
  {}

  void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
  {
    if (!Computes(*this->Field, this->Field->evaluator(*this->Cpu),
                  [&](const Evaluator& device) { device.evaluate(positions, count, values); })) {
      this->Cpu->evaluate(positions, count, values);
    }
  }
  std::int64_t pointsAtOnce() const override
  {
    const std::shared_ptr<const Evaluator> device = this->Field->evaluator(*this->Cpu);
    return device ? device->pointsAtOnce() : 0;
  }
  glm::i64vec3 resolution() const override { return this->Cpu->resolution(); }
  std::string kernel() const override { return this->Cpu->kernel(); }

private:
  std::shared_ptr<AcceleratedField> Field;
  std::shared_ptr<const Evaluator> Cpu;
};

class AcceleratedBricks : public BrickSource
{
public:
  AcceleratedBricks(std::shared_ptr<const Accelerator> accelerator, ModelPointer model,
                    std::shared_ptr<const BrickSource> cpu)
      : BrickSource(cpu->hierarchy()), Owner(std::move(accelerator)), Source(std::move(model)),
        Cpu(std::move(cpu))
  {}

  ValueRange rangeOf(BrickKey key) const override { return this->Cpu->rangeOf(key); }

  std::int64_t bricksAtOnce() const override
  {
    const std::shared_ptr<AcceleratedField> field = this->Owner->find(this->Source);
    const auto device = field ? field->madeBricks(this->hierarchy()) : nullptr;
    return device ? device->bricksAtOnce() : 0;
  }

  void inferLayer(BrickKey key, std::int64_t z, float* values) const override
  {
    if (!this->computes([&](const BrickSource& device) { device.inferLayer(key, z, values); })) {
      this->Cpu->inferLayer(key, z, values);
    }
  }

  void infer(const BrickKey* keys, std::int64_t count, float* values,
             const Arena& arena) const override
  {
    if (!this->computes(
            [&](const BrickSource& device) { device.infer(keys, count, values, arena); })) {
      this->Cpu->infer(keys, count, values, arena);
    }
  }

private:
  template <class Call> bool computes(const Call& call) const
  {
    const std::shared_ptr<AcceleratedField> field = this->Owner->find(this->Source);
    return field && Computes(*field, field->bricks(*this->Cpu), call);
  }

  std::shared_ptr<const Accelerator> Owner;
  ModelPointer Source;
  std::shared_ptr<const BrickSource> Cpu;
};

} // namespace

AcceleratedField::AcceleratedField(std::shared_ptr<const Accelerator> accelerator,
                                   ModelPointer model)
    : Owner(std::move(accelerator)), Source(std::move(model))
{}

std::optional<AcceleratedField::Failure> AcceleratedField::failure() const
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return this->Failed;
}

void AcceleratedField::fail(const Error& error, bool atWork)
{
  std::shared_ptr<const Evaluator> points; // which others may be in the midst of
  std::vector<std::shared_ptr<const BrickSource>> bricks;
  const std::lock_guard<std::mutex> lock(this->Mutex);
  if (!this->Failed) {
    this->Failed = Failure{error.what(), atWork};
  }
  this->Owner->Failed = true;
  points.swap(this->Points);
  bricks.swap(this->Bricks);
}

/// What cannot be made, whatever the reason, the CPU computes: of models that are wrong, it says so
/// itself.
template <class Make>
auto AcceleratedField::tryTo(const Make& make) -> decltype(make(std::declval<bool&>()))
{
  if (this->Failed) {
    return nullptr;
  }
  bool made = false;
  try {
    return make(made);
  } catch (const Error& error) {
    this->Failed = Failure{error.what(), made};
    this->Owner->Failed = true;
    this->Points.reset();
    this->Bricks.clear();
    return nullptr;
  }
}

std::shared_ptr<AcceleratedRenderer> AcceleratedField::makeRenderer(const glm::i64vec3& dims,
                                                                    const CacheOptions& options)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return this->tryTo([&](bool&) { return this->Owner->makeRenderer(this->Source, dims, options); });
}

std::shared_ptr<AcceleratedRenderer> AcceleratedField::makeNetworkRenderer()
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return this->tryTo([&](bool&) { return this->Owner->makeNetworkRenderer(this->Source); });
}

std::shared_ptr<const Evaluator> AcceleratedField::evaluator(const Evaluator& cpu)
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  if (!this->Points) {
    this->Points = this->tryTo([&](bool& made) {
      std::shared_ptr<const Evaluator> device = this->Owner->makeEvaluator(this->Source);
      made = true;
      RequireAgreement(*device, cpu);
      return device;
    });
  }
  return this->Points;
}

std::shared_ptr<const BrickSource> AcceleratedField::findBricks(const Hierarchy& hierarchy) const
{
  const auto found =
      std::find_if(this->Bricks.begin(), this->Bricks.end(),
                   [&](const auto& bricks) { return IsSame(bricks->hierarchy(), hierarchy); });
  return found != this->Bricks.end() ? *found : nullptr;
}

std::shared_ptr<const BrickSource> AcceleratedField::madeBricks(const Hierarchy& hierarchy) const
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return this->findBricks(hierarchy);
}

std::shared_ptr<const BrickSource> AcceleratedField::bricks(const BrickSource& cpu)
{
  constexpr std::size_t most = 2; // each has buffers of its own
  const std::lock_guard<std::mutex> lock(this->Mutex);
  std::shared_ptr<const BrickSource> bricks = this->findBricks(cpu.hierarchy());
  if (bricks) {
    return bricks;
  }
  bricks = this->tryTo([&](bool& made) {
    auto device = this->Owner->makeBrickSource(this->Source, cpu.hierarchy());
    made = true;
    RequireAgreement(*device, cpu);
    return device;
  });
  if (bricks) {
    this->Bricks.push_back(bricks);
    if (this->Bricks.size() > most) {
      this->Bricks.erase(this->Bricks.begin());
    }
  }
  return bricks;
}

std::shared_ptr<const Evaluator> MakeEvaluator(std::shared_ptr<AcceleratedField> field,
                                               std::shared_ptr<const Evaluator> cpu)
{
  return std::make_shared<AcceleratedEvaluator>(std::move(field), std::move(cpu));
}

std::shared_ptr<const BrickSource> MakeBrickSource(std::shared_ptr<const Accelerator> accelerator,
                                                   ModelPointer model,
                                                   std::shared_ptr<const BrickSource> cpu)
{
  return std::make_shared<AcceleratedBricks>(std::move(accelerator), std::move(model),
                                             std::move(cpu));
}

} // namespace inr
