// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "MessageCapture.h"
#include "TestModels.h"
#include "vtkINRDataArray.h"

#include <vtkAOSDataArrayTemplate.h>
#include <vtkContourFilter.h>
#include <vtkDataArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkImageReslice.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkProbeFilter.h>
#include <vtkVariant.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

namespace {

vtkSmartPointer<vtkDataArray> WholeArray(const inr::ModelPointer& model)
{
  const glm::ivec3 dims(model->volume.dims);
  const int extent[6] = {0, dims.x - 1, 0, dims.y - 1, 0, dims.z - 1};
  return vtkINRDataArray::Create(model, &dims.x, extent);
}

vtkIdType Evaluations(vtkDataArray* array)
{
  return vtkINRDataArray::SafeDownCast(array)->GetNumberOfEvaluations();
}

/// What a point of the native grid should hold, before it takes the array's type.
double TruthAt(const Truth& truth, const glm::i64vec3& dims, vtkIdType index)
{
  const glm::dvec3 point(index % dims.x, index / dims.x % dims.y, index / (dims.x * dims.y));
  return truth((point + 0.5) / glm::dvec3(dims));
}

struct TypeCase
{
  inr::ScalarType type;
  int vtkType;
  double lowest, highest;
};

class DataArrayOfType : public testing::TestWithParam<TypeCase>
{};

class IntegerArray : public DataArrayOfType
{};

std::string TypeName(const testing::TestParamInfo<TypeCase>& info)
{
  return inr::ScalarName(info.param.type);
}

} // namespace

// The width of this range is rounded up.
TEST(DataArray, HasNoValueBeyondItsRange)
{
  const auto model = MakeModel({9, 8, 7}, inr::ScalarType::Float64);
  model->volume.low = -9.49;
  model->volume.high = 1.06;
  for (float& parameter : model->parameters) {
    parameter *= 8; // so that some of the network's outputs are beyond 1
  }
  const auto array = WholeArray(model);
  double most = model->volume.low;
  for (vtkIdType k = 0; k < array->GetNumberOfTuples(); ++k) {
    most = std::max(most, array->GetTuple1(k));
  }
  EXPECT_EQ(most, 1.06);
}

TEST_P(DataArrayOfType, HasTheTypeOfTheSource)
{
  const TypeCase& given = this->GetParam();
  const auto model = MakeModel({9, 8, 7}, given.type);
  const auto array = WholeArray(model);
  EXPECT_EQ(array->GetDataType(), given.vtkType);
  EXPECT_EQ(array->GetNumberOfComponents(), 1);
  ASSERT_EQ(array->GetNumberOfTuples(), 9 * 8 * 7);

  const Truth truth(model);
  const bool isReal = given.vtkType == VTK_FLOAT || given.vtkType == VTK_DOUBLE;
  const double rounding = (isReal ? 0.0 : 0.5) + 70 * PositionTolerance;
  for (vtkIdType index = 0; index < array->GetNumberOfTuples(); ++index) {
    const double value = array->GetTuple1(index);
    ASSERT_NEAR(value, TruthAt(truth, model->volume.dims, index), rounding);
    ASSERT_TRUE(isReal || value == std::floor(value));
  }
}

TEST_P(IntegerArray, ClampsToTheTypesRange)
{
  const TypeCase& given = this->GetParam();
  const auto model = MakeModel({9, 8, 7}, given.type);
  const double span = given.highest - given.lowest;
  model->volume.low = given.lowest - span;
  model->volume.high = given.highest + span;
  const auto array = WholeArray(model);
  double low = VTK_DOUBLE_MAX;
  double high = VTK_DOUBLE_MIN;
  for (vtkIdType index = 0; index < array->GetNumberOfTuples(); ++index) {
    low = std::fmin(low, array->GetTuple1(index));
    high = std::fmax(high, array->GetTuple1(index));
  }
  EXPECT_EQ(low, given.lowest);
  EXPECT_EQ(high, given.highest);
}

const TypeCase Integers[] = {{inr::ScalarType::Int8, VTK_SIGNED_CHAR, -128, 127},
                             {inr::ScalarType::UInt8, VTK_UNSIGNED_CHAR, 0, 255},
                             {inr::ScalarType::Int16, VTK_SHORT, -32768, 32767},
                             {inr::ScalarType::UInt16, VTK_UNSIGNED_SHORT, 0, 65535},
                             {inr::ScalarType::Int32, VTK_INT, -0x1p31, 0x1p31 - 1},
                             {inr::ScalarType::UInt32, VTK_UNSIGNED_INT, 0, 0x1p32 - 1},
                             {inr::ScalarType::Int64, VTK_TYPE_INT64, -0x1p63, 0x1p63},
                             {inr::ScalarType::UInt64, VTK_TYPE_UINT64, 0, 0x1p64}};
const TypeCase Reals[] = {{inr::ScalarType::Float32, VTK_FLOAT, 0, 0},
                          {inr::ScalarType::Float64, VTK_DOUBLE, 0, 0}};
INSTANTIATE_TEST_SUITE_P(Integers, DataArrayOfType, testing::ValuesIn(Integers), TypeName);
INSTANTIATE_TEST_SUITE_P(Reals, DataArrayOfType, testing::ValuesIn(Reals), TypeName);
INSTANTIATE_TEST_SUITE_P(Integers, IntegerArray, testing::ValuesIn(Integers), TypeName);

TEST(DataArray, IsFoundAmongOtherArrays)
{
  const auto model = MakeModel({4, 4, 4});
  const auto array = WholeArray(model);
  vtkINRDataArray* found = vtkINRDataArray::SafeDownCast(array);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->GetModel(), model);
  int dims[3];
  found->GetPresentedDimensions(dims);
  EXPECT_EQ(dims[2], 4);
  EXPECT_EQ(vtkINRDataArray::SafeDownCast(vtkNew<vtkFloatArray>()), nullptr);
  EXPECT_EQ(vtkINRDataArray::SafeDownCast(nullptr), nullptr);
}

TEST(DataArray, HoldsAPartOfAGrid)
{
  const auto model = MakeModel({40, 30, 20});
  const auto whole = WholeArray(model);
  const int dims[3] = {40, 30, 20};
  const int extent[6] = {17, 38, 3, 3, 5, 19};
  const auto part = vtkINRDataArray::Create(model, dims, extent);
  ASSERT_EQ(part->GetNumberOfTuples(), 22 * 1 * 15);
  for (vtkIdType index = 0; index < part->GetNumberOfTuples(); ++index) {
    const vtkIdType x = 17 + index % 22;
    const vtkIdType z = 5 + index / 22;
    ASSERT_NEAR(part->GetTuple1(index), whole->GetTuple1(x + 40 * (3 + 30 * z)),
                70 * PositionTolerance);
  }
  const auto* handle = vtkINRDataArray::SafeDownCast(part);
  int held[6];
  handle->GetPresentedExtent(held);
  EXPECT_TRUE(std::equal(held, held + 6, extent));
  vtkNew<vtkImageData> moved;
  moved->SetExtent(20, 41, 1, 1, 5, 19);
  int shift[3];
  handle->GetShift(moved, shift);
  EXPECT_EQ(glm::ivec3(shift[0], shift[1], shift[2]), glm::ivec3(3, -2, 0));
  const int outside[6] = {0, 40, 0, 0, 0, 0};
  EXPECT_THROW(vtkINRDataArray::Create(model, dims, outside), inr::Error);
}

TEST(DataArray, AnswersRangesFromTheFile)
{
  const auto array = WholeArray(MakeModel({512, 512, 512}));
  double range[2];
  array->GetRange(range);
  EXPECT_EQ(range[0], 20.0);
  EXPECT_EQ(range[1], 90.0);
  array->GetFiniteRange(range, 0);
  EXPECT_EQ(range[1], 90.0);
  array->GetRange(range, -1);
  EXPECT_EQ(range[1], 90.0);
  EXPECT_EQ(Evaluations(array), 0);
}

TEST(DataArray, EvaluatesABrickOnce)
{
  const auto array = WholeArray(MakeModel({64, 64, 64}));
  array->GetTuple1(0);
  const vtkIdType brick = Evaluations(array);
  EXPECT_EQ(brick, 16 * 16 * 16);
  array->GetTuple1(15 + 64 * 15);
  EXPECT_EQ(Evaluations(array), brick);
  array->GetTuple1(16);
  EXPECT_EQ(Evaluations(array), 2 * brick);
}

// The grid has more bricks than the cache keeps, so that threads evict each other's.
TEST(DataArray, GivesEveryThreadTheSameValuesInBoundedMemory)
{
  const auto model = MakeModel({2048, 2048, 2048}, inr::ScalarType::Float64);
  const auto array = WholeArray(model);
  const Truth truth(model);
  constexpr int Reads = 1500;
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&, thread] {
      for (int read = 0; read < Reads; ++read) {
        // Two threads each go the same way.
        const vtkIdType index =
            static_cast<vtkIdType>(inr::RandomBits(thread / 2, read) %
                                   static_cast<std::uint64_t>(array->GetNumberOfTuples()));
        const double error =
            array->GetComponent(index, 0) - TruthAt(truth, model->volume.dims, index);
        wrong += std::fabs(error) < 70 * PositionTolerance ? 0 : 1;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(Evaluations(array), 2 * Reads / 2 * 4096);
  EXPECT_LE(array->GetActualMemorySize(), 4096u * 4096u * 8u / 1024u + 1u);
}

TEST(DataArray, HandsOutACopyForThoseWhoWantAPointer)
{
  const auto array = WholeArray(MakeModel({33, 20, 18}));
  const auto* values = static_cast<const float*>(array->GetVoidPointer(0));
  ASSERT_NE(values, nullptr);
  EXPECT_EQ(array->GetVoidPointer(100), values + 100);
  const auto other = WholeArray(MakeModel({33, 20, 18}));
  for (vtkIdType index = 0; index < array->GetNumberOfTuples(); ++index) {
    ASSERT_NEAR(values[index], other->GetTuple1(index), 70 * PositionTolerance);
  }
}

TEST(DataArray, KeepsNoBricksBesideACopy)
{
  const auto array = WholeArray(MakeModel({64, 64, 64}));
  for (vtkIdType index = 0; index < array->GetNumberOfTuples(); index += 8) {
    array->GetTuple1(index);
  }
  const double before = array->GetTuple1(7);
  array->GetVoidPointer(0);
  EXPECT_EQ(array->GetActualMemorySize(), 64U * 64U * 64U * 4U / 1024U + 1U);
  EXPECT_EQ(array->GetTuple1(7), before);
}

TEST(DataArray, ExportsItsValuesWithoutACopyToKeep)
{
  const auto array = WholeArray(MakeModel({33, 20, 18}));
  std::vector<float> values(33 * 20 * 18);
  array->ExportToVoidPointer(values.data());
  EXPECT_EQ(array->GetActualMemorySize(), 1U);
  for (vtkIdType index = 0; index < array->GetNumberOfTuples(); ++index) {
    ASSERT_NEAR(values[static_cast<std::size_t>(index)], array->GetTuple1(index),
                70 * PositionTolerance);
  }
  const auto* copy = static_cast<const float*>(array->GetVoidPointer(0));
  const vtkIdType evaluations = Evaluations(array);
  array->ExportToVoidPointer(values.data());
  EXPECT_TRUE(std::equal(values.begin(), values.end(), copy));
  EXPECT_EQ(Evaluations(array), evaluations);
}

TEST(DataArray, RefusesACopyThatIsTooLarge)
{
  const auto array = WholeArray(MakeModel({4096, 4096, 4096}));
  const MessageCapture messages;
  EXPECT_EQ(array->GetVoidPointer(0), nullptr);
  EXPECT_TRUE(messages.onlyError("MaximumGridPoints")) << messages.text();
  EXPECT_EQ(Evaluations(array), 0);
}

TEST(DataArray, CopiesIntoOrdinaryArraysByValue)
{
  const auto array = WholeArray(MakeModel({6, 5, 4}));
  const auto copy = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
  EXPECT_NE(vtkFloatArray::SafeDownCast(copy), nullptr);
  copy->DeepCopy(array);
  ASSERT_EQ(copy->GetNumberOfTuples(), array->GetNumberOfTuples());
  for (vtkIdType index = 0; index < copy->GetNumberOfTuples(); ++index) {
    ASSERT_EQ(copy->GetTuple1(index), array->GetTuple1(index));
  }
}

TEST(DataArray, SharesItsValuesWithCopiesOfItsOwnKind)
{
  const auto model = MakeModel({6, 5, 4});
  const auto array = WholeArray(model);
  array->SetName("shared");
  const auto copy = WholeArray(MakeModel({2, 2, 2}));
  copy->DeepCopy(array);
  EXPECT_EQ(copy->GetNumberOfTuples(), 6 * 5 * 4);
  EXPECT_STREQ(copy->GetName(), "shared");
  EXPECT_EQ(vtkINRDataArray::SafeDownCast(copy)->GetModel(), model);
  copy->GetTuple1(0);
  EXPECT_EQ(Evaluations(array), 6 * 5 * 4);
}

TEST(DataArray, CannotBeChanged)
{
  const auto array = WholeArray(MakeModel({6, 5, 4}));
  const double before = array->GetTuple1(3);
  const MessageCapture messages;
  array->SetComponent(3, 0, 1.0);
  EXPECT_TRUE(messages.onlyError("cannot be changed")) << messages.text();
  EXPECT_EQ(array->GetTuple1(3), before);
  array->SetNumberOfTuples(1000);
  EXPECT_EQ(array->Resize(1), 0);
  EXPECT_EQ(array->Allocate(2), 0);
  EXPECT_EQ(messages.errors().size(), 2u) << messages.text();
  EXPECT_EQ(array->GetNumberOfTuples(), 6 * 5 * 4);
}

TEST(DataArray, CannotGrow)
{
  const std::function<void(vtkDataArray*)> changes[] = {
      [](vtkDataArray* array) { array->SetNumberOfComponents(3); },
      [](vtkDataArray* array) { array->InsertComponent(1000, 0, 1.0); },
      [](vtkDataArray* array) { array->InsertTuple1(1000, 1.0); },
      [](vtkDataArray* array) { array->InsertNextTuple1(1.0); },
      [](vtkDataArray* array) { array->InsertVariantValue(1000, vtkVariant(1.0)); },
      [](vtkDataArray* array) { array->SetNumberOfValues(1000); }};
  for (const auto& change : changes) {
    const auto array = WholeArray(MakeModel({6, 5, 4}));
    const MessageCapture messages;
    change(array);
    ASSERT_FALSE(messages.errors().empty());
    EXPECT_NE(messages.errors()[0].find("The number of values"), std::string::npos);
    EXPECT_EQ(array->GetNumberOfComponents(), 1);
    EXPECT_EQ(array->GetNumberOfTuples(), 6 * 5 * 4);
  }
}

TEST(DataArray, SaysOnceThatItCannotBeChanged)
{
  const auto array = WholeArray(MakeModel({6, 5, 4}));
  const MessageCapture messages;
  array->FillComponent(0, 1.0);
  array->Fill(2.0);
  EXPECT_TRUE(messages.onlyError("The values")) << messages.text();
  array->InsertNextTuple1(3.0);
  array->Resize(7);
  EXPECT_EQ(messages.errors().size(), 2u) << messages.text();
}

TEST(DataArray, TakesItsOwnSizeForNoChange)
{
  const auto array = WholeArray(MakeModel({6, 5, 4}));
  const MessageCapture messages;
  array->Squeeze();
  EXPECT_NE(array->Resize(6 * 5 * 4), 0);
  array->SetNumberOfTuples(6 * 5 * 4);
  EXPECT_EQ(array->GetNumberOfTuples(), 6 * 5 * 4);
  EXPECT_TRUE(messages.errors().empty()) << messages.text();
}

namespace {

/// The virtual image and the same with ordinary values: filters must not see a difference.
class StockFilters : public testing::Test
{
protected:
  StockFilters()
  {
    const auto array = WholeArray(MakeModel({64, 64, 64}));
    this->Virtual->SetDimensions(64, 64, 64);
    this->Virtual->GetPointData()->SetScalars(array);
    const auto copy = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
    copy->DeepCopy(array);
    this->Ordinary->SetDimensions(64, 64, 64);
    this->Ordinary->GetPointData()->SetScalars(copy);
  }

  template <class Filter, class Use> void compare(Filter* filter, Use&& use)
  {
    filter->SetInputData(this->Virtual);
    filter->Update();
    auto first = vtkSmartPointer<vtkDataSet>::Take(filter->GetOutput()->NewInstance());
    first->ShallowCopy(filter->GetOutput());
    filter->SetInputData(this->Ordinary);
    filter->Update();
    use(first.Get(), filter->GetOutput());
  }

  static void ExpectSameScalars(vtkDataSet* first, vtkDataSet* second)
  {
    vtkDataArray* a = first->GetPointData()->GetScalars();
    vtkDataArray* b = second->GetPointData()->GetScalars();
    ASSERT_EQ(a->GetNumberOfTuples(), b->GetNumberOfTuples());
    for (vtkIdType index = 0; index < a->GetNumberOfTuples(); ++index) {
      ASSERT_EQ(a->GetTuple1(index), b->GetTuple1(index));
    }
  }

  vtkNew<vtkImageData> Virtual;
  vtkNew<vtkImageData> Ordinary;
};

} // namespace

TEST_F(StockFilters, Contour)
{
  vtkNew<vtkContourFilter> contour;
  contour->SetValue(0, 55.0);
  this->compare(contour.Get(), [](vtkDataSet* first, vtkDataSet* second) {
    ASSERT_GT(first->GetNumberOfPoints(), 100);
    ASSERT_EQ(first->GetNumberOfPoints(), second->GetNumberOfPoints());
    EXPECT_EQ(first->GetNumberOfCells(), second->GetNumberOfCells());
    for (vtkIdType index = 0; index < first->GetNumberOfPoints(); ++index) {
      ASSERT_EQ(first->GetPoint(index)[0], second->GetPoint(index)[0]);
    }
  });
}

TEST_F(StockFilters, Reslice)
{
  vtkNew<vtkImageReslice> reslice;
  reslice->SetInterpolationModeToLinear();
  reslice->SetOutputDimensionality(2);
  reslice->SetResliceAxesDirectionCosines(0.6, 0.8, 0, 0, 0, 1, 0.8, -0.6, 0);
  reslice->SetResliceAxesOrigin(30, 30, 30);
  this->compare(reslice.Get(), ExpectSameScalars);
}

TEST_F(StockFilters, Probe)
{
  vtkNew<vtkImageData> points;
  points->SetDimensions(10, 10, 10);
  points->SetSpacing(6.1, 6.2, 6.3);
  vtkNew<vtkProbeFilter> probe;
  const auto at = [&](vtkImageData* source) {
    probe->SetInputData(points);
    probe->SetSourceData(source);
    probe->Update();
    auto result = vtkSmartPointer<vtkDataSet>::Take(probe->GetOutput()->NewInstance());
    result->ShallowCopy(probe->GetOutput());
    return result;
  };
  const auto first = at(this->Virtual);
  ExpectSameScalars(first, at(this->Ordinary));
}
