// SPDX-License-Identifier: BSD-3-Clause
#include "INRFirstLook.h"

#include "vtkCallbackCommand.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkNew.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkPVXMLParser.h"
#include "vtkSMBoundsDomain.h"
#include "vtkSMDoubleVectorProperty.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMPropertyGroup.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"

#include <cstring>

namespace {

constexpr const char* TypeText = "INR Volume";

/// Shows a group of the panel for representations that are no volumes.
constexpr const char* NeitherVolume =
    R"(<PropertyWidgetDecorator type="CompositeDecorator">
         <Expression type="and">
           <PropertyWidgetDecorator type="GenericDecorator" mode="visibility"
                                    property="Representation" value="Volume" inverse="1"/>
           <PropertyWidgetDecorator type="GenericDecorator" mode="visibility"
                                    property="Representation" value="INR Volume" inverse="1"/>
         </Expression>
       </PropertyWidgetDecorator>)";

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

vtkSMDoubleVectorProperty* GetDoubles(vtkSMProxy* proxy, const char* name)
{
  return vtkSMDoubleVectorProperty::SafeDownCast(proxy->GetProperty(name));
}

/// The value that the property's domain gives to new proxies.
double DomainDefault(vtkSMDoubleVectorProperty* property)
{
  property->FindDomain<vtkSMBoundsDomain>()->SetDefaultValues(property, true);
  const double value = property->GetUncheckedElement(0);
  property->ClearUncheckedElements();
  return value;
}

/// Neither the XML's default nor that of bounds of nothing, which are below 0.
bool IsKnown(vtkSMDoubleVectorProperty* unitDistance) { return !(unitDistance->GetElement(0) < 0); }

/// ParaView's default is about the diagonal of a cell, which makes a volume of 4096^3 look solid
/// and would follow MaximumGridPoints here. The panel's does not depend on the grid. What somebody
/// has set, under either name, stays.
void SetUnitDistance(vtkSMProxy* representation)
{
  auto* stock = GetDoubles(representation, "ScalarOpacityUnitDistance");
  auto* panel = GetDoubles(representation, "INRUnitDistance");
  const bool isNew =
      stock->GetElement(0) == DomainDefault(stock) && panel->GetElement(0) == stock->GetElement(0);
  const double wanted = DomainDefault(panel); // below 0 where there are no bounds yet
  if ((isNew || !IsKnown(panel)) && wanted > 0) {
    panel->SetElement(0, wanted);
  }
  if (IsKnown(panel)) {
    stock->Copy(panel);
  }
  representation->UpdateVTKObjects();
}

/// What the panel shows under a name of its own, because ParaView hides the stock property's widget
/// for this type of representation. ParaView passes the stock one's value on to the panel's.
struct PanelProperty
{
  const char* panel;
  const char* stock;
};
constexpr PanelProperty PanelProperties[] = {{"INRUnitDistance", "ScalarOpacityUnitDistance"},
                                             {"INRShade", "Shade"},
                                             {"INRAmbient", "Ambient"},
                                             {"INRDiffuse", "Diffuse"},
                                             {"INRSpecular", "Specular"},
                                             {"INRSpecularPower", "SpecularPower"},
                                             {"INRBlendMode", "BlendMode"},
                                             {"INRIsosurfaceValues", "IsosurfaceValues"},
                                             {"INRUseCropping", "UseCropping"},
                                             {"INRCroppingOrigin", "CroppingOrigin"},
                                             {"INRCroppingScale", "CroppingScale"}};

/// Passes what was changed in the panel on to the stock property: scripts and state files then find
/// the same value under both names.
void PassOn(vtkSMProxy* representation, const char* changed)
{
  for (const PanelProperty& property : PanelProperties) {
    if (std::strcmp(changed, property.panel) == 0) {
      representation->GetProperty(property.stock)
          ->Copy(representation->GetProperty(property.panel));
      representation->UpdateVTKObjects();
    }
  }
}

bool IsInr(vtkSMProxy* representation)
{
  return std::strcmp(vtkSMPropertyHelper(representation, "Representation").GetAsString(),
                     TypeText) == 0;
}

void GiveFirstLook(vtkSMProxy* proxy)
{
  auto* representation = vtkSMPVRepresentationProxy::SafeDownCast(proxy);
  if (!representation || !IsInr(proxy) ||
      representation->GetSessionProxyManager()->GetInLoadXMLState()) {
    return;
  }
  if (vtkPVDataInformation* data = InputInformation(representation)) {
    ColourByData(representation, FirstPointArray(data));
    SetUnitDistance(representation);
  }
}

void OnPropertyModified(vtkObject* caller, unsigned long, void*, void* data)
{
  auto* representation = static_cast<vtkSMProxy*>(caller);
  const char* name = static_cast<const char*>(data);
  if (name && std::strcmp(name, "Representation") == 0) {
    GiveFirstLook(representation);
  } else if (name && IsInr(representation)) {
    PassOn(representation, name);
  }
}

/// Looks again when the first look had no data to see.
void OnUpdated(vtkObject* caller, unsigned long, void*, void*)
{
  auto* representation = static_cast<vtkSMProxy*>(caller);
  if (IsInr(representation) && !IsKnown(GetDoubles(representation, "INRUnitDistance"))) {
    GiveFirstLook(representation);
  }
}

/// Hides what ParaView hides for "Volume", too: opacity, sizes and shine of surfaces, which do
/// nothing to a volume.
void HideSurfaceSettings(vtkSMProxy* representation)
{
  for (std::size_t k = 0; k < representation->GetNumberOfPropertyGroups(); ++k) {
    vtkPVXMLElement* hints = representation->GetPropertyGroup(k)->GetHints();
    vtkPVXMLElement* shows =
        hints && hints->GetNumberOfNestedElements() == 1 ? hints->GetNestedElement(0) : nullptr;
    const auto is = [&](const char* name, const char* value) {
      const char* found = shows->GetAttribute(name);
      return found && std::strcmp(found, value) == 0;
    };
    if (shows && is("property", "Representation") && is("value", "Volume") && is("inverse", "1")) {
      hints->RemoveAllNestedElements();
      hints->AddNestedElement(vtkPVXMLParser::ParseXML(NeitherVolume));
    }
  }
}

void OnRegister(vtkObject*, unsigned long, void*, void* callData)
{
  const auto* info = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(callData);
  if (info->Type != vtkSMProxyManager::RegisteredProxyInformation::PROXY || !info->Proxy ||
      std::strcmp(info->GroupName, "representations") != 0 ||
      !info->Proxy->GetProperty("Representation") || !info->Proxy->GetProperty("INRUnitDistance")) {
    return;
  }
  HideSurfaceSettings(info->Proxy);
  vtkNew<vtkCallbackCommand> watch;
  watch->SetCallback(OnPropertyModified);
  info->Proxy->AddObserver(vtkCommand::PropertyModifiedEvent, watch);
  vtkNew<vtkCallbackCommand> watchData;
  watchData->SetCallback(OnUpdated);
  info->Proxy->AddObserver(vtkCommand::UpdateDataEvent, watchData);
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
