// SPDX-License-Identifier: BSD-3-Clause
#include "INRWatch.h"

#include "INRFirstLook.h"
#include "INRPanel.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkINREXRWriter.h"
#include "vtkNew.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMViewProxy.h"

#include <cstring>

namespace {

/// Of the views that show a representation: who makes one by a script need not register it.
void WatchViewsOf(vtkSMProxy* representation)
{
  for (unsigned int k = 0; k < representation->GetNumberOfConsumers(); ++k) {
    if (auto* view = vtkSMViewProxy::SafeDownCast(representation->GetConsumerProxy(k))) {
      vtkINREXRWriter::WatchView(view);
    }
  }
}

/// What happens to one representation.
class Watch : public vtkCommand
{
public:
  static Watch* New() { return new Watch; }
  vtkTypeMacro(Watch, vtkCommand);

  void begin(vtkSMProxy* representation)
  {
    this->WasShown = INRIsShown(representation);
    representation->AddObserver(vtkCommand::PropertyModifiedEvent, this);
    representation->AddObserver(vtkCommand::UpdateDataEvent, this);
    this->IsUnitDistanceStock = INRIsUnitDistanceStock(representation);
    INRGiveFirstLook(representation);
  }

  void Execute(vtkObject* caller, unsigned long event, void* data) override
  {
    auto* representation = static_cast<vtkSMProxy*>(caller);
    const auto* property = static_cast<const char*>(data);
    if (event == vtkCommand::UpdateDataEvent) {
      this->seeData(representation);
      WatchViewsOf(representation);
      INRFollowData(representation);
    } else if (property && std::strcmp(property, "Representation") == 0) {
      this->changeType(representation);
    } else if (property && INRIsShown(representation)) {
      INRPassOn(representation, property);
    }
    if (property && std::strcmp(property, "ScalarOpacityUnitDistance") == 0) {
      this->IsUnitDistanceStock = INRIsUnitDistanceStock(representation);
    }
  }

private:
  /// The first ones' bounds tell what nobody has chosen, if they were not known before.
  void seeData(vtkSMProxy* representation)
  {
    if (!this->HasSeenData) {
      this->HasSeenData = true;
      this->IsUnitDistanceStock |= INRIsUnitDistanceStock(representation);
    }
  }

  void changeType(vtkSMProxy* representation)
  {
    const bool isShown = INRIsShown(representation);
    const bool isLoading = representation->GetSessionProxyManager()->GetInLoadXMLState();
    if (isShown && !isLoading) {
      INRPassAllOn(representation);
    }
    if (isShown || INRIsStockVolume(representation)) {
      if (isShown != this->WasShown && !isLoading) {
        INROfferBlendMode(representation);
      }
      this->WasShown = isShown;
    }
    INRGiveFirstLook(representation, this->IsUnitDistanceStock);
  }

  bool WasShown = false; ///< when it was a volume last
  bool HasSeenData = false;
  /// By the grid that was there when it was set, as by "Restore defaults", or began: by another one
  /// it might look like somebody's choice.
  bool IsUnitDistanceStock = false;
};

void OnRegister(vtkObject*, unsigned long, void*, void* callData)
{
  const auto* info = static_cast<vtkSMProxyManager::RegisteredProxyInformation*>(callData);
  if (info->Type != vtkSMProxyManager::RegisteredProxyInformation::PROXY || !info->Proxy) {
    return;
  }
  if (auto* view = vtkSMViewProxy::SafeDownCast(info->Proxy)) {
    if (std::strcmp(info->GroupName, "views") == 0) {
      vtkINREXRWriter::WatchView(view);
    }
    return;
  }
  if (std::strcmp(info->GroupName, "representations") != 0 ||
      !info->Proxy->GetProperty("Representation") || !info->Proxy->GetProperty("INRUnitDistance")) {
    return;
  }
  INRHideSurfaceSettings(info->Proxy);
  vtkNew<Watch> watch;
  watch->begin(info->Proxy);
}

/// Of the views that there are when the plugin comes.
void WatchViews()
{
  vtkSMSessionProxyManager* session =
      vtkSMProxyManager::GetProxyManager()->GetActiveSessionProxyManager();
  if (!session) {
    return;
  }
  vtkNew<vtkSMProxyIterator> proxies;
  proxies->SetSessionProxyManager(session);
  for (proxies->Begin("views"); !proxies->IsAtEnd(); proxies->Next()) {
    if (auto* view = vtkSMViewProxy::SafeDownCast(proxies->GetProxy())) {
      vtkINREXRWriter::WatchView(view);
    }
  }
}

} // namespace

void INRWatchProxies()
{
  if (!vtkSMProxyManager::IsInitialized()) {
    return;
  }
  WatchViews();
  vtkNew<vtkCallbackCommand> watch;
  watch->SetCallback(OnRegister);
  vtkSMProxyManager::GetProxyManager()->AddObserver(vtkCommand::RegisterEvent, watch);
}
