// SPDX-License-Identifier: BSD-3-Clause
#include "ClientWatch.h"

#include "vtkCommand.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"

#include <algorithm>
#include <cstring>
#include <dlfcn.h>

namespace inr {

namespace {

/// Asks the Qt that this process has loaded, if any: ParaView's window is Qt's, but its programs
/// without a window run where Qt is not installed, and so should this library.
bool IsModalDialogOpen()
{
  void* const* application =
      static_cast<void* const*>(dlsym(RTLD_DEFAULT, "_ZN16QCoreApplication4selfE"));
  void* const modalWindow = dlsym(RTLD_DEFAULT, "_ZN15QGuiApplication11modalWindowEv");
  if (!application || !*application || !modalWindow) {
    return false;
  }
  // QWindow* QGuiApplication::modalWindow()
  return reinterpret_cast<void* (*)()>(modalWindow)() != nullptr;
}

} // namespace

ClientWatch::ClientWatch()
{
  this->Command->SetClientData(this);
  this->Command->SetCallback(&ClientWatch::OnPlay);
}

ClientWatch::~ClientWatch()
{
  for (vtkObject* scene : this->Scenes) {
    if (scene) {
      scene->RemoveObserver(this->Command);
    }
  }
}

void ClientWatch::update()
{
  vtkSMSessionProxyManager* session =
      vtkSMProxyManager::IsInitialized()
          ? vtkSMProxyManager::GetProxyManager()->GetActiveSessionProxyManager()
          : nullptr;
  if (!session) {
    return;
  }
  vtkNew<vtkSMProxyIterator> proxies;
  proxies->SetSessionProxyManager(session);
  for (proxies->Begin("animation"); !proxies->IsAtEnd(); proxies->Next()) {
    vtkSMProxy* proxy = proxies->GetProxy();
    if (std::strcmp(proxy->GetXMLName(), "AnimationScene") == 0) {
      this->watch(vtkObject::SafeDownCast(proxy->GetClientSideObject()));
    }
  }
}

void ClientWatch::watch(vtkObject* scene)
{
  if (scene && std::find(this->Scenes.begin(), this->Scenes.end(), scene) == this->Scenes.end()) {
    this->Scenes.emplace_back(scene);
    scene->AddObserver(vtkCommand::StartEvent, this->Command);
    scene->AddObserver(vtkCommand::EndEvent, this->Command);
  }
}

bool ClientWatch::isBusy() const { return this->Playing || IsModalDialogOpen(); }

void ClientWatch::OnPlay(vtkObject* scene, unsigned long event, void* self, void*)
{
  static_cast<ClientWatch*>(self)->Playing = event == vtkCommand::StartEvent ? scene : nullptr;
}

} // namespace inr
