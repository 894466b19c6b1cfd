// SPDX-License-Identifier: BSD-3-Clause
#include "MessageCapture.h"
#include "TestModels.h"
#include "vtkINRDecode.h"
#include "vtkINRReader.h"
#include "vtkINRWriter.h"

#include <vtkBitArray.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSOADataArrayTemplate.h>
#include <vtkStringArray.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <limits>

namespace {

// Small enough to learn a smooth field in a second.
constexpr const char* SmallModel = R"({
  "encoding": {"otype": "HashGrid", "n_levels": 4, "n_features_per_level": 2,
               "log2_hashmap_size": 12, "base_resolution": 4, "per_level_scale": 1.6},
  "network": {"otype": "FullyFusedMLP", "n_neurons": 16, "n_hidden_layers": 2,
              "activation": "ReLU", "output_activation": "None"}})";

/// Between 0 and 1, different along every axis.
double Field(double x, double y, double z) { return 0.5 * x * x + 0.3 * y + 0.2 * (1 - z); }

/// An image whose array `name` is low + (high - low) * Field over its extent.
vtkSmartPointer<vtkImageData> MakeImage(const glm::ivec3& dims, int type, double low, double high)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(dims.x, dims.y, dims.z);
  image->SetSpacing(0.5, 1.5, 2.5);
  image->SetOrigin(-3.0, 7.0, 0.25);
  auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  array->SetName("field");
  array->SetNumberOfTuples(image->GetNumberOfPoints());
  const glm::dvec3 last = glm::max(glm::dvec3(dims) - 1.0, 1.0);
  for (vtkIdType index = 0; index < image->GetNumberOfPoints(); ++index) {
    const double y = Field(static_cast<double>(index % dims.x) / last.x,
                           static_cast<double>(index / dims.x % dims.y) / last.y,
                           static_cast<double>(index / (dims.x * dims.y)) / last.z);
    array->SetTuple1(index, low + (high - low) * y);
  }
  image->GetPointData()->SetScalars(array);
  return image;
}

class Writer : public testing::Test
{
protected:
  Writer()
  {
    this->Algorithm->SetFileName(this->path().c_str());
    this->Algorithm->SetModelConfig(SmallModel);
    this->Algorithm->SetMaximumSteps(80);
  }

  std::string path() const { return this->Folder / "saved.inr"; }

  void write(vtkDataObject* data)
  {
    this->Algorithm->SetInputData(data);
    this->Algorithm->Write();
  }

  /// The voxels as the file has them.
  vtkSmartPointer<vtkImageData> decode()
  {
    vtkNew<vtkINRReader> reader;
    reader->SetFileName(this->path().c_str());
    vtkNew<vtkINRDecode> decode;
    decode->SetInputConnection(reader->GetOutputPort());
    decode->Update();
    return decode->GetOutput();
  }

  void expectRefusal(vtkDataObject* data, const std::string& words)
  {
    const MessageCapture messages;
    const auto start = std::chrono::steady_clock::now();
    this->write(data);
    EXPECT_TRUE(messages.onlyError(words)) << messages.text();
    EXPECT_NE(this->Algorithm->GetErrorCode(), 0u);
    EXPECT_EQ(this->Folder.entries(), 0);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  }

  TemporaryFolder Folder;
  vtkNew<vtkINRWriter> Algorithm;
};

/// Largest difference of two images' scalars.
double LargestError(vtkImageData* first, vtkImageData* second)
{
  vtkDataArray* a = first->GetPointData()->GetScalars();
  vtkDataArray* b = second->GetPointData()->GetScalars();
  double largest = 0;
  for (vtkIdType index = 0; index < a->GetNumberOfTuples(); ++index) {
    largest = std::fmax(largest, std::fabs(a->GetTuple1(index) - b->GetTuple1(index)));
  }
  return largest;
}

struct TypeCase
{
  int type;
  double low, high;
};
class WriterOfType : public Writer, public testing::WithParamInterface<TypeCase>
{};

} // namespace

TEST_P(WriterOfType, KeepsTypeAndValues)
{
  const TypeCase& given = this->GetParam();
  const auto image = MakeImage({17, 14, 11}, given.type, given.low, given.high);
  const MessageCapture messages;
  this->Algorithm->SetMaximumSteps(240);
  this->write(image);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();

  const auto decoded = this->decode();
  EXPECT_EQ(decoded->GetPointData()->GetScalars()->GetDataTypeSize(),
            image->GetPointData()->GetScalars()->GetDataTypeSize());
  EXPECT_EQ(decoded->GetPointData()->GetScalars()->GetDataTypeMin(),
            image->GetPointData()->GetScalars()->GetDataTypeMin());
  EXPECT_EQ(this->Algorithm->GetSteps(), 240);
  EXPECT_GT(this->Algorithm->GetPSNR(), 35.0);
  // Besides what the training leaves, integers are rounded.
  const double error = LargestError(image, decoded);
  EXPECT_LE(error, this->Algorithm->GetMaximumError() * 1.001 + 0.5);
  EXPECT_LT(error, 0.3 * (given.high - given.low));
}

INSTANTIATE_TEST_SUITE_P(
    AllTypes, WriterOfType,
    testing::Values(TypeCase{VTK_CHAR, -100, 100}, TypeCase{VTK_SIGNED_CHAR, -128, 127},
                    TypeCase{VTK_UNSIGNED_CHAR, 0, 255}, TypeCase{VTK_SHORT, -3e4, 3e4},
                    TypeCase{VTK_UNSIGNED_SHORT, 5, 65535}, TypeCase{VTK_INT, -2e9, 2e9},
                    TypeCase{VTK_UNSIGNED_INT, 1e9, 4e9}, TypeCase{VTK_LONG, -9e18, 9e18},
                    TypeCase{VTK_UNSIGNED_LONG, 0, 1.8e19}, TypeCase{VTK_LONG_LONG, -1e15, 1e15},
                    TypeCase{VTK_UNSIGNED_LONG_LONG, 0, 1e15}, TypeCase{VTK_ID_TYPE, 0, 1e12},
                    TypeCase{VTK_FLOAT, -1e-6, 1e-6}, TypeCase{VTK_DOUBLE, 1e9, 1e9 + 1}),
    [](const auto& info) {
      std::string name = vtkImageScalarTypeNameMacro(info.param.type);
      std::replace(name.begin(), name.end(), ' ', '_');
      return name;
    });

TEST_F(Writer, KeepsTheGeometry)
{
  const auto image = MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1);
  const double direction[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  image->SetDirectionMatrix(direction);
  this->write(image);
  const auto decoded = this->decode();
  for (vtkIdType index = 0; index < image->GetNumberOfPoints(); ++index) {
    double a[3], b[3];
    image->GetPoint(index, a);
    decoded->GetPoint(index, b);
    ASSERT_EQ(glm::dvec3(a[0], a[1], a[2]), glm::dvec3(b[0], b[1], b[2]));
  }
  EXPECT_STREQ(decoded->GetPointData()->GetScalars()->GetName(), "field");
}

TEST_F(Writer, TakesAnExtentThatStartsElsewhere)
{
  const auto image = MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1);
  image->SetExtent(10, 18, -3, 4, 0, 6);
  this->write(image);
  const auto decoded = this->decode();
  EXPECT_EQ(decoded->GetNumberOfPoints(), 9 * 8 * 7);
  for (int side = 0; side < 6; ++side) {
    EXPECT_DOUBLE_EQ(decoded->GetBounds()[side], image->GetBounds()[side]);
  }
}

TEST_F(Writer, TakesSlabsSticksAndPoints)
{
  for (const glm::ivec3 dims : {glm::ivec3(20, 1, 15), {1, 1, 12}, {1, 1, 1}}) {
    SCOPED_TRACE(dims.x);
    const MessageCapture messages;
    const auto image = MakeImage(dims, VTK_FLOAT, 0, 1);
    this->write(image);
    EXPECT_TRUE(messages.errors().empty()) << messages.text();
    const auto decoded = this->decode();
    ASSERT_EQ(decoded->GetNumberOfPoints(), image->GetNumberOfPoints());
    EXPECT_LT(LargestError(image, decoded), 0.5);
    EXPECT_EQ(decoded->GetSpacing()[1], 1.5);
  }
}

TEST_F(Writer, TakesOtherMemoryLayouts)
{
  const auto image = MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1);
  this->write(image);
  const auto expected = this->decode();

  vtkNew<vtkSOADataArrayTemplate<float>> apart;
  apart->DeepCopy(image->GetPointData()->GetScalars());
  image->GetPointData()->SetScalars(apart);
  this->write(image);
  EXPECT_EQ(LargestError(expected, this->decode()), 0.0);
}

TEST_F(Writer, CompressesWhatAReaderOpened)
{
  const auto image = MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1);
  this->write(image);
  vtkNew<vtkINRReader> reader;
  reader->SetFileName(this->path().c_str());
  this->Algorithm->SetInputConnection(reader->GetOutputPort());
  this->Algorithm->SetFileName((this->Folder / "again.inr").c_str());
  this->Algorithm->Write();
  EXPECT_GT(this->Algorithm->GetPSNR(), 12.0);
  EXPECT_EQ(this->Folder.entries(), 2);
}

TEST_F(Writer, SavesTheChosenArray)
{
  const auto image = MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1);
  vtkNew<vtkFloatArray> other;
  other->SetName("other");
  other->SetNumberOfTuples(image->GetNumberOfPoints());
  other->FillValue(42.0f);
  image->GetPointData()->AddArray(other);
  this->Algorithm->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                                          "other");
  this->write(image);
  const auto decoded = this->decode();
  EXPECT_STREQ(decoded->GetPointData()->GetScalars()->GetName(), "other");
  EXPECT_EQ(decoded->GetPointData()->GetScalars()->GetTuple1(100), 42.0); // constants are exact
}

TEST_F(Writer, StoresTheQualityThatItReports)
{
  this->write(MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1));
  vtkNew<vtkINRReader> reader;
  reader->SetFileName(this->path().c_str());
  reader->UpdateInformation();
  EXPECT_EQ(reader->GetPSNR(), this->Algorithm->GetPSNR());
  EXPECT_EQ(reader->GetSSIM(), this->Algorithm->GetSSIM());
  EXPECT_EQ(reader->GetMaximumError(), this->Algorithm->GetMaximumError());
  EXPECT_EQ(reader->GetRatio(), this->Algorithm->GetRatio());
  EXPECT_GT(this->Algorithm->GetTrainingSeconds(), 0.0);
}

TEST_F(Writer, WritesCompactFilesUnlessToldOtherwise)
{
  const auto image = MakeImage({40, 30, 20}, VTK_FLOAT, 0, 1);
  const auto bytes = [&] {
    std::ifstream file(this->path(), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  this->write(image);
  const std::string compact = bytes();
  const double ratio = this->Algorithm->GetRatio();
  EXPECT_DOUBLE_EQ(ratio, 40 * 30 * 20 * 4.0 / static_cast<double>(compact.size()));
  EXPECT_NE(compact.find("quantised"), std::string::npos);
  const double error = this->Algorithm->GetMaximumError();
  EXPECT_NEAR(LargestError(image, this->decode()), error, 1e-6);

  this->Algorithm->ReadableByInstantVNROn();
  this->write(image);
  const std::string plain = bytes();
  EXPECT_EQ(plain.find("quantised"), std::string::npos);
  EXPECT_NE(plain.find("__half"), std::string::npos);
  EXPECT_GT(plain.size(), compact.size() * 3 / 2);
  EXPECT_LT(this->Algorithm->GetRatio(), ratio);
  EXPECT_NEAR(LargestError(image, this->decode()), this->Algorithm->GetMaximumError(), 1e-6);
}

TEST_F(Writer, WarnsOfValuesThatAreNoNumbers)
{
  const auto image = MakeImage({9, 8, 7}, VTK_FLOAT, 0, 1);
  vtkDataArray* array = image->GetPointData()->GetScalars();
  array->SetTuple1(10, std::numeric_limits<double>::quiet_NaN());
  array->SetTuple1(400, std::numeric_limits<double>::infinity());
  const MessageCapture messages;
  this->write(image);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
  ASSERT_EQ(messages.warnings().size(), 1u);
  EXPECT_NE(messages.warnings()[0].find("2 NaN or infinite values"), std::string::npos);
  EXPECT_LE(this->decode()->GetScalarRange()[1], 1.0);
}

TEST_F(Writer, RefusesDataThatItCannotSave)
{
  this->expectRefusal(vtkNew<vtkPolyData>(), "vtkPolyData, not image data");
  this->expectRefusal(vtkNew<vtkImageData>(), "no");

  const auto image = MakeImage({4, 4, 4}, VTK_FLOAT, 0, 1);
  vtkPointData* points = image->GetPointData();
  const auto choose = [&](vtkAbstractArray* array) {
    array->SetName("bad");
    points->AddArray(array);
    this->Algorithm->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS,
                                            "bad");
  };
  vtkNew<vtkFloatArray> vectors;
  vectors->SetNumberOfComponents(3);
  vectors->SetNumberOfTuples(64);
  choose(vectors);
  this->expectRefusal(image, "3 components");
  vtkNew<vtkStringArray> strings;
  strings->SetNumberOfValues(64);
  choose(strings);
  this->expectRefusal(image, "does not hold numbers");
  vtkNew<vtkBitArray> bits;
  bits->SetNumberOfTuples(64);
  choose(bits);
  this->expectRefusal(image, "not numbers");
  vtkNew<vtkFloatArray> empty;
  choose(empty);
  this->expectRefusal(image, "0 values for 64 points");
  points->RemoveArray("bad");
  this->expectRefusal(image, "no point array 'bad'");

  vtkNew<vtkFloatArray> cells;
  cells->SetName("cells");
  cells->SetNumberOfTuples(27);
  image->GetCellData()->AddArray(cells);
  this->Algorithm->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "cells");
  this->expectRefusal(image, "CellDataToPointData");
}

TEST_F(Writer, RefusesSettingsThatMakeNoSense)
{
  const auto image = MakeImage({4, 4, 4}, VTK_FLOAT, 0, 1);
  this->Algorithm->SetModelConfig("{ not JSON");
  this->expectRefusal(image, "JSON");
  this->Algorithm->SetModelConfig(R"({"encoding": {"otype": "Frequency"}})");
  this->expectRefusal(image, "Frequency");
  this->Algorithm->SetModelConfig(nullptr);
  this->Algorithm->SetTimeLimit(0);
  this->Algorithm->SetMaximumSteps(0);
  this->expectRefusal(image, "never end");
  this->Algorithm->SetFileName(nullptr);
  this->expectRefusal(image, "no FileName");
}

// With five minutes of training ahead, the test's own limit of seconds would be missed.
TEST_F(Writer, LearnsBeforeTheTrainingThatItCannotWrite)
{
  const auto image = MakeImage({40, 40, 40}, VTK_FLOAT, 0, 1);
  this->Algorithm->SetMaximumSteps(0);
  this->Algorithm->SetFileName((this->Folder / "no/such/folder.inr").c_str());
  this->expectRefusal(image, "no/such/folder.inr");
  this->Algorithm->SetFileName("/dev/null");
  this->expectRefusal(image, "/dev/null");
}

namespace {

struct ProgressWatcher
{
  int calls = 0;
  double last = 0;
  bool rising = true;
  bool named = true;
  int stopAfter = VTK_INT_MAX;

  static void Watch(vtkObject* caller, unsigned long, void* data, void*)
  {
    auto* self = static_cast<ProgressWatcher*>(data);
    auto* writer = vtkAlgorithm::SafeDownCast(caller);
    self->rising = self->rising && writer->GetProgress() >= self->last;
    self->last = writer->GetProgress();
    // The pipeline reports beginning and end by itself.
    const bool within = self->last > 0.0 && self->last < 1.0;
    self->named = self->named && (!within || writer->GetProgressText());
    if (++self->calls >= self->stopAfter) {
      writer->SetAbortExecute(1);
    }
  }
};

} // namespace

TEST_F(Writer, ReportsProgressAndStopsWhenAsked)
{
  ProgressWatcher watcher;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&watcher);
  command->SetCallback(ProgressWatcher::Watch);
  this->Algorithm->AddObserver(vtkCommand::ProgressEvent, command);

  const auto image = MakeImage({20, 20, 20}, VTK_FLOAT, 0, 1);
  this->write(image);
  EXPECT_GE(watcher.calls, 2);
  EXPECT_TRUE(watcher.rising);
  EXPECT_TRUE(watcher.named);
  EXPECT_EQ(watcher.last, 1.0);
  std::filesystem::remove(this->path());

  watcher = ProgressWatcher();
  watcher.stopAfter = 2;
  this->Algorithm->SetCheckpointInterval(0);
  this->Algorithm->SetMaximumSteps(0); // five minutes
  this->expectRefusal(image, "stopped");

  watcher = ProgressWatcher();
  this->Algorithm->SetAbortExecute(0); // VTK 9.1 does it by itself, 9.2 leaves it to the caller
  this->Algorithm->SetMaximumSteps(80);
  this->write(image);
  EXPECT_EQ(this->Folder.entries(), 1);
}

namespace {

/// Stops a writer once its progress is beyond `limit`.
struct Stopper
{
  explicit Stopper(vtkAlgorithm* writer) : Writer(writer)
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
      auto* algorithm = vtkAlgorithm::SafeDownCast(caller);
      if (algorithm->GetProgress() > static_cast<Stopper*>(data)->limit) {
        algorithm->SetAbortExecute(1);
      }
    });
    writer->AddObserver(vtkCommand::ProgressEvent, this->Command);
  }
  ~Stopper()
  {
    this->Writer->RemoveObserver(this->Command);
    this->Writer->SetAbortExecute(0);
  }
  Stopper(const Stopper&) = delete;
  Stopper& operator=(const Stopper&) = delete;

  double limit = 0.4;
  vtkAlgorithm* Writer;
  vtkNew<vtkCallbackCommand> Command;
};

} // namespace

TEST_F(Writer, GoesOnFromTheCheckpointOfAStoppedTraining)
{
  const auto image = MakeImage({20, 20, 20}, VTK_FLOAT, 0, 1);
  this->write(image);
  const inr::ModelPointer whole = inr::ReadModel(this->path());
  std::filesystem::remove(this->path());

  const std::string checkpoint = this->path() + ".checkpoint";
  {
    const MessageCapture messages;
    const Stopper stopper(this->Algorithm);
    this->write(image);
    EXPECT_TRUE(messages.onlyError("steps are kept in '" + checkpoint)) << messages.text();
  }
  EXPECT_EQ(this->Folder.entries(), 1);
  EXPECT_TRUE(std::filesystem::exists(checkpoint));
  {
    const MessageCapture messages;
    this->Algorithm->SetSeed(2);
    this->write(image);
    EXPECT_TRUE(messages.errors().empty()) << messages.text();
    ASSERT_EQ(messages.warnings().size(), 1u);
    EXPECT_NE(messages.warnings()[0].find("Seed is 1 there and 2 here"), std::string::npos);
    EXPECT_TRUE(std::filesystem::exists(checkpoint)); // it may still be wanted
  }
  const MessageCapture messages;
  this->Algorithm->SetSeed(1);
  this->write(image);
  EXPECT_TRUE(messages.errors().empty() && messages.warnings().empty()) << messages.text();
  EXPECT_EQ(this->Algorithm->GetSteps(), 80);
  EXPECT_EQ(inr::ReadModel(this->path())->parameters, whole->parameters);
  EXPECT_EQ(this->Folder.entries(), 1);
}

TEST_F(Writer, GoesOnWithMeasuringWhenItWasStoppedThere)
{
  const auto image = MakeImage({20, 20, 20}, VTK_FLOAT, 0, 1);
  this->Algorithm->SetCheckpointInterval(1e-3);
  {
    const MessageCapture messages;
    Stopper stopper(this->Algorithm);
    stopper.limit = 0.9;
    this->write(image);
    EXPECT_TRUE(messages.onlyError(".checkpoint' is kept")) << messages.text();
  }
  vtkIdType trained = 0;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&trained);
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    const char* text = vtkAlgorithm::SafeDownCast(caller)->GetProgressText();
    *static_cast<vtkIdType*>(data) += text && std::string(text) == "Training INR" ? 1 : 0;
  });
  this->Algorithm->AddObserver(vtkCommand::ProgressEvent, command);
  this->write(image);
  EXPECT_LE(trained, 1); // the pipeline's own report keeps the text
  EXPECT_EQ(this->Algorithm->GetSteps(), 80);
  EXPECT_EQ(this->Folder.entries(), 1);
}

namespace {

volatile std::sig_atomic_t SignalsSeen = 0;
volatile std::sig_atomic_t MessagesBefore = 0;

/// As in pvpython, where the handler ends the process: what is to be said must have been.
void NoteSignal(int)
{
  SignalsSeen = SignalsSeen + 1;
  const auto* window = dynamic_cast<CapturingWindow*>(vtkOutputWindow::GetInstance());
  MessagesBefore = window ? static_cast<int>(window->Errors.size()) : 0;
}

} // namespace

TEST_F(Writer, StopsOnASignalAndHandsItOn)
{
  struct sigaction mine = {};
  struct sigaction before = {};
  mine.sa_handler = NoteSignal;
  sigaction(SIGTERM, &mine, &before);

  bool sent = false;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&sent);
  command->SetCallback([](vtkObject* caller, unsigned long, void* data, void*) {
    const bool training = vtkAlgorithm::SafeDownCast(caller)->GetProgressText();
    if (training && !*static_cast<bool*>(data)) {
      *static_cast<bool*>(data) = true;
      std::raise(SIGTERM);
      EXPECT_EQ(SignalsSeen, 0); // not yet: first the training ends in good order
    }
  });
  const unsigned long tag = this->Algorithm->AddObserver(vtkCommand::ProgressEvent, command);
  this->Algorithm->SetCheckpointInterval(0);
  this->Algorithm->SetMaximumSteps(0);
  this->expectRefusal(MakeImage({20, 20, 20}, VTK_FLOAT, 0, 1), "stopped");
  EXPECT_EQ(SignalsSeen, 1);
  EXPECT_EQ(MessagesBefore, 1);
  this->Algorithm->RemoveObserver(tag);

  std::raise(SIGTERM); // the handler is back in its place
  EXPECT_EQ(SignalsSeen, 2);
  sigaction(SIGTERM, &before, nullptr);
}
