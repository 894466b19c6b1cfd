// SPDX-License-Identifier: BSD-3-Clause
//
// Only what a scene requires: what a frame must not do.
#include "Testing/Core/Render/RecordingField.h"

#include <set>
#include <tuple>

namespace test::work_spared {

constexpr std::int64_t Stride = 8; // of bricks of 9 voxels

/// Places along x or y of the bricks of level 0 that the field was asked for.
std::set<std::int64_t> BricksAlong(const RecordedScene& scene, int axis)
{
  std::set<std::int64_t> places;
  for (const RecordingField::Box& box : scene.field->layers(0)) {
    places.insert(std::lround(box.low[axis]) / Stride);
  }
  return places;
}

/// Voxels along z of the layers of level 0 that the field was asked for, in bricks between two
/// voxels along x.
std::set<std::int64_t> Layers(const RecordedScene& scene, double low = 0, double high = 72)
{
  std::set<std::int64_t> places;
  for (const RecordingField::Box& box : scene.field->layers(0)) {
    if (box.low.x > low - 0.5 && box.high.x < high + 0.5) {
      places.insert(std::lround(box.low.z));
    }
  }
  return places;
}

std::set<std::int64_t> From(std::int64_t first, std::int64_t last)
{
  std::set<std::int64_t> places;
  for (std::int64_t k = first; k <= last; ++k) {
    places.insert(k);
  }
  return places;
}

/// The whole of a volume of 73^3 voxels, 9 bricks along each axis, along +z.
inr::Frame FromBelow(const glm::dvec2& low = {0, 0}, const glm::dvec2& high = {72, 72})
{
  inr::Frame frame = ParallelFrame(80, low, high, -10, 100);
  frame.levelOfDetailScale = 0;
  return frame;
}

constexpr glm::i64vec3 Cube(73, 73, 73);

TEST(WorkSpared, NoGradientsWithoutShading)
{
  for (const bool cached : {false, true}) {
    RecordedScene scene(SmallBricks(cached));
    EXPECT_EQ(scene.render(Oblique(glm::dvec3(scene.dims))).gradients, 0);
    EXPECT_EQ(scene.render(PathView(scene.dims)).gradients, 0);
    EXPECT_GT(scene.render(ShadedView(scene.dims)).gradients, 0);
  }
}

TEST(WorkSpared, NoBrickOutsideTheView)
{
  RecordedScene scene(SmallBricks(), Waves, Cube);
  scene.renderer.setTransferFunction(UniformMedium(1e-4f));
  scene.render(FromBelow({20.5, 33}, {39.5, 47.9}));
  EXPECT_EQ(BricksAlong(scene, 0), From(2, 4));
  EXPECT_EQ(BricksAlong(scene, 1), From(4, 5));
  EXPECT_EQ(Layers(scene), From(0, 72));
}

TEST(WorkSpared, NoBrickBehindTheCameraOrAPlane)
{
  for (const bool planes : {false, true}) {
    RecordedScene scene(SmallBricks(), Waves, Cube);
    scene.renderer.setTransferFunction(UniformMedium(1e-4f));
    inr::Frame frame = FromBelow();
    if (planes) {
      frame.clippingPlanes = {{0, 0, 1, -30.5}, {0, 0, -1, 60.5}};
    } else {
      frame = ParallelFrame(80, {0, 0}, {72, 72}, 30.5, 60.5);
      frame.levelOfDetailScale = 0;
    }
    scene.render(frame);
    EXPECT_EQ(Layers(scene), From(24, 64)) << planes;
  }
}

TEST(WorkSpared, NoBrickOfTransparentSpace)
{
  const auto ramp = [](const glm::vec3& u) { return u.x; };
  inr::MacroCells cells = inr::MakeMacroCells(Cube, 8);
  cells.apron = 1.0 / glm::dvec3(Cube);
  for (std::size_t k = 0; k < cells.ranges.size(); ++k) {
    const auto x = static_cast<double>(static_cast<std::int64_t>(k) % cells.dims.x);
    cells.ranges[k] = {static_cast<float>((8 * x - 1.5) / 73),
                       static_cast<float>((8 * x + 9.5) / 73)};
  }
  RecordedScene scene(SmallBricks(), ramp, Cube, cells);
  inr::TransferFunction function = UniformMedium(0);
  function.table.resize(74, function.table[0]);
  function.table[73 - 18].w = 1e-3f; // seen between 1/73 on either side of x = 55 / 73
  scene.renderer.setTransferFunction(function);
  scene.render(FromBelow());
  EXPECT_EQ(BricksAlong(scene, 0), From(6, 7));
  EXPECT_EQ(BricksAlong(scene, 1), From(0, 8));
}

TEST(WorkSpared, NoBrickAtAllWhereNothingCanBeSeen)
{
  for (const auto& view : {FromBelow(), PathView(Cube)}) {
    RecordedScene scene(SmallBricks(), Waves, Cube);
    scene.renderer.setTransferFunction(UniformMedium(0));
    scene.render(view);
    EXPECT_TRUE(scene.field->layers(0).empty());
    EXPECT_EQ(scene.statistics.samples, 0);
  }
}

TEST(WorkSpared, NoBrickBehindOpaqueGeometry)
{
  RecordedScene scene(SmallBricks(), Waves, Cube);
  scene.renderer.setTransferFunction(UniformMedium(1e-4f));
  inr::Frame frame = FromBelow();
  const std::vector<float> depth(std::size_t{80} * 80, (30.5f + 10) / 110);
  frame.opaqueDepth = depth.data();
  scene.render(frame);
  EXPECT_EQ(Layers(scene), From(0, 32));
}

/// A medium that is opaque within half a voxel from z = 12 on, further on from z = 52 on, for who
/// looks along +z: while rays on one side have not ended, those on the other long have.
struct Wall
{
  explicit Wall(const inr::RendererOptions& options) : scene(options, Field, Cube)
  {
    inr::TransferFunction function;
    function.table = {glm::vec4(1, 1, 1, 1e-4f), glm::vec4(1, 1, 1, 1)};
    this->scene.renderer.setTransferFunction(function);
  }

  static float Field(const glm::vec3& u)
  {
    const glm::vec3 voxel = u * 73.0f - 0.5f;
    return voxel.z < (voxel.x < 40 ? 12 : 52) ? 0.0f : 1.0f;
  }

  /// The last layers that were inferred on either side. Bricks along the edge are needed for
  /// gradients next to it.
  std::int64_t lastOfNear() const { return *Layers(this->scene, 0, 32).rbegin(); }
  std::int64_t lastOfFar() const { return *Layers(this->scene, 40, 72).rbegin(); }

  RecordedScene scene;
};

TEST(WorkSpared, NoBrickBehindAnOpaqueMedium)
{
  for (const bool shaded : {false, true}) {
    SCOPED_TRACE(shaded);
    Wall wall(SmallBricks());
    inr::Frame frame = FromBelow();
    if (shaded) {
      frame.shading = inr::Material{};
      frame.lights = {Headlight()};
    }
    wall.scene.render(frame);
    EXPECT_EQ(wall.lastOfNear(), 16);
    EXPECT_EQ(wall.lastOfFar(), 56);
  }
}

TEST(WorkSpared, NoGradientBehindAnOpaqueMedium)
{
  for (const bool cached : {false, true}) {
    RecordedScene scene(SmallBricks(cached), Waves, Cube);
    scene.renderer.setTransferFunction(UniformMedium(1));
    inr::Frame frame = FromBelow();
    frame.shading = inr::Material{};
    frame.lights = {Headlight()};
    scene.render(frame);
    EXPECT_EQ(scene.render(frame).gradients, 80 * 80) << cached; // of the first sample of each ray
  }
}

/// Views that want each and every brick: a frame of each mode.
std::vector<inr::Frame> Views(const glm::i64vec3& dims)
{
  inr::Frame unlit = ShadedView(dims);
  unlit.shading.reset();
  return {unlit, ShadedView(dims), PathView(dims)};
}

TEST(WorkSpared, NothingIsInferredOfWhatTheCacheHas)
{
  for (const inr::Frame& view : Views({47, 41, 44})) {
    RecordedScene scene(SmallBricks());
    scene.render(view);
    const std::int64_t asked = scene.field->inGrids();
    inr::Frame again = view;
    again.seed = 1; // other samples of the same
    const inr::WorkDone work = scene.render(again);
    EXPECT_EQ(work.networkSamples, 0);
    EXPECT_TRUE(work.bricks == inr::BrickWork{});
    EXPECT_EQ(scene.field->inGrids(), asked);
    EXPECT_EQ(scene.field->scattered(), 0);
  }
}

/// The same view with other colours, lights and opacities, one after the other.
void RenderLooks(RecordedScene& scene, const inr::Frame& view)
{
  scene.renderer.setTransferFunction(UniformMedium(0.01f));
  scene.render(view);
  inr::Frame frame = view;
  frame.lights[0].color = glm::vec3(0.1f, 0.5f, 2.0f);
  frame.lights[0].direction = glm::dvec3(1, 1, -0.2);
  scene.render(frame);
  scene.renderer.setTransferFunction(OpacityRamp(0.02f));
  scene.render(frame);
  scene.renderer.setTransferFunction(UniformMedium(0.3f, glm::vec3(0.4f)));
  scene.render(frame);
  frame.unitDistance *= 3;
  frame.paths.anisotropy = 0.5;
  if (frame.shading) {
    frame.shading->specular = 0.7f;
  }
  scene.render(frame);
}

TEST(WorkSpared, NothingIsInferredForOtherColoursOrLights)
{
  for (const inr::Frame& view : Views({47, 41, 44})) {
    RecordedScene scene(SmallBricks());
    scene.renderer.setTransferFunction(UniformMedium(0.01f));
    scene.render(view);
    if (view.mode == inr::RenderMode::PathTracing) { // which come to other places, each time
      RenderLooks(scene, view);
    }
    const std::int64_t asked = scene.field->inGrids();
    RenderLooks(scene, view);
    EXPECT_EQ(scene.field->inGrids(), asked);
    EXPECT_EQ(scene.field->scattered(), 0);
  }
}

TEST(WorkSpared, ThePicturesOfPathsGoOnWithNothingWhenTheyAreDone)
{
  for (const bool cached : {false, true}) {
    RecordedScene scene(SmallBricks(cached));
    const inr::Frame frame = PathView(scene.dims);
    EXPECT_FALSE(scene.render(frame) == inr::WorkDone{});
    EXPECT_TRUE(scene.render(frame) == inr::WorkDone{});
    EXPECT_TRUE(scene.statistics.complete);
    EXPECT_EQ(scene.statistics.paths, 2);
  }
}

/// To the end, of pictures of the finest level, a few bricks at a time.
void Finish(RecordedScene& scene, inr::Frame frame)
{
  frame.levelOfDetailScale = 0;
  frame.timeLimit = 1;
  for (int k = 0; k < 5000 && (k == 0 || !scene.statistics.complete); ++k) {
    scene.render(frame);
  }
  EXPECT_TRUE(scene.statistics.complete);
}

TEST(WorkSpared, NoLevelOnTheWayThatTakesAsLongAsTheFinest)
{
  for (const inr::Frame& view : Views(Cube)) {
    inr::RendererOptions options = SmallBricks();
    options.deterministic = true;
    RecordedScene scene(options, Waves, Cube);
    Finish(scene, view);
    EXPECT_TRUE(scene.field->layers(1).empty());
    EXPECT_FALSE(scene.field->layers(2).empty());
    RecordedScene whole(options, Waves, Cube);
    inr::Frame frame = view;
    frame.levelOfDetailScale = 0;
    whole.render(frame);
    EXPECT_LT(scene.field->inGrids(), 1.25 * whole.field->inGrids());
  }
}

TEST(WorkSpared, ButWhereTheFinestDoesNotFit)
{
  for (const inr::Frame& view : Views(Cube)) {
    inr::RendererOptions options = SmallBricks();
    options.cache.bytes = 300 * 2 * 9 * 9 * 9; // less than half of the finest level
    options.cache.onlyWhatFits = true;
    RecordedScene scene(options, Waves, Cube);
    Finish(scene, view);
    EXPECT_FALSE(scene.field->layers(1).empty());
    EXPECT_FALSE(scene.field->layers(0).empty());
  }
}

/// One of `count` views around the volume.
inr::Frame Around(inr::Frame frame, const glm::dvec3& dims, int k, int count)
{
  const double angle = 2 * 3.14159265358979 * k / count;
  const glm::dvec3 eye =
      0.5 * dims + 1.5 * glm::length(dims) * glm::dvec3(std::sin(angle), 0.3, std::cos(angle));
  frame.clipToWorld =
      glm::inverse(glm::perspective(glm::radians(30.0), 48.0 / 37, 0.2 * glm::length(dims),
                                    5 * glm::length(dims)) *
                   glm::lookAt(eye, 0.5 * dims, glm::dvec3(0, 1, 0)));
  frame.levelOfDetailScale = 1;
  return frame;
}

TEST(WorkSpared, AnOrbitInfersNothingTheSecondTimeRound)
{
  constexpr int views = 7;
  for (const inr::Frame& view : Views({150, 130, 140})) {
    RecordedScene scene(SmallBricks(), Waves, {150, 130, 140});
    std::int64_t asked = 0;
    for (int k = 0; k < 2 * views; ++k) {
      asked = k == views ? scene.field->inGrids() : asked;
      scene.render(Around(view, glm::dvec3(scene.dims), k % views, views));
      EXPECT_EQ(scene.statistics.missed, 0);
    }
    EXPECT_GT(asked, 0);
    EXPECT_EQ(scene.field->inGrids(), asked);
    EXPECT_EQ(scene.field->scattered(), 0);
  }
}

TEST(WorkSpared, NoBrickThatHasNoRoom)
{
  constexpr std::int64_t bytes = 2 * 9 * 9 * 9; // of a brick
  for (const inr::Frame& view : Views(Cube)) {
    inr::RendererOptions options = SmallBricks();
    options.deterministic = true;
    options.cache.bytes = 60 * bytes; // of hundreds
    RecordedScene scene(options, Waves, Cube);
    std::int64_t came = 0;
    for (int k = 0; k < 12; ++k) {
      inr::Frame frame = Around(view, glm::dvec3(Cube), k, 40);
      frame.timeLimit = 1;
      const inr::WorkDone work = scene.render(frame);
      EXPECT_FALSE(scene.statistics.complete);
      EXPECT_EQ(work.bricks.bytes, bytes * work.bricks.bricks);
      came += work.bricks.bricks;
    }
    EXPECT_GT(came, 30);
  }
}

} // namespace test::work_spared
