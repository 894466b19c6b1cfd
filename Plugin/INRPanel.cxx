// SPDX-License-Identifier: BSD-3-Clause
#include "INRPanel.h"

#include "vtkPVXMLElement.h"
#include "vtkPVXMLParser.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyGroup.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkVolumeMapper.h"

#include <cstring>

namespace {

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

bool IsOfType(vtkSMProxy* representation, const char* type)
{
  return std::strcmp(vtkSMPropertyHelper(representation, "Representation").GetAsString(), type) ==
         0;
}

void CopyToStock(vtkSMProxy* representation, const PanelProperty& property)
{
  representation->GetProperty(property.stock)->Copy(representation->GetProperty(property.panel));
}

} // namespace

bool INRIsShown(vtkSMProxy* representation) { return IsOfType(representation, "INR Volume"); }

bool INRIsStockVolume(vtkSMProxy* representation) { return IsOfType(representation, "Volume"); }

void INRHideSurfaceSettings(vtkSMProxy* representation)
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

void INRPassOn(vtkSMProxy* representation, const char* changed)
{
  for (const PanelProperty& property : PanelProperties) {
    if (std::strcmp(changed, property.panel) == 0) {
      CopyToStock(representation, property); // whoever changed the one sends both
    }
  }
}

void INRPassAllOn(vtkSMProxy* representation)
{
  for (const PanelProperty& property : PanelProperties) {
    if (std::strcmp(property.panel, "INRUnitDistance") != 0) {
      CopyToStock(representation, property);
    }
  }
  representation->UpdateVTKObjects();
}

void INROfferBlendMode(vtkSMProxy* representation)
{
  const char* shown = INRIsShown(representation) ? "INRBlendMode" : "BlendMode";
  if (!representation->GetProperty(shown)->IsInDomains()) {
    for (const char* name : {"BlendMode", "INRBlendMode"}) {
      vtkSMPropertyHelper(representation, name).Set(vtkVolumeMapper::COMPOSITE_BLEND);
    }
    representation->UpdateVTKObjects();
  }
}
