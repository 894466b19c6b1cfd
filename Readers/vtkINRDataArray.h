// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkINRDataArray
 * @brief the handle to an implicit neural representation inside a point array
 *
 * vtkINRReader gives its image a point array whose values are computed when somebody asks for them.
 * The array has the scalar type of the source volume, so it is one of several template
 * instances; this interface is what they share. It is no vtkObject: hold the array itself.
 */
#ifndef vtkINRDataArray_h
#define vtkINRDataArray_h

#include "Core/Model/Model.h"    // for inr::ModelPointer
#include "vtkINRReadersModule.h" // for export macro

#include <vtkSmartPointer.h> // for return value

#include <memory> // for Keepsake

class vtkAbstractArray;
class vtkDataArray;
class vtkImageData;
class vtkPointData;

class VTKINRREADERS_EXPORT vtkINRDataArray
{
public:
  /// A place for what whoever draws the model wants to find again when it is drawn the next time.
  /// It lives as long as the model may be shown again, whatever becomes of the arrays: a reader
  /// that shows another time step makes new arrays of the earlier ones' models later.
  struct Keepsake
  {
    std::shared_ptr<const void> Content;
  };

  /// The interface of `array`, or null if it is an ordinary array or null.
  static vtkINRDataArray* SafeDownCast(vtkAbstractArray* array);

  /// Of several arrays the one that an INR computes: the active scalars, or else the first one;
  /// null for none.
  static vtkAbstractArray* FindIn(vtkPointData* points);

  /// An array over the points `extent` (inclusive limits) of a grid that spans the point bounds of
  /// the model's native grid with `presentedDims` points. Nothing is evaluated here. Without a
  /// `keepsake` it has one of its own. Throws inr::Error when the model contradicts itself or the
  /// extent lies outside the grid.
  static vtkSmartPointer<vtkDataArray> Create(inr::ModelPointer model, const int presentedDims[3],
                                              const int extent[6],
                                              std::shared_ptr<Keepsake> keepsake = nullptr);

  virtual const inr::ModelPointer& GetModel() const = 0;

  /// Never null.
  virtual const std::shared_ptr<Keepsake>& GetKeepsake() const = 0;

  /// Points per axis of the whole presented grid, whatever part of it this array holds.
  virtual void GetPresentedDimensions(int dims[3]) const = 0;

  /// The points of that grid which this array holds, inclusive limits.
  virtual void GetPresentedExtent(int extent[6]) const = 0;

  /// The index that the presented grid's first point has in `image`, whose array this is: other
  /// than 0 where a filter has moved the image's extent.
  void GetShift(vtkImageData* image, int shift[3]) const;

  /// Values computed so far, over all arrays that share this one's cache.
  virtual vtkIdType GetNumberOfEvaluations() const = 0;

  vtkINRDataArray(const vtkINRDataArray&) = delete;
  vtkINRDataArray& operator=(const vtkINRDataArray&) = delete;

protected:
  vtkINRDataArray() = default;
  virtual ~vtkINRDataArray() = default;
};

#endif
