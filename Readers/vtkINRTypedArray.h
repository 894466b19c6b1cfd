// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRTypedArray
 * @brief a read-only array of one component whose values an INR computes on demand
 *
 * Ranges come from the file and evaluate nothing. Copies of the same type share decoder and cache.
 * NewInstance gives the ordinary array of the type, so that filters write where they can.
 */
#ifndef vtkINRTypedArray_h
#define vtkINRTypedArray_h

#include "Readers/Common/VTKCompat.h"
#include "Readers/Grid/PresentedBricks.h"
#include "Readers/Grid/PresentedGrid.h"
#include "vtkINRDataArray.h"

#include <vtkGenericDataArray.h>
#include <vtkObjectFactory.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

template <class T>
class vtkINRTypedArray : public vtkGenericDataArray<vtkINRTypedArray<T>, T>, public vtkINRDataArray
{
  using Self = vtkINRTypedArray<T>;
  using GenericArray = vtkGenericDataArray<Self, T>;

public:
  vtkAbstractTypeMacroWithNewInstanceType(Self, GenericArray, vtkDataArray, "vtkINRDataArray");
  vtkAOSArrayNewInstanceMacro(Self);
  static Self* New() { VTK_STANDARD_NEW_BODY(Self); }
  using typename GenericArray::ValueType;

  /// GetVoidPointer hands out a decoded copy of at most this many values.
  static constexpr vtkIdType MaximumCopiedValues = LargestPresentedGrid;

  void Initialize(std::shared_ptr<const GridDecoder> decoder, const inr::GridBox& part,
                  std::shared_ptr<Keepsake> keepsake)
  {
    this->Values = std::make_shared<Shared>(std::move(decoder), part);
    this->Values->Kept = std::move(keepsake);
    this->Adopt();
  }

  const inr::ModelPointer& GetModel() const override { return this->Decoder().GetModel(); }
  const std::shared_ptr<Keepsake>& GetKeepsake() const override { return this->Values->Kept; }
  void GetPresentedDimensions(int dims[3]) const override
  {
    for (int axis = 0; axis < 3; ++axis) {
      dims[axis] = this->Decoder().GetPresentedDimensions()[axis];
    }
  }
  void GetPresentedExtent(int extent[6]) const override
  {
    const inr::GridBox& part = this->Values->Bricks.GetPart();
    for (int axis = 0; axis < 3; ++axis) {
      extent[2 * axis] = static_cast<int>(part.first[axis]);
      extent[2 * axis + 1] = static_cast<int>(part.first[axis] + part.size[axis] - 1);
    }
  }
  vtkIdType GetNumberOfEvaluations() const override
  {
    return this->Decoder().GetNumberOfEvaluations();
  }

  ValueType GetValue(vtkIdType index) const
  {
    const T* copy = this->Values->Copy.load(std::memory_order_acquire);
    return copy ? copy[index] : this->Compute(index);
  }
  void GetTypedTuple(vtkIdType index, ValueType* tuple) const { *tuple = this->GetValue(index); }
  ValueType GetTypedComponent(vtkIdType index, int) const { return this->GetValue(index); }

  void SetValue(vtkIdType, ValueType) { this->Refuse(Change::Values); }
  void SetTypedTuple(vtkIdType, const ValueType*) { this->Refuse(Change::Values); }
  void SetTypedComponent(vtkIdType, int, ValueType) { this->Refuse(Change::Values); }

  /// Where there is no such tuple, the base class would count it nevertheless.
  void InsertComponent(vtkIdType tuple, int, double) override
  {
    this->Refuse(tuple > this->MaxId ? Change::Size : Change::Values);
  }
  void SetNumberOfComponents(int components) override
  {
    if (components != 1) {
      this->Refuse(Change::Size);
    }
  }

  // The base class ends the process when it cannot get memory.
  vtkTypeBool Allocate(vtkIdType, vtkIdType) override { return this->Refuse(Change::Size); }
  vtkTypeBool Resize(vtkIdType tuples) override
  {
    return tuples == this->INR_VTK_ARRAY_CAPACITY || this->Refuse(Change::Size);
  }
#ifdef INR_VTK_RESERVE_TUPLES
  vtkTypeBool ReserveTuples(vtkIdType tuples) override
  {
    return tuples <= this->INR_VTK_ARRAY_CAPACITY || this->Refuse(Change::Size);
  }
#endif
  void SetNumberOfTuples(vtkIdType tuples) override { this->Resize(tuples); }
  void Squeeze() override {}

#ifdef INR_VTK_ARRAY_ITERATORS
  /// Over a decoded copy of all values. Who goes by these does not ask whether there is one.
  VTK_NEWINSTANCE vtkArrayIterator* NewIterator() override
  {
    auto* iterator = vtkArrayIteratorTemplate<T>::New();
    iterator->Initialize(this);
    return iterator;
  }
#endif

  /// A decoded copy of all values, kept for the next call; null, with an error, for too many.
  void* GetVoidPointer(vtkIdType index) override
  {
    const T* copy = this->Values->Copy.load(std::memory_order_acquire);
    copy = copy ? copy : this->MakeCopy();
    return copy ? const_cast<T*>(copy) + index : nullptr;
  }
  bool HasStandardMemoryLayout() const override { return false; }

  /// Into memory of the caller's, however many they are. The base class copies what GetVoidPointer
  /// returns, also where that is null.
  void ExportToVoidPointer(void* values) override
  {
    auto* const out = static_cast<T*>(values);
    if (const T* copy = this->Values->Copy.load(std::memory_order_acquire)) {
      std::copy_n(copy, this->INR_VTK_ARRAY_CAPACITY, out);
      return;
    }
    try {
      this->Values->Bricks.DecodeAll(out);
    } catch (const std::bad_alloc&) {
      vtkErrorMacro("Not enough memory to compute " << this->INR_VTK_ARRAY_CAPACITY << " values.");
    }
  }

  /// KiB that the values take now, not what all of them would.
  unsigned long GetActualMemorySize() const override
  {
    const std::size_t bytes =
        this->Values ? this->Values->Bricks.MemorySize() + this->Values->CopyBytes() : 0;
    return static_cast<unsigned long>(bytes / 1024 + 1);
  }

  void ShallowCopy(vtkDataArray* other) override { this->Share(other); }
  void DeepCopy(vtkDataArray* other) override { this->Share(other); }
  void DeepCopy(vtkAbstractArray* other) override { this->Share(other); }

protected:
  vtkINRTypedArray() = default;
  ~vtkINRTypedArray() override = default;

  bool AllocateTuples(vtkIdType) { return this->Refuse(Change::Size); }
  bool ReallocateTuples(vtkIdType) { return this->Refuse(Change::Size); }

  bool ComputeScalarRange(double* range) override { return this->RangeFromFile(range); }
  bool ComputeVectorRange(double range[2]) override { return this->RangeFromFile(range); }
  bool ComputeFiniteScalarRange(double* range) override { return this->RangeFromFile(range); }
  bool ComputeFiniteVectorRange(double range[2]) override { return this->RangeFromFile(range); }
#ifdef INR_VTK_GHOST_RANGES
  bool ComputeScalarRange(double* range, const unsigned char*, unsigned char) override
  {
    return this->RangeFromFile(range);
  }
  bool ComputeVectorRange(double range[2], const unsigned char*, unsigned char) override
  {
    return this->RangeFromFile(range);
  }
  bool ComputeFiniteScalarRange(double* range, const unsigned char*, unsigned char) override
  {
    return this->RangeFromFile(range);
  }
  bool ComputeFiniteVectorRange(double range[2], const unsigned char*, unsigned char) override
  {
    return this->RangeFromFile(range);
  }
#endif

private:
  friend class vtkGenericDataArray<vtkINRTypedArray<T>, T>;
  vtkINRTypedArray(const vtkINRTypedArray&) = delete;
  void operator=(const vtkINRTypedArray&) = delete;

  enum class Change { Values, Size };

  /// What copies of one array share.
  struct Shared
  {
    Shared(std::shared_ptr<const GridDecoder> decoder, const inr::GridBox& part)
        : Bricks(std::move(decoder), part)
    {}
    std::size_t CopyBytes() const
    {
      return this->Copy.load(std::memory_order_acquire) ? this->CopyStore.size() * sizeof(T) : 0;
    }

    PresentedBricks<T> Bricks;
    std::shared_ptr<Keepsake> Kept;
    std::mutex CopyMutex;
    std::vector<T> CopyStore;
    std::atomic<const T*> Copy{nullptr};
  };

  const GridDecoder& Decoder() const { return this->Values->Bricks.GetDecoder(); }

  void Adopt()
  {
    const glm::i64vec3 size = this->Values->Bricks.GetPart().size;
    this->NumberOfComponents = 1;
    this->INR_VTK_ARRAY_CAPACITY = size.x * size.y * size.z;
    this->MaxId = this->INR_VTK_ARRAY_CAPACITY - 1;
    this->DataChanged();
  }

  void Share(vtkAbstractArray* other)
  {
    auto* same = dynamic_cast<Self*>(other);
    if (!same) {
      this->Refuse(Change::Values);
      return;
    }
    if (same != this) {
      this->Values = same->Values;
      this->SetName(same->GetName());
      this->Adopt();
    }
  }

  bool RangeFromFile(double* range) const
  {
    range[0] = this->GetModel()->volume.low;
    range[1] = this->GetModel()->volume.high;
    return this->MaxId >= 0;
  }

  const T* MakeCopy();

  /// Where there is no memory for it, and no way to say so to who asks: the lowest value.
  T Compute(vtkIdType index) const
  {
    try {
      return this->Values->Bricks.Get(index);
    } catch (const std::bad_alloc&) {
      const_cast<vtkINRTypedArray*>(this)->ReportNoMemory();
      return ToScalar<T>(this->GetModel()->volume.low);
    }
  }
  /// Once: values are many.
  void ReportNoMemory()
  {
    if (!this->ToldOfMemory.exchange(true)) {
      vtkErrorMacro("There is not enough memory to compute values of an implicit neural "
                    "representation; those that cannot be computed are "
                    << this->GetModel()->volume.low << ".");
    }
  }

  /// Says so once: a filter that writes does it for every value.
  bool Refuse(Change change)
  {
    std::atomic<bool>& told = this->Told[static_cast<std::size_t>(change)];
    if (!told.exchange(true)) {
      vtkErrorMacro("The " << (change == Change::Values ? "values" : "number of values")
                           << " of an implicit neural representation cannot be changed; use "
                              "INRDecode to get ordinary ones.");
    }
    return false;
  }

  std::shared_ptr<Shared> Values;
  std::array<std::atomic<bool>, 2> Told{};
  std::atomic<bool> ToldOfMemory{false};
};

template <class T> const T* vtkINRTypedArray<T>::MakeCopy()
{
  Shared& shared = *this->Values;
  const std::lock_guard<std::mutex> lock(shared.CopyMutex);
  if (!shared.Copy) {
    if (this->INR_VTK_ARRAY_CAPACITY > MaximumCopiedValues) {
      vtkErrorMacro("A filter asks for a copy of all "
                    << this->INR_VTK_ARRAY_CAPACITY
                    << " values of an implicit neural representation, more than the limit of "
                    << MaximumCopiedValues
                    << ". Lower MaximumGridPoints of the reader, or use "
                       "INRDecode for a part or a coarser level.");
      return nullptr;
    }
    try {
      shared.CopyStore.resize(static_cast<std::size_t>(this->INR_VTK_ARRAY_CAPACITY));
      shared.Bricks.DecodeAll(shared.CopyStore.data());
    } catch (const std::bad_alloc&) {
      vtkErrorMacro("Not enough memory for a copy of " << this->INR_VTK_ARRAY_CAPACITY
                                                       << " values.");
      return nullptr;
    }
    shared.Copy.store(shared.CopyStore.data(), std::memory_order_release);
    shared.Bricks.Clear(); // nobody asks it any more
  }
  return shared.Copy;
}

#endif
