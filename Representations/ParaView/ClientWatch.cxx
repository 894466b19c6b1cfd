// SPDX-License-Identifier: BSD-3-Clause
#include "ClientWatch.h"

#include "QtApplication.h"
#include "vtkCollection.h"
#include "vtkCommand.h"
#include "vtkSMComparativeViewProxy.h"
#include "vtkSMProxy.h"
#include "vtkSMProxyIterator.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSessionProxyManager.h"

#include <algorithm>
#include <cstring>

namespace inr {

namespace {

/// Between two pictures of somebody who turns a view by the wheel, or who holds it still meanwhile.
constexpr std::chrono::milliseconds MostBetweenPictures(300);
constexpr std::chrono::seconds MostHeld(3);

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
  this->IsHeld = this->IsHeld && IsMouseButtonDown();
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
    watch->IsHeld = IsMouseButtonDown();
  }
}

} // namespace inr
