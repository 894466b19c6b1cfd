// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMINRArrayListDomain.h"

#include "vtkINRWriter.h"

#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkSMINRArrayListDomain);

bool vtkSMINRArrayListDomain::IsFilteredArray(vtkPVDataInformation*, int, const char* name)
{
  return vtkINRWriter::IsMask(name);
}
