// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/TrainingIdentity.h"

#include "Core/Model/DescriptionJson.h"
#include "Core/Model/ModelBlobs.h"
#include "Core/Training/Descent/Optimiser.h"

#include <nlohmann/json.hpp>

namespace inr {

namespace {

using nlohmann::json;

constexpr const char* KernelName = "the kernel family";

/// Numbers with all their digits, names in quotes.
std::string Text(const json& value)
{
  return value.dump(-1, ' ', /*ensure_ascii=*/true, json::error_handler_t::replace);
}

/// Of the parameters that the training starts from; 0 = random ones.
std::uint32_t ChecksumOf(const ModelPointer& start)
{
  return start ? ContinueChecksum(0, start->parameters.data(),
                                  start->parameters.size() * sizeof(float))
               : 0;
}

} // namespace

TrainingIdentity IdentityOf(const Model& model, const TrainingOptions& options,
                            const PsnrEstimate& estimate, const BatchSource& batches, int processes)
{
  if (options.checkpoint.path.empty()) {
    return {};
  }
  const VolumeInfo& volume = model.volume;
  return {{"the array", Text(volume.arrayName)},
          {"the array's type", ScalarName(volume.type)},
          {"the volume's size", Text({volume.dims.x, volume.dims.y, volume.dims.z})},
          {"the range of values", Text({volume.low, volume.high})},
          {"the number of values that are not finite", Text(model.training->nonFinite)},
          {"the values of random voxels (checksum)", Text(estimate.checksum())},
          {"the time step", volume.time ? Text(*volume.time) : "none"},
          {"the model", Text(DescriptionToJson(model.description))},
          {"the parameters to start from (checksum)", Text(ChecksumOf(options.start))},
          {"the number of processes", Text(processes)},
          {KernelName, model.training->kernel},
          {"the optimiser", OptimiserName},
          {"Seed", Text(options.seed)},
          {"TargetPSNR", Text(options.targetPsnr)},
          {"TargetRatio", Text(options.targetRatio)},
          {"MaximumSteps", Text(options.maximumSteps)},
          {"PlannedSteps", Text(options.plannedSteps)},
          {"TimeLimit", Text(options.timeLimit)},
          {"the samples, which MemoryLimit decides on,", batches.name()},
          {"the precision of the file", NameOf(ParameterTypeNames, options.storedAs)}};
}

TrainingIdentity WithoutKernel(TrainingIdentity identity)
{
  identity.erase(KernelName);
  return identity;
}

bool HaveSameSamples(const TrainingIdentity& one, const TrainingIdentity& other)
{
  return WithoutKernel(one) == WithoutKernel(other);
}

} // namespace inr
