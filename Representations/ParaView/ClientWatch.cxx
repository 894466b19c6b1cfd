// SPDX-License-Identifier: BSD-3-Clause
#include "ClientWatch.h"

#include "vtkCollection.h"
#include "vtkCommand.h"
#include "vtkSMComparativeViewProxy.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"

#include <algorithm>
#include <cstring>
#include <dlfcn.h>

namespace inr {

namespace {

/// Between two pictures of somebody who turns a view by the wheel, or who holds it still meanwhile.
constexpr std::chrono::milliseconds MostBetweenPictures(300);
constexpr std::chrono::seconds MostHeld(3);

/// A function of the Qt that this process has loaded, if it is an application of it; else null.
/// ParaView's window is Qt's, but its programs without a window run where Qt is not installed, and
/// so should this library.
template <typename Function> Function* FindInQt(const char* symbol)
{
  void* const* application =
      static_cast<void* const*>(dlsym(RTLD_DEFAULT, "_ZN16QCoreApplication4selfE"));
  return application && *application ? reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, symbol))
                                     : nullptr;
}

bool IsModalDialogOpen()
{
  // QWindow* QGuiApplication::modalWindow()
  auto* const modalWindow = FindInQt<void*()>("_ZN15QGuiApplication11modalWindowEv");
  return modalWindow && modalWindow() != nullptr;
}

bool IsButtonDown()
{
  // Qt::MouseButtons QGuiApplication::mouseButtons(), which is returned as the int that it holds
  auto* const mouseButtons = FindInQt<int()>("_ZN15QGuiApplication12mouseButtonsEv");
  return mouseButtons && mouseButtons() != 0;
}

} // namespace

ClientWatch::ClientWatch()
{
  this->Play->SetClientData(this);
  this->Play->SetCallback(&ClientWatch::OnPlay);
  this->Picture->SetClientData(this);
  this->Picture->SetCallback(&ClientWatch::OnPicture);
}

ClientWatch::~ClientWatch()
{
  for (vtkObject* object : this->Watched) {
    if (object) {
      object->RemoveObserver(this->Play);
      object->RemoveObserver(this->Picture);
    }
  }
}

void ClientWatch::update(const vtkObject& own)
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
      this->watchScene(vtkObject::SafeDownCast(proxy->GetClientSideObject()));
    }
  }
  for (proxies->Begin("views"); !proxies->IsAtEnd(); proxies->Next()) {
    this->watchView(proxies->GetProxy(), own);
    if (auto* comparative = vtkSMComparativeViewProxy::SafeDownCast(proxies->GetProxy())) {
      vtkNew<vtkCollection> cells; // which nobody else knows, and somebody turns
      comparative->GetViews(cells);
      for (int k = 0; k < cells->GetNumberOfItems(); ++k) {
        this->watchView(vtkSMProxy::SafeDownCast(cells->GetItemAsObject(k)), own);
      }
    }
  }
}

bool ClientWatch::isWatched(const vtkObject* object) const
{
  return std::find(this->Watched.begin(), this->Watched.end(), object) != this->Watched.end();
}

void ClientWatch::watchScene(vtkObject* scene)
{
  if (scene && !this->isWatched(scene)) {
    this->Watched.emplace_back(scene);
    scene->AddObserver(vtkCommand::StartEvent, this->Play);
    scene->AddObserver(vtkCommand::EndEvent, this->Play);
  }
}

void ClientWatch::watchView(vtkSMProxy* view, const vtkObject& own)
{
  if (view && view->GetClientSideObject() != &own && !this->isWatched(view)) {
    this->Watched.emplace_back(view);
    view->AddObserver(vtkCommand::EndEvent, this->Picture);
  }
}

bool ClientWatch::isBusy() { return this->Playing || IsModalDialogOpen() || this->isTurning(); }

// Not by the events of interactions: that a selection by mouse has ended, ParaView 5.11 says to
// nobody.
bool ClientWatch::isTurning()
{
  if (!this->Turned) {
    return false;
  }
  const auto since = Clock::now() - *this->Turned;
  this->IsHeld = this->IsHeld && IsButtonDown();
  const bool isTurning = since < (this->IsHeld ? Clock::duration(MostHeld) : MostBetweenPictures);
  if (!isTurning) { // a button that is down later is down for something else
    this->Turned.reset();
  }
  return isTurning;
}

void ClientWatch::OnPlay(vtkObject* scene, unsigned long event, void* self, void*)
{
  static_cast<ClientWatch*>(self)->Playing = event == vtkCommand::StartEvent ? scene : nullptr;
}

// By vtkSMViewProxy.
void ClientWatch::OnPicture(vtkObject*, unsigned long, void* self, void* isInteractive)
{
  if (isInteractive && *static_cast<const int*>(isInteractive) != 0) {
    auto* watch = static_cast<ClientWatch*>(self);
    watch->Turned = Clock::now();
    watch->IsHeld = IsButtonDown();
  }
}

} // namespace inr
