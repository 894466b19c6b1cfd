// SPDX-License-Identifier: BSD-3-Clause
#include "INRFirstLook.h"

#include "vtkCallbackCommand.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkNew.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMBoundsDomain.h"
#include "vtkSMDoubleVectorProperty.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace {

constexpr const char* TypeText = "INR Volume";
constexpr const char* UnitDistance = "ScalarOpacityUnitDistance";

vtkPVDataInformation* InputInformation(vtkSMProxy* representation)
{
  vtkSMPropertyHelper input(representation, "Input");
  auto* source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  return source ? source->GetDataInformation(input.GetOutputPort()) : nullptr;
}

const char* FirstPointArray(vtkPVDataInformation* data)
{
  auto* points = data->GetPointDataInformation();
  auto* scalars = points->GetAttributeInformation(vtkDataSetAttributes::SCALARS);
  if (!scalars && points->GetNumberOfArrays() > 0) {
    scalars = points->GetArrayInformation(0);
  }
  return scalars ? scalars->GetName() : nullptr;
}

void ColourByData(vtkSMPVRepresentationProxy* representation, const char* array)
{
  if (!array || representation->GetUsingScalarColoring()) {
    return;
  }
  representation->SetScalarColoring(array, vtkDataObject::POINT);
  // A map that already has a range (another data set shares it, a script set it) only grows.
  vtkSMPropertyHelper map(representation, "LookupTable");
  const bool hasRange =
      map.GetAsProxy() &&
      vtkSMPropertyHelper(map.GetAsProxy(), "ScalarRangeInitialized", true).GetAsInt() != 0;
  representation->RescaleTransferFunctionToDataRange(hasRange, false);
}

/// Cells of the native grid of an INR; of other data, their own.
double NativeCells(vtkPVDataInformation* data)
{
  auto* native = data->GetFieldDataInformation()->GetArrayInformation("INRNativeDimensions");
  if (!native || native->GetNumberOfComponents() != 3) {
    return static_cast<double>(data->GetNumberOfCells());
  }
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    cells *= std::max(native->GetComponentRange(axis)[0] - 1, 1.0);
  }
  return cells;
}

/// ParaView's default is about the diagonal of a cell, which makes a volume of 4096^3 look solid
/// and would follow MaximumGridPoints here. This one is the diagonal of a cell of the native grid,
/// or of a grid of 256^3 points where that is coarser.
double DefaultUnitDistance(vtkPVDataInformation* data)
{
  const double* bounds = data->GetBounds();
  const double diagonal =
      std::hypot(bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]);
  return diagonal / std::cbrt(std::clamp(NativeCells(data), 1.0, 255.0 * 255.0 * 255.0));
}

/// Whether the property still has the value that its domain gives to new proxies.
bool IsDomainDefault(vtkSMProperty* property)
{
  auto* values = vtkSMDoubleVectorProperty::SafeDownCast(property);
  auto* domain = values ? values->FindDomain<vtkSMBoundsDomain>() : nullptr;
  if (!domain) {
    return false;
  }
  domain->SetDefaultValues(values, true);
  const bool same = values->GetElement(0) == values->GetUncheckedElement(0);
  values->ClearUncheckedElements();
  return same;
}

void SetUnitDistance(vtkSMProxy* representation, vtkPVDataInformation* data)
{
  if (IsDomainDefault(representation->GetProperty(UnitDistance))) {
    vtkSMPropertyHelper(representation, UnitDistance).Set(DefaultUnitDistance(data));
    representation->UpdateVTKObjects();
  }
}

void GiveFirstLook(vtkSMProxy* proxy)
{
  auto* representation = vtkSMPVRepresentationProxy::SafeDownCast(proxy);
  if (!representation || representation->GetSessionProxyManager()->GetInLoadXMLState() ||
      std::strcmp(vtkSMPropertyHelper(proxy, "Representation").GetAsString(), TypeText) != 0) {
    return;
  }
  if (vtkPVDataInformation* data = InputInformation(representation)) {
    ColourByData(representation, FirstPointArray(data));
    SetUnitDistance(representation, data);
  }
}

void OnPropertyModified(vtkObject* caller, unsigned long, void*, void* name)
{
  if (name && std::strcmp(static_cast<const char*>(name), "Representation") == 0) {
    GiveFirstLook(static_cast<vtkSMProxy*>(caller));
  }
}

void OnRegister(vtkObject*, unsigned long, void*, void* callData)
{
  const auto* info = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(callData);
  if (info->Type != vtkSMProxyManager::RegisteredProxyInformation::PROXY || !info->Proxy ||
      std::strcmp(info->GroupName, "representations") != 0 ||
      !info->Proxy->GetProperty("Representation")) {
    return;
  }
  vtkNew<vtkCallbackCommand> watch;
  watch->SetCallback(OnPropertyModified);
  info->Proxy->AddObserver(vtkCommand::PropertyModifiedEvent, watch);
  GiveFirstLook(info->Proxy);
}

} // namespace

void INRWatchRepresentations()
{
  if (!vtkSMProxyManager::IsInitialized()) {
    return;
  }
  vtkNew<vtkCallbackCommand> watch;
  watch->SetCallback(OnRegister);
  vtkSMProxyManager::GetProxyManager()->AddObserver(vtkCommand::RegisterEvent, watch);
}
