// SPDX-License-Identifier: BSD-3-Clause
//
// Renders a model file into an OpenEXR picture with Core alone; no VTK.
//
//     example_core_view MODEL.inr PICTURE.exr
#include "Core/Image/Exr.h"
#include "Core/Model/ModelFile.h"
#include "Core/Render/Renderer.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstdio>
#include <exception>

namespace {

constexpr int PictureSize = 600;

glm::dmat4 IndexToWorld(const inr::VolumeInfo& volume)
{
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), volume.origin);
  return glm::scale(moved * glm::dmat4(volume.direction), volume.spacing);
}

/// Blue and clear to orange and half opaque.
inr::TransferFunction Colours(const inr::VolumeInfo& volume)
{
  inr::TransferFunction colours;
  colours.low = volume.low;
  colours.high = volume.high;
  colours.table = {{0.1f, 0.2f, 0.6f, 0.0f}, {1.0f, 0.7f, 0.3f, 0.5f}};
  return colours;
}

/// The whole volume, seen from 30 degrees beside the z axis.
inr::Frame Look(const inr::VolumeInfo& volume)
{
  const glm::dmat4 indexToWorld = IndexToWorld(volume);
  const glm::dvec3 last = glm::dvec3(volume.dims) - 1.0;
  const glm::dvec3 centre(indexToWorld * glm::dvec4(0.5 * last, 1.0));
  const double radius = 0.5 * glm::length(last * volume.spacing);
  const double angle = glm::radians(30.0);
  const double distance = radius / std::sin(0.5 * angle);
  const glm::dvec3 eye = centre + distance * glm::dvec3(std::sin(angle), 0.0, std::cos(angle));

  inr::Frame frame;
  frame.width = PictureSize;
  frame.height = PictureSize;
  frame.clipToWorld =
      glm::inverse(glm::perspective(angle, 1.0, distance - radius, distance + radius) *
                   glm::lookAt(eye, centre, glm::dvec3(0.0, 1.0, 0.0)));
  frame.worldToIndex = glm::inverse(indexToWorld);
  frame.unitDistance = 2.0 * radius / 100.0;
  return frame;
}

int CoveredPercent(const inr::Image& rgba)
{
  int covered = 0;
  for (std::size_t alpha = 3; alpha < rgba.pixels.size(); alpha += 4) {
    covered += rgba.pixels[alpha] > 0.01f ? 1 : 0;
  }
  return 100 * covered / (PictureSize * PictureSize);
}

void View(const char* modelFile, const char* pictureFile)
{
  const inr::ModelPointer model = inr::ReadModel(modelFile);
  inr::Renderer renderer(model);
  renderer.setTransferFunction(Colours(model->volume));
  inr::Image rgba;
  inr::Image depth;
  const inr::FrameStatistics frame = renderer.render(Look(model->volume), rgba, &depth);
  inr::WriteExr(pictureFile, rgba, depth);
  std::printf("%s: %d %% covered, %.2f s on %s\n", pictureFile, CoveredPercent(rgba), frame.seconds,
              renderer.kernel().c_str());
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s MODEL.inr PICTURE.exr\n", argv[0]);
    return 2;
  }
  try {
    View(argv[1], argv[2]);
  } catch (const std::exception& error) { // inr::Error, or no memory
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
