// SPDX-License-Identifier: BSD-3-Clause
// What the mapper's properties mean to Core, and what PrintSelf says of them.
#include "Representations/Mapper/Pictures/PaintSettings.h"
#include "vtkINRVolumeMapper.h"

#include <glm/gtc/type_ptr.hpp>

#include <cstdint>
#include <optional>

namespace {

std::optional<inr::InferencePrecision> InferenceFor(double tolerance, int wanted)
{
  if (!(tolerance < 0) || wanted == vtkINRVolumeMapper::SINGLE) {
    return inr::InferencePrecision::Float32;
  }
  if (wanted == vtkINRVolumeMapper::BFLOAT16) {
    return inr::InferencePrecision::BFloat16;
  }
  return std::nullopt;
}

} // namespace

void vtkINRVolumeMapper::SetCacheMode(int mode)
{
  if (mode < CACHE_AND_NETWORK || mode > NETWORK_ONLY) {
    vtkErrorMacro("There is no CacheMode " << mode << "; it is 0 (cache and network), 1 "
                                           << "(cache only) or 2 (network only).");
    return;
  }
  if (mode != this->CacheMode) {
    this->CacheMode = mode;
    this->Modified();
  }
}

inr::PaintSettings vtkINRVolumeMapper::Settings() const
{
  inr::PaintSettings settings;
  settings.mode = static_cast<inr::RenderMode>(this->RenderMode);
  settings.samplesPerPixel = this->SamplesPerPixel;
  settings.paths.maximumBounces = this->MaximumBounces;
  settings.paths.scatteringAlbedo = static_cast<float>(this->ScatteringAlbedo);
  settings.paths.anisotropy = this->Anisotropy;
  settings.paths.ambientLight = glm::make_vec3(this->AmbientLight);
  settings.sampleDistance = this->SampleDistance;
  settings.adaptiveSampling = this->AdaptiveSampling;
  settings.preIntegration = this->PreIntegration;
  settings.levelOfDetailScale = this->LevelOfDetailScale;
  if (!(this->ErrorTolerance < 0)) { // what is no number is refused with the frame
    settings.errorTolerance = this->ErrorTolerance;
  }
  settings.stillTimeLimit = this->StillTimeLimit;
  settings.shownElsewhere = this->ShownElsewhere;
  settings.forSelection = this->ForSelection;
  settings.hurried = this->Hurried;
  settings.countSamples = this->SampleChannels;
  settings.seed = static_cast<std::uint64_t>(this->Seed);
  inr::RendererOptions& renderer = settings.renderer;
  renderer.threads = this->NumberOfThreads;
  renderer.deterministic = this->Deterministic;
  renderer.inference = InferenceFor(this->ErrorTolerance, this->InferencePrecision);
  renderer.cached = this->CacheMode != NETWORK_ONLY;
  renderer.cache.bytes = std::int64_t{this->CacheSize} << 20;
  renderer.cache.precision = static_cast<inr::CachePrecision>(this->CachePrecision);
  renderer.cache.brickSize = this->BrickSize;
  renderer.cache.maximumRequests = this->MaximumRequests;
  renderer.cache.ranking = this->PriorityRanking;
  renderer.cache.onlyWhatFits = this->CacheMode == CACHE_ONLY;
  renderer.cache.preloading = this->Preloading;
  return settings;
}

void vtkINRVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "RenderMode: " << this->RenderMode << "\n"
     << indent << "Backend: " << this->Backend << "\n"
     << indent << "LocalRank: " << this->LocalRank << "\n"
     << indent << "ProcessOrder: " << this->ProcessOrder.size() << " processes\n"
     << indent << "AlwaysTogether: " << this->AlwaysTogether << "\n"
     << indent << "SamplesPerPixel: " << this->SamplesPerPixel << "\n"
     << indent << "ScatteringAlbedo: " << this->ScatteringAlbedo << "\n"
     << indent << "Anisotropy: " << this->Anisotropy << "\n"
     << indent << "MaximumBounces: " << this->MaximumBounces << "\n"
     << indent << "AmbientLight: " << this->AmbientLight[0] << " " << this->AmbientLight[1] << " "
     << this->AmbientLight[2] << "\n"
     << indent << "SampleDistance: " << this->SampleDistance << "\n"
     << indent << "AdaptiveSampling: " << this->AdaptiveSampling << "\n"
     << indent << "PreIntegration: " << this->PreIntegration << "\n"
     << indent << "LevelOfDetailScale: " << this->LevelOfDetailScale << "\n"
     << indent << "ErrorTolerance: " << this->ErrorTolerance << "\n"
     << indent << "CacheMode: " << this->CacheMode << "\n"
     << indent << "CacheSize: " << this->CacheSize << "\n"
     << indent << "InferencePrecision: " << this->InferencePrecision << "\n"
     << indent << "CachePrecision: " << this->CachePrecision << "\n"
     << indent << "BrickSize: " << this->BrickSize << "\n"
     << indent << "MaximumRequests: " << this->MaximumRequests << "\n"
     << indent << "PriorityRanking: " << this->PriorityRanking << "\n"
     << indent << "Preloading: " << this->Preloading << "\n"
     << indent << "StillTimeLimit: " << this->StillTimeLimit << "\n"
     << indent << "ShownElsewhere: " << this->ShownElsewhere << "\n"
     << indent << "ForSelection: " << this->ForSelection << "\n"
     << indent << "Hurried: " << this->Hurried << "\n"
     << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n"
     << indent << "Seed: " << this->Seed << "\n"
     << indent << "Deterministic: " << this->Deterministic << "\n"
     << indent << "SampleChannels: " << this->SampleChannels << "\n"
     << indent << "FrameTime: " << this->GetFrameTime() << "\n"
     << indent << "NumberOfSamples: " << this->GetNumberOfSamples() << "\n"
     << indent << "NumberOfClampedSamples: " << this->GetNumberOfClampedSamples() << "\n"
     << indent << "NumberOfNetworkSamples: " << this->GetNumberOfNetworkSamples() << "\n"
     << indent << "NumberOfDecodedBricks: " << this->GetNumberOfDecodedBricks() << "\n"
     << indent << "NumberOfVisitedCells: " << this->GetNumberOfVisitedCells() << "\n"
     << indent << "Converged: " << this->GetConverged() << "\n"
     << indent << "CacheHitRate: " << this->GetCacheHitRate() << "\n"
     << indent << "CacheUsed: " << this->GetCacheUsed() << "\n"
     << indent << "FinestLevel: " << this->GetFinestLevel() << "\n"
     << indent << "CoarsestLevel: " << this->GetCoarsestLevel() << "\n"
     << indent << "NumberOfPaths: " << this->GetNumberOfPaths() << "\n"
     << indent << "ImageReduction: " << this->GetImageReduction() << "\n"
     << indent << "BackendInUse: " << this->GetBackendInUse() << "\n"
     << indent << "OpaqueDepthRead: " << this->GetOpaqueDepthRead() << "\n";
}
