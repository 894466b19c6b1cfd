// SPDX-License-Identifier: BSD-3-Clause
//
// An accelerator that is none, or that stands before another one: it counts what it is asked for,
// and fails when it is told to.
#pragma once

#include "Core/Error.h"
#include "Core/Render/Acceleration/Accelerator.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

/// What the test and what an accelerator has made know of each other.
struct FakeDevice
{
  static constexpr int Never = std::numeric_limits<int>::max();

  std::atomic<int> failsAt{Never}; ///< that call and all that follow fail; 0 = the first
  bool hasMemory = true;           ///< else nothing can be made
  float error = 0;                 ///< of its values
  std::atomic<int> calls{0};       ///< so far
  std::atomic<int> refused{0};     ///< of them
  std::atomic<int> made{0};
  std::atomic<int> alive{0}; ///< of what was made

  /// A call for `count` values, which `compute` computes. One that fails leaves half of them wrong,
  /// as a copy that broke off might.
  template <class Compute> void call(std::int64_t count, float* values, const Compute& compute)
  {
    const bool fails = this->calls++ >= this->failsAt;
    if (fails) {
      ++this->refused;
      std::fill(values, values + (count + 1) / 2, std::nanf(""));
      throw inr::Error(inr::ErrorCode::Device, "the fake device is lost");
    }
    compute();
    std::for_each(values, values + count, [this](float& value) { value += this->error; });
  }
};

class FakeAccelerator : public inr::Accelerator
{
public:
  /// Without `inner`, Core computes, with a kernel by name; see inr::MakeEvaluator.
  explicit FakeAccelerator(std::shared_ptr<FakeDevice> device,
                           std::shared_ptr<const inr::Accelerator> inner = nullptr,
                           std::string kernel = "")
      : Device(std::move(device)), Inner(std::move(inner)), Kernel(std::move(kernel))
  {}

  std::string name() const override { return "Fake device"; }

  std::shared_ptr<const inr::Evaluator> makeEvaluator(const inr::ModelPointer& model) const override
  {
    this->begin();
    return std::make_shared<Points>(this->Device, this->Inner
                                                      ? this->Inner->makeEvaluator(model)
                                                      : inr::MakeEvaluator(model, this->Kernel));
  }

  std::shared_ptr<const inr::BrickSource>
  makeBrickSource(const inr::ModelPointer& model, const inr::Hierarchy& hierarchy) const override
  {
    this->begin();
    return std::make_shared<Bricks>(
        this->Device,
        this->Inner ? this->Inner->makeBrickSource(model, hierarchy)
                    : inr::MakeBrickSource(inr::MakeEvaluator(model, this->Kernel), hierarchy));
  }

private:
  class Alive
  {
  public:
    explicit Alive(std::shared_ptr<FakeDevice> device) : Device(std::move(device))
    {
      ++this->Device->alive;
    }
    ~Alive() { --this->Device->alive; }
    Alive(const Alive&) = delete;
    Alive& operator=(const Alive&) = delete;

    const std::shared_ptr<FakeDevice> Device;
  };

  class Points : public inr::Evaluator
  {
  public:
    Points(std::shared_ptr<FakeDevice> device, std::shared_ptr<const inr::Evaluator> inner)
        : Mine(std::move(device)), Inner(std::move(inner))
    {}
    void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
    {
      this->Mine.Device->call(count, values,
                              [&] { this->Inner->evaluate(positions, count, values); });
    }
    std::int64_t pointsAtOnce() const override { return 1 << 15; }
    std::string kernel() const override { return "fake"; }

  private:
    Alive Mine;
    std::shared_ptr<const inr::Evaluator> Inner;
  };

  class Bricks : public inr::BrickSource
  {
  public:
    Bricks(std::shared_ptr<FakeDevice> device, std::shared_ptr<const inr::BrickSource> inner)
        : BrickSource(inner->hierarchy()), Mine(std::move(device)), Inner(std::move(inner))
    {}
    std::int64_t bricksAtOnce() const override { return 4; }
    void inferLayer(inr::BrickKey key, std::int64_t z, float* values) const override
    {
      const std::int64_t count =
          this->hierarchy().voxelsPerBrick() / this->hierarchy().brickDims().z;
      this->Mine.Device->call(count, values, [&] { this->Inner->inferLayer(key, z, values); });
    }
    void infer(const inr::BrickKey* keys, std::int64_t count, float* values,
               const inr::Arena& arena) const override
    {
      this->Mine.Device->call(count * this->hierarchy().voxelsPerBrick(), values,
                              [&] { this->Inner->infer(keys, count, values, arena); });
    }

  private:
    Alive Mine;
    std::shared_ptr<const inr::BrickSource> Inner;
  };

  void begin() const
  {
    ++this->Device->made;
    if (!this->Device->hasMemory) {
      throw inr::Error(inr::ErrorCode::Device, "the fake device has no memory");
    }
  }

  std::shared_ptr<FakeDevice> Device;
  std::shared_ptr<const inr::Accelerator> Inner;
  std::string Kernel;
};
