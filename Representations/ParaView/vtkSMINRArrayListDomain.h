// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSMINRArrayListDomain
 * @brief the arrays that a volume may be made of, without the masks that filters leave
 *
 * Where no scalars are active, ParaView chooses the first array by its name, be it vtkGhostType or
 * vtkValidPointMask, which tell where others have no values.
 */
#ifndef vtkSMINRArrayListDomain_h
#define vtkSMINRArrayListDomain_h

#include "vtkINRRepresentationsModule.h" // for the export macro
#include "vtkSMArrayListDomain.h"

class VTKINRREPRESENTATIONS_EXPORT vtkSMINRArrayListDomain : public vtkSMArrayListDomain
{
public:
  static vtkSMINRArrayListDomain* New();
  vtkTypeMacro(vtkSMINRArrayListDomain, vtkSMArrayListDomain);

  bool IsFilteredArray(vtkPVDataInformation* info, int association, const char* name) override;

protected:
  vtkSMINRArrayListDomain() = default;
  ~vtkSMINRArrayListDomain() override = default;

private:
  vtkSMINRArrayListDomain(const vtkSMINRArrayListDomain&) = delete;
  void operator=(const vtkSMINRArrayListDomain&) = delete;
};

#endif
