// SPDX-License-Identifier: BSD-3-Clause
#include "INRFirstLook.h"

#include "INRPanel.h"
#include "vtkAlgorithm.h"
#include "vtkBoundingBox.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkProcessModule.h"
#include "vtkSMBoundsDomain.h"
#include "vtkSMDoubleVectorProperty.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMViewProxy.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>

namespace {

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

void ColourBy(vtkSMPVRepresentationProxy* representation, const char* array)
{
  // An INR knows no opacity array; ParaView dies of one that the data do not have.
  vtkSMPropertyHelper separate(representation, "UseSeparateOpacityArray");
  const int wasSeparate = separate.GetAsInt();
  separate.Set(0);
  representation->SetScalarColoring(array, vtkDataObject::POINT);
  // A map that already has a range (another data set shares it, a script set it) only grows.
  vtkSMPropertyHelper map(representation, "LookupTable");
  const bool hasRange =
      map.GetAsProxy() &&
      vtkSMPropertyHelper(map.GetAsProxy(), "ScalarRangeInitialized", true).GetAsInt() != 0;
  representation->RescaleTransferFunctionToDataRange(hasRange, false);
  separate.Set(wasSeparate);
  representation->UpdateVTKObjects();
}

/// Colours by another array than before; a colour legend that is shown is that array's then.
void RecolourBy(vtkSMPVRepresentationProxy* representation, const char* array)
{
  vtkSMProxy* view = vtkSMViewProxy::FindView(representation);
  vtkSMProxy* before = vtkSMPropertyHelper(representation, "LookupTable").GetAsProxy();
  const bool hasLegend = view && representation->IsScalarBarVisible(view);
  ColourBy(representation, array);
  if (hasLegend) {
    vtkNew<vtkSMTransferFunctionManager> maps;
    maps->HideScalarBarIfNotNeeded(before, view);
    representation->SetScalarBarVisibility(view, true);
  }
}

/// This comes while the view has its data updated, and before these are delivered to who draws:
/// what was to be delivered is not, where a representation has been changed since.
void DeliverAnew(vtkSMProxy* representation)
{
  if (auto* view = vtkSMViewProxy::SafeDownCast(vtkSMViewProxy::FindView(representation))) {
    view->MarkDirty(nullptr);
    view->Update();
  }
}

/// Whether it is coloured by a point array that these data do not have.
bool MissesItsArray(vtkSMPVRepresentationProxy* representation, vtkPVDataInformation* data)
{
  vtkSMPropertyHelper colouring(representation, "ColorArrayName");
  return representation->GetUsingScalarColoring() &&
         colouring.GetInputArrayAssociation() == vtkDataObject::POINT &&
         !data->GetPointDataInformation()->GetArrayInformation(
             colouring.GetInputArrayNameToProcess());
}

vtkSMDoubleVectorProperty* GetDoubles(vtkSMProxy* proxy, const char* name)
{
  return vtkSMDoubleVectorProperty::SafeDownCast(proxy->GetProperty(name));
}

double LongestSide(const double bounds[6])
{
  double sides[3];
  vtkBoundingBox(bounds).GetLengths(sides);
  return *std::max_element(sides, sides + 3);
}

/// A twentieth of the longest side, below 0 where there are no bounds: what the panel's domain
/// gives to new proxies, too. But ParaView 5.11 gives a server's second client the domains of
/// properties as they were before the plugin overrode them.
double DefaultUnitDistance(vtkSMProxy* representation)
{
  double bounds[6];
  InputInformation(representation)->GetBounds(bounds);
  return vtkBoundingBox(bounds).IsValid() ? LongestSide(bounds) / 20 : -1;
}

/// ParaView's own.
double StockUnitDistance(vtkSMDoubleVectorProperty* property)
{
  property->FindDomain<vtkSMBoundsDomain>()->SetDefaultValues(property, true);
  const double value = property->GetUncheckedElement(0);
  property->ClearUncheckedElements();
  return value;
}

/// That of the whole image that the representation's input has a piece of, as this process knows
/// it; 0 when it does not.
double LongestSideOfWhole(vtkSMProxy* representation)
{
  const vtkSMPropertyHelper input(representation, "Input");
  vtkSMProxy* source = input.GetAsProxy();
  auto* algorithm = vtkAlgorithm::SafeDownCast(source ? source->GetClientSideObject() : nullptr);
  vtkInformation* information =
      algorithm ? algorithm->GetOutputInformation(static_cast<int>(input.GetOutputPort()))
                : nullptr;
  if (!information || !information->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT())) {
    return 0;
  }
  vtkNew<vtkImageData> whole;
  whole->CopyInformationFromPipeline(information); // origin, spacing and direction
  whole->SetExtent(information->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()));
  double bounds[6];
  whole->GetBounds(bounds);
  return LongestSide(bounds);
}

/// What a process that is its own client makes too small: it knows the bounds of its piece.
double PartOfWhole(vtkSMProxy* representation)
{
  if (!vtkProcessModule::GetProcessModule()->GetSymmetricMPIMode()) {
    return 1;
  }
  double bounds[6];
  InputInformation(representation)->GetBounds(bounds);
  const double whole = LongestSideOfWhole(representation);
  return whole > 0 ? LongestSide(bounds) / whole : 1;
}

/// Neither the XML's default nor that of bounds of nothing, which are below 0.
bool IsKnown(vtkSMDoubleVectorProperty* unitDistance) { return !(unitDistance->GetElement(0) < 0); }

/// ParaView's default is about the diagonal of a cell, which makes a volume of 4096^3 look solid
/// and would follow MaximumGridPoints here. The panel's does not depend on the grid. What somebody
/// has set, under either name, stays, unless it is ParaView's own default.
void SetUnitDistance(vtkSMProxy* representation, bool isStock)
{
  auto* stock = GetDoubles(representation, "ScalarOpacityUnitDistance");
  auto* panel = GetDoubles(representation, "INRUnitDistance");
  const bool isNew = isStock && panel->GetElement(0) == stock->GetElement(0);
  const double known = DefaultUnitDistance(representation);
  const double wanted = known > 0 ? known / PartOfWhole(representation) : known;
  if ((isNew || !IsKnown(panel)) && wanted > 0) {
    panel->SetElement(0, wanted);
  }
  if (IsKnown(panel)) {
    stock->Copy(panel);
  }
  representation->UpdateVTKObjects();
}

} // namespace

bool INRIsUnitDistanceStock(vtkSMProxy* representation)
{
  auto* stock = GetDoubles(representation, "ScalarOpacityUnitDistance");
  return stock->GetElement(0) == StockUnitDistance(stock);
}

void INRGiveFirstLook(vtkSMProxy* proxy, bool isUnitDistanceStock)
{
  auto* representation = vtkSMPVRepresentationProxy::SafeDownCast(proxy);
  if (!representation || !INRIsShown(proxy) ||
      representation->GetSessionProxyManager()->GetInLoadXMLState()) {
    return;
  }
  if (vtkPVDataInformation* data = InputInformation(representation)) {
    const char* array = FirstPointArray(data);
    if (array && !representation->GetUsingScalarColoring()) {
      ColourBy(representation, array);
    }
    SetUnitDistance(representation, isUnitDistanceStock || INRIsUnitDistanceStock(representation));
  }
}

void INRFollowData(vtkSMProxy* proxy)
{
  auto* representation = vtkSMPVRepresentationProxy::SafeDownCast(proxy);
  if (!representation || !INRIsShown(proxy)) {
    return;
  }
  auto* unitDistance = GetDoubles(representation, "INRUnitDistance");
  bool isChanged = false;
  if (!IsKnown(unitDistance)) {
    INRGiveFirstLook(representation);
    isChanged = IsKnown(unitDistance);
  }
  vtkPVDataInformation* data = InputInformation(representation);
  const char* array = data ? FirstPointArray(data) : nullptr;
  if (array && MissesItsArray(representation, data)) {
    RecolourBy(representation, array);
    isChanged = true;
  }
  if (isChanged) {
    DeliverAnew(representation);
  }
}
