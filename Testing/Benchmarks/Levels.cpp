// SPDX-License-Identifier: BSD-3-Clause
//
// What coarse voxels cost and show as means of 2 x 2 x 2 points of the field, and as its values at
// their centres.
//
//   bench_levels MODEL.inr NAME      prints one JSON object per line
//
// levels.py writes the result file.
#include "Core/Image/Metrics.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Model/ModelFile.h"
#include "Core/Random.h"
#include "Testing/Benchmarks/FrameScenes.h"
#include "Testing/Benchmarks/VoxelField.h"

#include <cmath>
#include <ctime>

namespace {

constexpr double PlacesPerVoxel[] = {2, 2.5, 3, 4, 5}; ///< that the field tells apart, per axis
constexpr std::int64_t Places = 200000;

/// A field of which nobody knows how fine it is: its coarse voxels are means.
class OfUnknownResolution : public inr::Evaluator
{
public:
  explicit OfUnknownResolution(std::shared_ptr<const inr::Evaluator> field)
      : Field(std::move(field))
  {}

  void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
  {
    this->Field->evaluate(positions, count, values);
  }
  void evaluateGrid(const std::vector<float> (&axes)[3], float* values) const override
  {
    this->Field->evaluateGrid(axes, values);
  }
  std::string kernel() const override { return this->Field->kernel(); }

private:
  std::shared_ptr<const inr::Evaluator> Field;
};

/// A field's voxels, each the mean of points^3, and what is linear between them.
VoxelField VoxelsOf(const inr::Evaluator& field, const glm::i64vec3& dims, int points)
{
  const glm::i64vec3 all = dims * std::int64_t{points};
  std::vector<float> axes[3];
  for (int axis = 0; axis < 3; ++axis) {
    for (std::int64_t k = 0; k < all[axis]; ++k) {
      const double u = (static_cast<double>(k) + 0.5) / static_cast<double>(all[axis]);
      axes[axis].push_back(static_cast<float>(u));
    }
  }
  std::vector<float> samples(static_cast<std::size_t>(all.x * all.y * all.z));
  field.evaluateGrid(axes, samples.data());
  std::vector<float> means(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const auto row = static_cast<std::int64_t>(k) / all.x;
    const glm::i64vec3 at =
        glm::i64vec3(static_cast<std::int64_t>(k) % all.x, row % all.y, row / all.y) /
        std::int64_t{points};
    means[static_cast<std::size_t>(at.x + dims.x * (at.y + dims.y * at.z))] +=
        samples[k] / static_cast<float>(points * points * points);
  }
  return {dims, std::move(means)};
}

/// How near voxels are to the field between them: dB of the value range.
double Nearness(const inr::Evaluator& field, const inr::Evaluator& voxels)
{
  std::vector<glm::vec3> places;
  for (std::uint64_t k = 0; k < 3 * Places; k += 3) {
    places.emplace_back(inr::RandomUnit(1, k), inr::RandomUnit(1, k + 1),
                        inr::RandomUnit(1, k + 2));
  }
  std::vector<float> truth(places.size());
  std::vector<float> found(places.size());
  field.evaluate(places.data(), Places, truth.data());
  voxels.evaluate(places.data(), Places, found.data());
  double squares = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    squares += std::pow(found[k] - truth[k], 2);
  }
  return -10 * std::log10(squares / static_cast<double>(Places));
}

void MeasureVoxels(const inr::Evaluator& field, const std::string& name)
{
  for (const double places : PlacesPerVoxel) {
    const glm::i64vec3 dims(glm::round(glm::dvec3(field.resolution()) / places));
    for (const int points : {1, 2}) {
      std::ostringstream text;
      text << (points == 1 ? "centres, " : "means, ") << places << " places a voxel, " << name;
      Report(text.str(), Nearness(field, VoxelsOf(field, dims, points)), "dB", "higher");
    }
  }
}

/// The first complete picture of a renderer that has decoded nothing.
struct First
{
  First(const std::shared_ptr<const inr::Evaluator>& field, const inr::ModelPointer& model,
        const Look& look, const inr::Frame& frame)
  {
    inr::Renderer renderer(field, model->volume, model->macroCells, Unrounded());
    renderer.setTransferFunction(look.function);
    const std::clock_t start = std::clock();
    this->points = renderer.render(frame, this->picture).work.bricks.points;
    this->seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  }
  inr::Image picture;
  std::int64_t points;
  double seconds;
};

/// Of a volume of so many times the model's voxels along each axis.
void MeasurePictures(const inr::ModelPointer& source, const std::string& name, int times)
{
  const inr::ModelPointer model = Scaled(source, source->volume.dims * std::int64_t{times});
  const std::shared_ptr<const inr::Evaluator> field = inr::MakeEvaluator(model);
  const auto unknown = std::make_shared<OfUnknownResolution>(field);
  inr::Frame frame = View(model->volume);
  frame.sampleDistance = 0.5;
  inr::Frame finest = frame;
  finest.levelOfDetailScale = 0;
  for (const Look& look : Looks(model->volume)) {
    const First means(unknown, model, look, frame);
    const First centres(field, model, look, frame);
    if (centres.points == means.points) {
      continue; // all of it is of level 0
    }
    const inr::Image truth = First(field, model, look, finest).picture;
    const std::string scene = look.name + ", " + name + " times " + std::to_string(times);
    Report("first picture by centres, points, " + scene,
           static_cast<double>(centres.points) / static_cast<double>(means.points), "", "lower",
           ", \"baseline\": \"by means\"");
    Report("first picture by centres, time, " + scene, centres.seconds / means.seconds, "", "lower",
           ", \"baseline\": \"by means\"");
    Report("picture by centres, " + scene, inr::ImagePsnr(centres.picture, truth), "dB", "higher");
    Report("picture by means, " + scene, inr::ImagePsnr(means.picture, truth), "dB", "higher");
  }
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 3) {
    std::cerr << "usage: bench_levels MODEL.inr NAME\n";
    return 2;
  }
  try {
    const inr::ModelPointer model = inr::ReadModel(argv[1]);
    MeasureVoxels(*inr::MakeEvaluator(model), argv[2]);
    for (const int times : {1, 2, 4}) {
      MeasurePictures(model, argv[2], times);
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
