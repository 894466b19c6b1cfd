// SPDX-License-Identifier: BSD-3-Clause
//
//   bench_cuda            samples per second of points and bricks on this machine's GPU, one JSON
//                         object per line: the device, what it does at most, results
//   bench_cuda --device   its name, and nothing else
//
// Ends with status 77 where there is no GPU, and says why. cuda.py writes the result file.
#include "CUDA/Inference/BrickBatch.h"
#include "CUDA/Inference/DeviceModel.h"
#include "Core/Error.h"
#include "Testing/Benchmarks/CudaCeiling.h"
#include "Testing/Benchmarks/Models.h"
#include "Testing/Core/RandomModel.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <iostream>

namespace {

using namespace inr::cuda;
using nlohmann::json;

constexpr int NoGpu = 77;
constexpr int Repetitions = 15;
constexpr std::int64_t Points = 1 << 22;
constexpr int BrickCount = 128;

class Event
{
public:
  Event() { INR_CUDA(cudaEventCreate(&this->Handle)); }
  ~Event() { cudaEventDestroy(this->Handle); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  void record(const Stream& stream) const { INR_CUDA(cudaEventRecord(this->Handle, stream.get())); }
  double secondsTo(const Event& end) const
  {
    float milliseconds = 0;
    INR_CUDA(cudaEventSynchronize(end.Handle));
    INR_CUDA(cudaEventElapsedTime(&milliseconds, this->Handle, end.Handle));
    return 1e-3 * static_cast<double>(milliseconds);
  }

private:
  cudaEvent_t Handle = nullptr;
};

double Median(std::vector<double> seconds)
{
  std::nth_element(seconds.begin(), seconds.begin() + seconds.size() / 2, seconds.end());
  return seconds[seconds.size() / 2];
}

/// Of what `begin` puts into the stream, by the device's clock; the first times do not count.
double DeviceSeconds(const Stream& stream, const std::function<void()>& begin)
{
  std::vector<double> seconds;
  for (int k = -3; k < Repetitions; ++k) {
    const Event before;
    const Event after;
    before.record(stream);
    begin();
    after.record(stream);
    const double passed = before.secondsTo(after);
    if (k >= 0) {
      seconds.push_back(passed);
    }
  }
  return Median(seconds);
}

/// Of a call, by the host's.
double HostSeconds(const std::function<void()>& call)
{
  std::vector<double> seconds;
  for (int k = -1; k < Repetitions; ++k) {
    const auto before = std::chrono::steady_clock::now();
    call();
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - before;
    if (k >= 0) {
      seconds.push_back(passed.count());
    }
  }
  return Median(seconds);
}

template <class T> Array<T> OnDevice(const T* from, std::int64_t count, const Device& device)
{
  const Stream stream(device.ordinal);
  Array<T> array(device.ordinal, Memory::Place::Device, count);
  CopyToDevice(array.data(), from, count, stream);
  stream.wait();
  return array;
}

json DescribeDevice(const Device& device)
{
  return {{"name", device.name},
          {"compute_capability", std::to_string(device.major) + "." + std::to_string(device.minor)},
          {"memory", device.memory},
          {"multiprocessors", device.multiprocessors},
          {"l2_cache", device.l2Cache},
          {"runtime", device.runtime}};
}

/// What the device does at most: products of pairs, and bytes read or written, a second.
json Ceilings(const Device& device)
{
  const Stream stream(device.ordinal);
  const Array<float> sink(device.ordinal, Memory::Place::Device,
                          std::int64_t{4} * device.multiprocessors * 256);
  std::int64_t products = 0;
  const double tensor = DeviceSeconds(stream, [&] {
    products = LaunchTensorCeiling(device.multiprocessors, sink.data(), stream.get());
  });
  constexpr std::int64_t bytes = 1 << 30;
  const Array<char> from(device.ordinal, Memory::Place::Device, bytes);
  const Array<char> to(device.ordinal, Memory::Place::Device, bytes);
  INR_CUDA(cudaMemsetAsync(from.data(), 1, bytes, stream.get()));
  const double copy = DeviceSeconds(stream, [&] {
    INR_CUDA(
        cudaMemcpyAsync(to.data(), from.data(), bytes, cudaMemcpyDeviceToDevice, stream.get()));
  });
  return {{"products", static_cast<double>(products) / tensor}, {"bytes", 2.0 * bytes / copy}};
}

/// What a sample takes at least, in products of the network and in bytes: those that come in and go
/// out, and each entry of the grid once for all of the samples.
json Floors(const inr::Model& model, std::int64_t samples, std::int64_t in, std::int64_t out)
{
  const inr::Layout layout(model.description);
  const auto levels = static_cast<std::int64_t>(layout.levels.size());
  const auto features = static_cast<std::int64_t>(model.description.grid.features);
  const std::int64_t table = static_cast<std::int64_t>(layout.parameterCount - layout.gridOffset);
  const std::int64_t grid = 2 * std::min(table, samples * levels * 8 * features);
  std::int64_t products = 0;
  for (const inr::LayerShape& layer : layout.layers) {
    const bool last = &layer == &layout.layers.back();
    const std::int64_t columns = &layer == &layout.layers[0] ? layout.encodedWidth : layer.columns;
    products += (last ? 1 : layer.rows) * columns;
  }
  return {{"products", products}, {"bytes", static_cast<double>(in + out + grid) / samples}};
}

json Result(const std::string& name, double samples, double seconds)
{
  return {{"name", name}, {"samples", samples}, {"seconds", seconds}};
}

json BenchPoints(const std::shared_ptr<const DeviceModel>& model)
{
  const Device& device = model->device();
  const std::string name = std::string("points, ") + model->name();
  const std::vector<glm::vec3> positions = RandomPositions(Points);
  const Array<float> in = OnDevice(&positions[0].x, 3 * Points, device);
  const Array<float> out(device.ordinal, Memory::Place::Device, Points);
  const LaunchPlan plan = model->plan(false);
  const Array<float> scratch(device.ordinal, Memory::Place::Device, plan.scratch);
  const Stream stream(device.ordinal);
  json result =
      Result(name, Points, DeviceSeconds(stream, [&] {
               model->inferPoints(plan, in.data(), Points, out.data(), scratch.data(), stream);
             }));
  result["floors"] = Floors(*model->source(), Points, 12 * Points, 4 * Points);
  const auto evaluator = MakeEvaluator(model);
  std::vector<float> values(positions.size());
  json whole =
      Result(name + ", with copies", Points,
             HostSeconds([&] { evaluator->evaluate(positions.data(), Points, values.data()); }));
  return {result, whole};
}

/// Bricks of 40^3 all over a level of a volume of 4096^3.
json BenchBricks(const std::shared_ptr<const DeviceModel>& model, int level)
{
  const Device& device = model->device();
  const std::string name =
      std::string("bricks of level ") + std::to_string(level) + ", " + model->name();
  const inr::Hierarchy levels({4096, 4096, 4096}, 40);
  const std::vector<inr::BrickKey> keys = SomeBricks(levels, level, BrickCount);
  BrickBatch batch;
  for (const inr::BrickKey key : keys) {
    batch.append(levels, key, 0, levels.brickDims().z);
  }
  const auto count = static_cast<std::int64_t>(batch.jobs.size());
  const Array<BrickJob> jobs = OnDevice(batch.jobs.data(), count, device);
  const Array<float> out(device.ordinal, Memory::Place::Device, batch.values);
  const LaunchPlan plan = model->plan(true);
  const Array<float> scratch(device.ordinal, Memory::Place::Device, plan.scratch);
  const Stream stream(device.ordinal);
  const std::int64_t samples = batch.values * (level == 0 ? 1 : 8);
  json result = Result(name, static_cast<double>(samples), DeviceSeconds(stream, [&] {
                         model->inferBricks(plan, jobs.data(), count, batch.items, out.data(),
                                            scratch.data(), stream);
                       }));
  result["floors"] = Floors(*model->source(), samples, 0, 4 * batch.values);
  const auto source = MakeBrickSource(model, levels);
  std::vector<float> values(static_cast<std::size_t>(batch.values));
  const inr::Arena arena(1);
  json whole =
      Result(name + ", with copies", static_cast<double>(samples),
             HostSeconds([&] { source->infer(keys.data(), count, values.data(), arena); }));
  return {result, whole};
}

/// With parameters as files have them.
inr::ModelPointer HalvesOf(const std::shared_ptr<inr::Model>& model)
{
  for (float& parameter : model->parameters) {
    parameter = ToFloat(ToHalf(parameter));
  }
  return model;
}

void Print(const json& line) { std::cout << line << std::endl; }

/// Prints what there is as it comes: something may fail behind it.
void BenchAll(const Device& device)
{
  const CurrentDevice current(device.ordinal);
  Print({{"device", DescribeDevice(device)}});
  Print({{"ceilings", Ceilings(device)}});
  const inr::ModelPointer model = HalvesOf(RandomModel(DefaultDescription()));
  const auto printAll = [](const json& results) {
    for (const json& result : results) {
      Print(result);
    }
  };
  for (const Precision precision : {Precision::Half, Precision::Float32}) {
    const auto uploaded = UploadModel(model, device, precision);
    printAll(BenchPoints(uploaded));
    printAll(BenchBricks(uploaded, 0));
    printAll(BenchBricks(uploaded, 1));
  }
}

} // namespace

int main(int argc, char** argv)
{
  try {
    const Devices devices = FindDevices();
    if (devices.usable.empty()) {
      std::cerr << devices.reason << "\n";
      return NoGpu;
    }
    if (argc > 1 && std::strcmp(argv[1], "--device") == 0) {
      std::cout << devices.usable[0].name << "\n";
    } else {
      BenchAll(devices.usable[0]);
    }
    return 0;
  } catch (const inr::Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
