// SPDX-License-Identifier: BSD-3-Clause
//
// Volumes and cameras of extreme size, place and shape: the light of a linear field in a
// homogeneous medium is known in closed form along every ray.
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace test::extreme_cameras {

/// A volume and a camera, whose places are from the middle of the volume's bounds on: no digit of
/// the truth is lost to where that is.
struct View
{
  std::string name;
  glm::i64vec3 dims{33, 37, 41};
  glm::dvec3 spacing{1, 1, 1};
  glm::dvec3 middle{0, 0, 0}; ///< of the bounds, world
  glm::dvec3 eye{60, 50, 70};
  glm::dvec3 target{0, 0, 0};
  double angle = 40; ///< degrees of the vertical field of view, 0: a parallel view
  double height = 0; ///< of a parallel view
  double near = 1;
  double far = 1000;

  glm::dvec3 extent() const
  {
    return glm::max(glm::dvec3(this->dims - std::int64_t{1}),
                    glm::dvec3(glm::equal(this->dims, glm::i64vec3(1)))) *
           this->spacing;
  }
};

constexpr int Width = 7; // odd: the middle pixel looks along the camera's axis
constexpr int Height = 5;
constexpr double Depths = 2; ///< optical, along the longest ray

/// The camera's axes: right, up and backwards.
glm::dmat3 AxesOf(const View& view)
{
  const glm::dvec3 back = glm::normalize(view.eye - view.target);
  const glm::dvec3 up = std::abs(back.y) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(up, back));
  return {right, glm::cross(back, right), back};
}

/// The part of a pixel's line that is inside the volume and between the camera's planes.
struct Chord
{
  glm::dvec3 from;
  glm::dvec3 direction;
  double begin;
  double end;

  double length() const { return std::max(this->end - this->begin, 0.0); }
};

Chord ChordOf(const View& view, int x, int y)
{
  const glm::dmat3 axes = AxesOf(view);
  const glm::dvec2 place((2 * (x + 0.5) / Width - 1) * Width / Height, 2 * (y + 0.5) / Height - 1);
  Chord chord{view.eye, -axes[2], view.near, view.far};
  if (view.angle > 0) {
    chord.direction +=
        std::tan(glm::radians(0.5 * view.angle)) * (place.x * axes[0] + place.y * axes[1]);
    const double longer = glm::length(chord.direction);
    chord.direction /= longer;
    chord.begin *= longer;
    chord.end *= longer;
  } else {
    chord.from += 0.5 * view.height * (place.x * axes[0] + place.y * axes[1]);
  }
  const glm::dvec3 half = 0.5 * view.extent();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (-half[axis] - chord.from[axis]) / chord.direction[axis];
    const double b = (half[axis] - chord.from[axis]) / chord.direction[axis];
    if (chord.direction[axis] != 0) {
      chord.begin = std::max(chord.begin, std::min(a, b));
      chord.end = std::min(chord.end, std::max(a, b));
    } else if (std::abs(chord.from[axis]) > half[axis]) {
      chord.end = chord.begin;
    }
  }
  return chord;
}

double LongestChord(const View& view)
{
  double longest = 0;
  for (int k = 0; k < Width * Height; ++k) {
    longest = std::max(longest, ChordOf(view, k % Width, k / Width).length());
  }
  return longest;
}

inr::Frame FrameOf(const View& view)
{
  inr::Frame frame;
  frame.width = Width;
  frame.height = Height;
  const double aspect = static_cast<double>(Width) / Height;
  const double half = 0.5 * view.height;
  const glm::dmat4 projection =
      view.angle > 0 ? glm::perspective(glm::radians(view.angle), aspect, view.near, view.far)
                     : glm::ortho(-half * aspect, half * aspect, -half, half, view.near, view.far);
  const glm::dmat4 look =
      glm::lookAt(view.middle + view.eye, view.middle + view.target, AxesOf(view)[1]);
  frame.clipToWorld = glm::inverse(projection * look);
  glm::dmat4 indexToWorld(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    indexToWorld[axis][axis] = view.spacing[axis];
    indexToWorld[3][axis] =
        view.middle[axis] - 0.5 * static_cast<double>(view.dims[axis] - 1) * view.spacing[axis];
  }
  frame.worldToIndex = glm::inverse(indexToWorld);
  const double longest = LongestChord(view);
  const double shortest = std::min({view.spacing.x, view.spacing.y, view.spacing.z});
  frame.sampleDistance = std::clamp(longest / 4000 / shortest, 0.001, 1e6);
  frame.unitDistance = longest;
  frame.levelOfDetailScale = 0;
  frame.adaptiveSampling = false;
  return frame;
}

/// A field that rises along all axes by different amounts, over the unit cube.
const glm::dvec3 Slopes(0.5, 0.3, 0.15);
float Linear(const glm::vec3& u) { return glm::dot(glm::vec3(Slopes), u); }

/// Light (red, whose source is the value) and opacity of a pixel; `sigma`: extinction.
glm::dvec2 Truth(const View& view, double sigma, int x, int y)
{
  const Chord chord = ChordOf(view, x, y);
  const glm::dvec3 rises(glm::greaterThan(view.dims, glm::i64vec3(1)));
  const glm::dvec3 perWorld = rises * Slopes / (view.spacing * glm::dvec3(view.dims));
  const double value = 0.5 * (Slopes.x + Slopes.y + Slopes.z) +
                       glm::dot(perWorld, chord.from + chord.begin * chord.direction);
  const double slope = glm::dot(perWorld, chord.direction);
  const double length = chord.length();
  const double passes = std::exp(-sigma * length);
  return {value * (1 - passes) + slope * ((1 - passes) / sigma - length * passes), 1 - passes};
}

void PrintTo(const View& view, std::ostream* stream) { *stream << view.name; }

/// A few, of all values; with some of them, where they are seen is looked for first.
inr::MacroCells CellsOf(const glm::i64vec3& dims)
{
  const std::int64_t longest = std::max({dims.x, dims.y, dims.z});
  inr::MacroCells cells =
      inr::MakeMacroCells(dims, static_cast<int>(std::max<std::int64_t>(4, longest / 4)));
  cells.provenance = inr::MacroCellProvenance::Decoded;
  std::fill(cells.ranges.begin(), cells.ranges.end(), inr::ValueRange{0, 1});
  return cells;
}

class ExtremeCameras : public testing::TestWithParam<View>
{
protected:
  void expectTruth(bool cached) const
  {
    const View& view = this->GetParam();
    inr::Renderer renderer = FieldRenderer(view.dims, Linear, CellsOf(view.dims), 1, cached);
    inr::TransferFunction function = UniformMedium(static_cast<float>(1 - std::exp(-Depths)));
    function.table[0] = glm::vec4(0, 0, 0, function.table[0].w);
    renderer.setTransferFunction(function);
    inr::Image image;
    renderer.render(FrameOf(view), image);
    const double sigma = Depths / LongestChord(view);
    double seen = 0;
    for (int y = 0; y < Height; ++y) {
      for (int x = 0; x < Width; ++x) {
        const glm::dvec2 truth = Truth(view, sigma, x, y);
        EXPECT_NEAR(image.pixel(x, y)[3], truth.y, 3e-4) << x << " " << y << " " << cached;
        EXPECT_NEAR(image.pixel(x, y)[0], truth.x, 3e-4) << x << " " << y << " " << cached;
        seen = std::max(seen, truth.y);
      }
    }
    EXPECT_GT(seen, 0.5); // the view shows something
  }
};

TEST_P(ExtremeCameras, ShowTheLightOfALinearField)
{
  this->expectTruth(false);
  this->expectTruth(true);
}

/// A view of a volume that differs from the usual one in its spacing by `scale` in all.
View Scaled(const std::string& name, double scale)
{
  View view;
  view.name = name;
  view.spacing *= scale;
  view.eye *= scale;
  view.near *= scale;
  view.far *= scale;
  return view;
}

View Shaped(const std::string& name, const glm::i64vec3& dims, const glm::dvec3& spacing)
{
  View view;
  view.name = name;
  view.dims = dims;
  view.spacing = spacing;
  const double size = glm::length(view.extent());
  view.eye = size * glm::dvec3(0.8, 0.6, 1.1);
  view.near = 0.1 * size;
  view.far = 10 * size;
  return view;
}

/// Into a long volume from above, from as near as it is wide.
View Close(View view, const glm::dvec3& eye, const glm::dvec3& target)
{
  view.name += "Close";
  view.eye = eye;
  view.target = target;
  view.near = 0.01 * glm::length(eye - target);
  return view;
}

View From(const std::string& name, const glm::dvec3& eye, const glm::dvec3& target,
          double angle = 40, double near = 1e-3)
{
  View view;
  view.name = name;
  view.eye = eye;
  view.target = target;
  view.angle = angle;
  view.near = near;
  return view;
}

View Far(const std::string& name, const glm::dvec3& direction)
{
  View view = From(name, direction * 1e6 * 64.0, {0, 0, 0}, 60e-6);
  view.near = glm::length(view.eye) - 64;
  view.far = glm::length(view.eye) + 64;
  return view;
}

View Moved(View view, const std::string& name, const glm::dvec3& middle)
{
  view.name = name;
  view.middle = middle;
  return view;
}

View Parallel(const std::string& name, const glm::dvec3& eye, double height, double near)
{
  View view = From(name, eye, {0, 0, 0}, 0, near);
  view.height = height;
  return view;
}

INSTANTIATE_TEST_SUITE_P(
    Volumes, ExtremeCameras,
    testing::Values(Scaled("SpacingOf1em12", 1e-12), Scaled("SpacingOf1e12", 1e12),
                    Moved(View(), "AwayBy1e9", {1e9, -1e9, 1e9}),
                    Moved(Scaled("", 0.01), "FineAndAwayBy1e8", {1e8, -1e8, 1e8}),
                    Shaped("Flat", {33, 37, 41}, {1, 1, 1e-5}),
                    Shaped("Thin", {33, 37, 41}, {1e5, 1, 1}),
                    Close(Shaped("Thin", {33, 37, 41}, {1e5, 1, 1}), {100, 60, 50}, {0, 0, 0}),
                    Shaped("Slab", {33, 1, 41}, {1, 1, 1}), Shaped("Point", {1, 1, 1}, {2, 3, 1}),
                    Shaped("OfTwo", {2, 2, 2}, {1, 1, 1}), Shaped("Sheet", {1, 2, 41}, {1, 1, 1}),
                    Shaped("OfPrimes", {31, 53, 7}, {1, 1, 1}),
                    Shaped("Long", {131072, 2, 3}, {1, 1, 1}),
                    Close(Shaped("Long", {131072, 2, 3}, {1, 1, 1}), {65530, 1, 4}, {65533, 0, 0}),
                    Shaped("Wide", {131072, 131072, 1}, {1, 1, 1})),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Cameras, ExtremeCameras,
    testing::Values(From("Inside", {3, -2, 5}, {9, 4, 1}), From("OnAFace", {16, 2, 3}, {0, 0, 0}),
                    From("OnAFaceLookingAlongIt", {16, 2, 3}, {16, 2, -3}),
                    From("OnAnEdge", {16, 18, 3}, {0, 0, 0}),
                    From("OnACorner", {16, 18, 20}, {0, 0, 0}), Far("FarAway", {0, 0, 1}),
                    Far("FarAwayAskew", {0.48, 0.6, 0.64}),
                    From("AlongAnAxis", {0, 0, 60}, {0, 0, 0}),
                    From("AlongAFace", {0, 18, 60}, {0, 18, 0}),
                    From("NarrowView", {60, 50, 70}, {0, 0, 0}, 0.01),
                    From("WideView", {30, 3, 2}, {0, 0, 0}, 179),
                    From("WideViewInside", {3, -2, 5}, {9, 4, 1}, 179),
                    From("CutByTheNearPlane", {60, 50, 70}, {0, 0, 0}, 40, 103),
                    Parallel("ParallelAlongAnAxis", {0, 0, 100}, 40, 1),
                    Parallel("ParallelAskew", {60, 50, 70}, 60, 1),
                    Parallel("ParallelCut", {60, 50, 70}, 60, 100)),
    [](const auto& info) { return info.param.name; });

} // namespace test::extreme_cameras
