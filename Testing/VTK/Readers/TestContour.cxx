// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/GridIndex.h"
#include "MessageCapture.h"
#include "TestModels.h"
#include "Triangles.h"
#include "vtkINRContour.h"
#include "vtkINRDecode.h"
#include "vtkINRReader.h"

#include <vtkCallbackCommand.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace {

/// The ranges of all voxels, as a file that vtkINRWriter has written knows them.
void MeasureCells(inr::Model& model, int edge)
{
  const glm::i64vec3 dims = model.volume.dims;
  std::vector<float> values(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  const auto evaluator = inr::MakeEvaluator(std::make_shared<inr::Model>(model));
  inr::EvaluateLattice(*evaluator, inr::Arena(), inr::VoxelLattice(dims, glm::i64vec3(0), dims),
                       values.data());
  inr::MacroCells cells = inr::MakeMacroCells(dims, edge);
  cells.provenance = inr::MacroCellProvenance::Decoded;
  cells.apron = 1.0 / glm::dvec3(dims);
  const auto touching = [&](std::int64_t voxel, std::int64_t count) {
    return std::pair(std::max<std::int64_t>(voxel - 1, 0) / edge,
                     std::min((voxel + 1) / edge, count - 1));
  };
  std::size_t index = 0;
  for (std::int64_t z = 0; z < dims.z; ++z) {
    for (std::int64_t y = 0; y < dims.y; ++y) {
      for (std::int64_t x = 0; x < dims.x; ++x, ++index) {
        const auto [x0, x1] = touching(x, cells.dims.x);
        const auto [y0, y1] = touching(y, cells.dims.y);
        const auto [z0, z1] = touching(z, cells.dims.z);
        for (std::int64_t k = z0; k <= z1; ++k) {
          for (std::int64_t j = y0; j <= y1; ++j) {
            for (std::int64_t i = x0; i <= x1; ++i) {
              auto& range = cells.ranges[static_cast<std::size_t>(cells.index(i, j, k))];
              range.extend(inr::NormalisedOutput(values[index]));
            }
          }
        }
      }
    }
  }
  model.macroCells = cells;
}

/// A field that falls off from 1 in the middle to 0 at half the size, by the sum of coordinates:
/// linear between the points of a dense lattice, which the network passes on. Its isosurfaces are
/// octahedra but for what interpolation adds.
std::shared_ptr<inr::Model> MakeBall(const glm::i64vec3& dims)
{
  inr::Description description;
  description.grid.type = inr::GridType::Dense;
  description.grid.levels = 1;
  description.grid.features = 1;
  description.grid.baseResolution = 16; // lattice point p stands at u = (p - 0.5)/15
  description.network.hiddenLayers = 0;
  auto model = MakeModel(dims);
  model->description = description;
  const inr::Layout layout(description);
  model->parameters.assign(layout.parameterCount, 0.0f);
  model->parameters[layout.layers[0].offset] = 1.0f;
  for (std::uint32_t z = 0; z < 16; ++z) {
    for (std::uint32_t y = 0; y < 16; ++y) {
      for (std::uint32_t x = 0; x < 16; ++x) {
        const glm::dvec3 way = glm::abs(glm::dvec3(x, y, z) - 8.0) / 15.0;
        const std::uint32_t entry =
            inr::GridIndex(layout.levels[0], description.grid.hash, x, y, z);
        model->parameters[layout.gridOffset + entry] =
            static_cast<float>(std::max(0.0, 1 - 2 * (way.x + way.y + way.z)));
      }
    }
  }
  model->volume.low = 0;
  model->volume.high = 1;
  return model;
}

/// Of the field above, along an axis and in the unit cube.
double BallRadius(double value) { return (1 - value) / 2; }

class Contour : public testing::Test
{
protected:
  void connect(const inr::Model& model)
  {
    const std::string path = this->Folder / "model.inr";
    inr::WriteModel(model, path);
    this->Reader->SetFileName(path.c_str());
    this->Reader->Modified(); // the file may have the name of the one before
    this->Filter->SetInputConnection(this->Reader->GetOutputPort());
  }

  vtkPolyData* update()
  {
    this->Filter->Update();
    return this->Filter->GetOutput();
  }

  /// What VTK's own filter makes of the decoded voxels.
  vtkPolyData* reference(int level, const std::vector<double>& values)
  {
    this->Voxels->SetInputConnection(this->Reader->GetOutputPort());
    this->Voxels->SetLevel(level);
    this->Voxels->SetScalarType(VTK_DOUBLE);
    this->Stock->SetInputConnection(this->Voxels->GetOutputPort());
    this->Stock->SetNumberOfContours(0);
    for (const double value : values) {
      this->Stock->SetValue(this->Stock->GetNumberOfContours(), value);
    }
    this->Stock->Update();
    return this->Stock->GetOutput();
  }

  void expectSame(vtkPolyData* ours, vtkPolyData* theirs)
  {
    ASSERT_GT(theirs->GetNumberOfCells(), 0);
    ASSERT_EQ(ours->GetNumberOfPoints(), theirs->GetNumberOfPoints());
    ASSERT_EQ(ours->GetNumberOfCells(), theirs->GetNumberOfCells());
    ASSERT_EQ(OpenEdges(ours), OpenEdges(theirs));
    const std::vector<Triangle> mine = TrianglesOf(ours);
    const std::vector<Triangle> stock = TrianglesOf(theirs);
    // Points round differently, so that neighbours in the order may swap: look around.
    std::size_t found = 0;
    for (std::size_t k = 0; k < mine.size(); ++k) {
      const std::size_t last = std::min(stock.size(), k + 8);
      for (std::size_t other = k > 8 ? k - 8 : 0; other < last; ++other) {
        float distance = 0;
        for (std::size_t corner = 0; corner < 3; ++corner) {
          distance += glm::length(mine[k][corner] - stock[other][corner]);
        }
        if (distance < 1e-3f) {
          ++found;
          break;
        }
      }
    }
    EXPECT_GE(found, mine.size() * 98 / 100);
    this->expectSameAtPoints(ours, theirs);
  }

  /// The network has the isovalue at every point of the surface.
  void expectFieldIs(const inr::Model& model, vtkPolyData* surface, double value)
  {
    const Truth truth(std::make_shared<inr::Model>(model));
    const inr::VolumeInfo& volume = model.volume;
    for (vtkIdType k = 0; k < surface->GetNumberOfPoints(); ++k) {
      glm::dvec3 world;
      surface->GetPoint(k, &world.x);
      const glm::dvec3 index = glm::inverse(volume.direction) * (world - volume.origin);
      const glm::dvec3 u = (index / volume.spacing + 0.5) / glm::dvec3(volume.dims);
      ASSERT_NEAR(truth(u), value, 1e-6);
    }
  }

  void expectSameAtPoints(vtkPolyData* ours, vtkPolyData* theirs)
  {
    std::vector<vtkIdType> order[2];
    vtkPolyData* surfaces[2] = {ours, theirs};
    for (int k = 0; k < 2; ++k) {
      for (vtkIdType point = 0; point < ours->GetNumberOfPoints(); ++point) {
        order[k].push_back(point);
      }
      std::sort(order[k].begin(), order[k].end(), [&](vtkIdType a, vtkIdType b) {
        const auto rounded = [&](vtkIdType p) {
          return glm::round(PlaceOf(surfaces[k], p) * 512.0f + 0.25f);
        };
        return LessPlace()(rounded(a), rounded(b));
      });
    }
    int same = 0;
    for (std::size_t k = 0; k < order[0].size(); ++k) {
      const glm::vec3 a = PlaceOf(ours, order[0][k]);
      const glm::vec3 b = PlaceOf(theirs, order[1][k]);
      if (glm::length(a - b) > 1e-4f) {
        continue; // rounded to neighbours
      }
      ++same;
      glm::dvec3 na, nb;
      ours->GetPointData()->GetNormals()->GetTuple(order[0][k], &na.x);
      theirs->GetPointData()->GetNormals()->GetTuple(order[1][k], &nb.x);
      ASSERT_LT(glm::length(na - nb), 2e-3);
      ASSERT_EQ(ours->GetPointData()->GetScalars()->GetTuple1(order[0][k]),
                theirs->GetPointData()->GetScalars()->GetTuple1(order[1][k]));
    }
    EXPECT_GE(same, static_cast<int>(order[0].size()) * 95 / 100);
  }

  TemporaryFolder Folder;
  vtkNew<vtkINRReader> Reader;
  vtkNew<vtkINRContour> Filter;
  vtkNew<vtkINRDecode> Voxels;
  vtkNew<vtkFlyingEdges3D> Stock;
};

} // namespace

TEST_F(Contour, IsWhatVTKFindsInTheDecodedVoxels)
{
  const auto model = MakeModel({50, 37, 41});
  MeasureCells(*model, 16);
  this->connect(*model);
  this->Filter->SetValue(0, 57.0);
  this->Filter->SetValue(1, 61.5);
  for (const int level : {0, 1}) {
    SCOPED_TRACE(level);
    this->Filter->SetLevel(level);
    this->expectSame(this->update(), this->reference(level, {57.0, 61.5}));
    EXPECT_EQ(this->Filter->GetLevelInUse(), level);
    EXPECT_EQ(this->Filter->GetNumberOfBricks(), level == 0 ? 4 * 3 * 3 : 3 * 3 * 3);
  }
}

TEST_F(Contour, DecodesOnlyWhatTheRangesAskFor)
{
  const auto model = MakeModel({70, 66, 68});
  MeasureCells(*model, 16);
  this->connect(*model);
  this->Filter->SetLevel(0);
  double range[2] = {1e9, -1e9};
  for (const inr::ValueRange& cell : model->macroCells.ranges) {
    range[0] = std::min(range[0], inr::ValueOf(model->volume, cell.low));
    range[1] = std::max(range[1], inr::ValueOf(model->volume, cell.high));
  }
  const double rare = range[1] - 0.02 * (range[1] - range[0]);
  this->Filter->SetValue(0, rare);
  this->expectSame(this->update(), this->reference(0, {rare}));
  EXPECT_EQ(this->Filter->GetNumberOfCells(), 125);
  EXPECT_GT(this->Filter->GetSkippedCells(), 20);
  EXPECT_LT(this->Filter->GetDecodedBricks(), this->Filter->GetNumberOfBricks() - 20);

  const MessageCapture messages;
  for (const double nowhere : {range[0] - 0.01, range[0] - 1, range[1] + 0.01, 1e9}) {
    this->Filter->SetValue(0, nowhere);
    EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
    EXPECT_EQ(this->Filter->GetDecodedBricks(), 0);
  }
  this->Filter->SetNumberOfContours(0);
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
}

TEST_F(Contour, HasNoIsovalueBeforeTheFirst)
{
  EXPECT_EQ(this->Filter->GetValue(-1), 0);
  this->Filter->SetValue(-1, 3.0);
  EXPECT_EQ(this->Filter->GetNumberOfContours(), 1);
  EXPECT_EQ(this->Filter->GetValue(0), 3.0);
}

TEST_F(Contour, LooksEverywhereWithoutMacroCells)
{
  this->connect(*MakeModel({50, 37, 41}));
  this->Filter->SetValue(0, 57.0);
  this->expectSame(this->update(), this->reference(0, {57.0}));
  EXPECT_EQ(this->Filter->GetDecodedBricks(), this->Filter->GetNumberOfBricks());
  this->Filter->SetNumberOfContours(0);
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
  EXPECT_EQ(this->Filter->GetDecodedBricks(), 0);
}

TEST_F(Contour, FollowsASurfaceWhereTheRangesDoNotKnowOfIt)
{
  const auto model = MakeBall({100, 90, 80});
  model->macroCells = inr::MakeMacroCells(model->volume.dims, 16);
  std::fill(model->macroCells.ranges.begin(), model->macroCells.ranges.end(),
            inr::ValueRange{0.0f, 0.1f});
  // All that is known of the ball is one cell that its surface runs through.
  const double value = 0.6;
  const glm::dvec3 place(0.5, 0.5, 0.5 + BallRadius(value));
  const glm::i64vec3 cell(place / model->macroCells.spacing);
  model->macroCells
      .ranges[static_cast<std::size_t>(model->macroCells.index(cell.x, cell.y, cell.z))] = {0.5f,
                                                                                            0.7f};
  this->connect(*model);
  this->Filter->SetValue(0, value);
  this->Filter->SetLevel(0);
  vtkPolyData* surface = this->update();
  EXPECT_EQ(OpenEdges(surface), 0);
  this->expectSame(surface, this->reference(0, {value}));
  EXPECT_LT(this->Filter->GetDecodedBricks(), this->Filter->GetNumberOfBricks());
}

TEST_F(Contour, FindsASmallSurfaceInAVastVolume)
{
  for (const std::int64_t size : {4096, 131072}) {
    SCOPED_TRACE(size);
    const auto model = MakeBall(glm::i64vec3(size));
    model->macroCells = inr::MakeMacroCells(model->volume.dims, static_cast<int>(size / 32));
    for (std::int64_t k = 0; k < 32 * 32 * 32; ++k) {
      const glm::i64vec3 cell(k % 32, k / 32 % 32, k / 1024);
      const glm::dvec3 way = glm::abs(glm::dvec3(cell) - 15.5);
      const bool central = std::max({way.x, way.y, way.z}) < 1;
      model->macroCells.ranges[static_cast<std::size_t>(k)] = {0.0f, central ? 1.0f : 0.95f};
    }
    this->connect(*model);
    const int level = size == 4096 ? 0 : 6;
    const double value = 1 - 60.0 * std::ldexp(1.0, level) / static_cast<double>(size);
    this->Filter->SetValue(0, value);
    this->Filter->SetLevel(level);
    vtkPolyData* surface = this->update();
    EXPECT_GT(surface->GetNumberOfCells(), 5000);
    EXPECT_EQ(OpenEdges(surface), 0);
    EXPECT_LT(this->Filter->GetDecodedBricks(), this->Filter->GetNumberOfBricks() / 1000);
    EXPECT_EQ(this->Filter->GetSkippedCells(), 32 * 32 * 32 - 8);
    if (level == 0) { // a voxel's averages blur the tip of the field on other levels
      this->expectFieldIs(*model, surface, value);
    }
  }
}

TEST_F(Contour, ChoosesTheFinestLevelThatTheSamplesAllow)
{
  const auto model = MakeModel({50, 37, 41});
  MeasureCells(*model, 16);
  this->connect(*model);
  this->Filter->SetValue(0, 57.0);
  int before = 0;
  for (const vtkIdType samples : {1000000, 100000, 1}) {
    this->Filter->SetMaximumSamples(samples);
    vtkPolyData* surface = this->update();
    const int level = this->Filter->GetLevelInUse();
    EXPECT_GE(level, before);
    EXPECT_EQ(surface->GetFieldData()->GetArray("INRLevel")->GetTuple1(0), level);
    before = level;
  }
  EXPECT_EQ(before, 3); // where one brick holds the volume
  this->Filter->SetLevel(30);
  this->update();
  EXPECT_EQ(this->Filter->GetLevelInUse(), 3);
}

TEST_F(Contour, SharesItselfOutAmongProcesses)
{
  const auto model = MakeModel({50, 37, 41});
  MeasureCells(*model, 16);
  this->connect(*model);
  this->Filter->SetValue(0, 57.0);
  const std::vector<Triangle> whole = TrianglesOf(this->update());
  std::vector<Triangle> parts;
  for (int piece = 0; piece < 3; ++piece) {
    this->Filter->UpdatePiece(piece, 3, 0);
    const auto part = TrianglesOf(this->Filter->GetOutput());
    EXPECT_GT(part.size(), whole.size() / 10);
    parts.insert(parts.end(), part.begin(), part.end());
  }
  std::sort(parts.begin(), parts.end(), LessPlace());
  EXPECT_EQ(parts, whole);
}

TEST_F(Contour, LeavesNormalsOutWhenTold)
{
  this->connect(*MakeModel({50, 37, 41}));
  this->Filter->SetValue(0, 57.0);
  const auto with = TrianglesOf(this->update());
  this->Filter->ComputeNormalsOff();
  const auto without = TrianglesOf(this->update());
  EXPECT_EQ(this->Filter->GetOutput()->GetPointData()->GetNormals(), nullptr);
  EXPECT_EQ(with, without);
}

// As images with negative spacing and left-handed patients' axes have it.
TEST_F(Contour, FacesOutwardsWhereAxesMirror)
{
  const auto model = MakeBall({40, 40, 40});
  for (const glm::dvec3& signs : {glm::dvec3(1), glm::dvec3(-1, 1, 1), glm::dvec3(1, 1, -1)}) {
    SCOPED_TRACE(signs.x + 2 * signs.z);
    model->volume.direction = glm::dmat3(1.0);
    for (int axis = 0; axis < 3; ++axis) {
      model->volume.direction[axis] *= signs[axis];
    }
    this->connect(*model);
    this->Filter->SetValue(0, 0.5);
    vtkPolyData* ball = this->update();
    ASSERT_GT(ball->GetNumberOfCells(), 1000);
    EXPECT_GT(PartThatFacesItsNormals(ball), 0.99);
  }
}

TEST_F(Contour, HasTheNormalsOfAnyRangeOfValues)
{
  const auto model = MakeModel({50, 37, 41}, inr::ScalarType::Float64);
  const auto normalsAt = [&](double width) {
    model->volume.low = -0.5 * width;
    model->volume.high = 0.5 * width;
    this->connect(*model);
    this->Filter->SetValue(0, 0.0625 * width);
    vtkSmartPointer<vtkDataArray> normals = this->update()->GetPointData()->GetNormals();
    return normals;
  };
  const auto expected = normalsAt(1.0);
  ASSERT_GT(expected->GetNumberOfTuples(), 100);
  for (const double width : {0x1p-1000, 0x1p-150, 0x1p140, 0x1p1023}) {
    SCOPED_TRACE(width);
    const auto normals = normalsAt(width);
    ASSERT_EQ(normals->GetNumberOfTuples(), expected->GetNumberOfTuples());
    for (vtkIdType k = 0; k < normals->GetNumberOfTuples(); ++k) {
      glm::dvec3 normal, other;
      normals->GetTuple(k, &normal.x);
      expected->GetTuple(k, &other.x);
      ASSERT_LT(glm::length(normal - other), 1e-2) << k;
    }
  }
}

TEST_F(Contour, TakesDoubleWhereFloatsAreTooCoarse)
{
  const auto model = MakeModel({50, 37, 41});
  this->connect(*model);
  this->Filter->SetValue(0, 57.0);
  EXPECT_EQ(this->update()->GetPoints()->GetDataType(), VTK_FLOAT);
  model->volume.origin = {1e6, 0, 0};
  this->connect(*model);
  EXPECT_EQ(this->update()->GetPoints()->GetDataType(), VTK_DOUBLE);
}

TEST_F(Contour, RefusesWhatItCannotDo)
{
  const auto refused = [&](const std::string& words) {
    const MessageCapture messages;
    EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
    EXPECT_TRUE(messages.onlyError(words)) << messages.text();
  };
  vtkNew<vtkImageData> image;
  image->SetDimensions(4, 4, 4);
  image->AllocateScalars(VTK_FLOAT, 1);
  this->Filter->SetInputData(image);
  this->Filter->SetValue(0, 57.0);
  refused("not an implicit neural representation");
  this->connect(*MakeModel({12, 1, 9}));
  refused("single voxel along an axis");
  this->connect(*MakeModel({12, 10, 9}));
  this->Filter->SetValue(0, std::nan(""));
  refused("not a number");
  this->Filter->SetValue(0, 57.0);
  this->connect(*MakeModel({4096, 4096, 4096}));
  this->Filter->SetLevel(0);
  this->Filter->SetMemoryLimit(1);
  refused("MemoryLimit of 1 MiB; choose a higher Level than 0");
  this->connect(*MakeModel({65536, 65536, 65536}));
  refused("bricks of level 0; choose a higher Level");
  this->Reader->SetFileName((this->Folder / "missing.inr").c_str());
  refused("missing.inr");
}

TEST_F(Contour, ReportsProgressAndStopsWhenAsked)
{
  this->connect(*MakeModel({256, 256, 256}));
  this->Filter->SetValue(0, 57.0);
  this->Filter->SetLevel(0);
  struct Watcher
  {
    int calls = 0;
    double last = 0;
    bool rising = true;
  } watcher;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&watcher);
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    auto* self = static_cast<Watcher*>(data);
    auto* filter = vtkAlgorithm::SafeDownCast(caller);
    self->rising = self->rising && filter->GetProgress() >= self->last;
    self->last = filter->GetProgress();
    filter->SetAbortExecute(++self->calls >= 4);
  });
  this->Filter->AddObserver(vtkCommand::ProgressEvent, command);
  const MessageCapture messages;
  EXPECT_EQ(this->update()->GetNumberOfPoints(), 0);
  EXPECT_TRUE(watcher.rising);
  EXPECT_LT(this->Filter->GetDecodedBricks(), 400);
  EXPECT_GT(this->Filter->GetDecodedBricks(), 64);
  EXPECT_TRUE(messages.errors().empty()) << messages.text(); // who stops it, knows
}
