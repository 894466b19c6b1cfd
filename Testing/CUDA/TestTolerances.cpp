// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures by kernels with a tolerance: levels and distances of samples are chosen by Core, and
// followed on the device.
#include "Testing/CUDA/SmallCache.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Render/FieldCells.h"

namespace test::tolerances {

/// Values of the network there, x fastest.
std::vector<float> Voxels(const inr::ModelPointer& model)
{
  const glm::i64vec3 dims = model->volume.dims;
  std::vector<glm::vec3> places;
  for (std::int64_t k = 0; k < dims.x * dims.y * dims.z; ++k) {
    const glm::i64vec3 at = inr::GridPlace(k, dims);
    places.push_back((glm::dvec3(at) + 0.5) / glm::dvec3(dims));
  }
  std::vector<float> values(places.size());
  inr::MakeEvaluator(model)->evaluate(places.data(), static_cast<std::int64_t>(places.size()),
                                      values.data());
  return values;
}

class DrawingByTolerance : public InAPlace
{};

INSTANTIATE_TEST_SUITE_P(Kernels, DrawingByTolerance, testing::Values(Place::Host, Place::Gpu),
                         InAPlace::nameOf);

/// Hardly bent between voxels, other than what is trained in moments; from 0 to about 0.9.
const inr::ModelPointer& SmoothModel()
{
  static const inr::ModelPointer smooth = [] {
    inr::Description description = SmallDescription();
    description.grid.levels = 1;
    description.grid.baseResolution = 2;
    description.network.hiddenLayers = 1;
    const auto model = CalmModel(description);
    const inr::LayerShape last = inr::Layout(description).layers.back();
    float* const weights = model->parameters.data() + last.offset;
    const auto count = std::ptrdiff_t{last.rows} * last.columns;
    std::transform(weights, weights + count, weights,
                   [](float weight) { return std::abs(weight); });
    model->volume.dims = {64, 56, 48};
    std::vector<float> voxels = Voxels(model);
    const float largest = *std::max_element(voxels.begin(), voxels.end());
    std::transform(weights, weights + count, weights,
                   [&](float weight) { return 0.9f / largest * weight; });
    voxels = Voxels(model);
    model->macroCells = CellsOf(
        [&](const glm::vec3& u) {
          const glm::i64vec3 at = glm::vec3(model->volume.dims) * u;
          return voxels[static_cast<std::size_t>(at.x + model->volume.dims.x *
                                                            (at.y + model->volume.dims.y * at.z))];
        },
        model->volume.dims, 16);
    return inr::ModelPointer(model);
  }();
  return smooth;
}

inr::Frame FrameWith(double tolerance)
{
  inr::Frame frame = Oblique(glm::dvec3(SmoothModel()->volume.dims), 24);
  frame.errorTolerance = tolerance;
  frame.unitDistance = 8;
  return frame;
}

inr::TransferFunction Glow()
{
  inr::TransferFunction colours;
  colours.table = {{0.1f, 0.2f, 1, 0.1f}, {0.2f, 0.6f, 0.8f, 0.2f}, {1, 0.3f, 0, 0.4f}};
  return colours;
}

inr::Renderer SmoothRenderer(const inr::RendererOptions& options)
{
  inr::Renderer renderer(SmoothModel(), options);
  renderer.setTransferFunction(Glow());
  return renderer;
}

Drawn DrawSmooth(const inr::Frame& frame, const inr::RendererOptions& options)
{
  inr::Renderer renderer = SmoothRenderer(options);
  Drawn drawn;
  drawn.statistics = renderer.render(frame, drawn.rgba);
  EXPECT_FALSE(renderer.acceleratorFailure()) << renderer.acceleratorFailure()->reason;
  return drawn;
}

TEST_P(DrawingByTolerance, GivesThePicturesOfTheCpu)
{
  const Drawn exact = DrawSmooth(FrameWith(0), OptionsWith(DeviceIn(GetParam())));
  for (const double tolerance : {2., 6., 20.}) {
    SCOPED_TRACE(tolerance);
    const Drawn truth = DrawSmooth(FrameWith(tolerance), OptionsWith(nullptr));
    const Drawn drawn = DrawSmooth(FrameWith(tolerance), OptionsWith(DeviceIn(GetParam())));
    std::cout << drawn.statistics.samples << " of " << exact.statistics.samples << " samples, "
              << inr::ImagePsnr(drawn.rgba, truth.rgba) << " dB\n";
    EXPECT_TRUE(drawn.statistics.accelerated);
    EXPECT_TRUE(drawn.statistics.complete);
    EXPECT_GE(inr::ImagePsnr(drawn.rgba, truth.rgba), 60);
    EXPECT_EQ(drawn.statistics.samples, truth.statistics.samples + truth.statistics.hidden);
    EXPECT_LT(drawn.statistics.samples, exact.statistics.samples);
    EXPECT_EQ(drawn.statistics.levels.coarsest, truth.statistics.levels.coarsest);
    EXPECT_LE(255 * LargestDifference(drawn.rgba, exact.rgba), tolerance);
    EXPECT_GT(drawn.statistics.work.networkSamples, 0); // to choose
  }
}

/// Among translucent surfaces, and in a part of the volume, too.
TEST_P(DrawingByTolerance, GoesInParts)
{
  const auto piece = [](inr::Frame& frame) { frame.piece = {PlaneAcross({0.1, 1, 0.4})}; };
  for (const Case& kind : {Case{"Layered", AddLayers}, Case{"Piece", piece}}) {
    SCOPED_TRACE(kind.name);
    inr::Frame frame = FrameWith(8);
    kind.change(frame);
    const Drawn drawn = DrawSmooth(frame, OptionsWith(DeviceIn(GetParam())));
    EXPECT_TRUE(drawn.statistics.accelerated);
    EXPECT_GE(inr::ImagePsnr(drawn.rgba, DrawSmooth(frame, OptionsWith(nullptr)).rgba), 60);
  }
}

/// Rays that wait go on among the cells that were chosen for them.
TEST_P(DrawingByTolerance, ComesToTheSamePictureInTimeAndInLittleRoom)
{
  inr::Frame frame = FrameWith(6);
  frame.width = 16;
  frame.height = 12;
  const Drawn truth = DrawSmooth(frame, RoomFor(GetParam(), 0));
  EXPECT_EQ(DrawSmooth(frame, RoomFor(GetParam(), 60)).rgba.pixels, truth.rgba.pixels);
  for (const std::int64_t bricks : {0, 60}) {
    inr::RendererOptions options = RoomFor(GetParam(), bricks);
    options.cache.maximumRequests = 15;
    options.deterministic = true;
    inr::Renderer renderer = SmoothRenderer(options);
    frame.timeLimit = 1e-3;
    int calls = 0;
    EXPECT_EQ(Finish(renderer, frame, calls).pixels, truth.rgba.pixels) << bricks;
    EXPECT_GT(calls, 1);
    EXPECT_LT(calls, 1000);
    frame.timeLimit = 0;
  }
}

/// A choice is for its colours, its tolerance and its view.
TEST_P(DrawingByTolerance, FollowsWhatItIsChosenFor)
{
  inr::Renderer renderer = SmoothRenderer(OptionsWith(DeviceIn(GetParam())));
  inr::TransferFunction colours = Glow();
  for (const double tolerance : {1., 16., 4.}) {
    for (glm::vec4& color : colours.table) {
      color = {color.y, color.z, color.x, 0.9f * color.w};
    }
    inr::Frame frame = FrameWith(tolerance);
    frame.width = 20 + static_cast<int>(tolerance);
    inr::Renderer fresh = SmoothRenderer(OptionsWith(DeviceIn(GetParam())));
    inr::Image pictures[2];
    for (inr::Renderer* one : {&renderer, &fresh}) {
      one->setTransferFunction(colours);
      EXPECT_TRUE(one->render(frame, pictures[one == &fresh]).accelerated);
    }
    EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
  }
}

} // namespace test::tolerances
