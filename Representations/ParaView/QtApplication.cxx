// SPDX-License-Identifier: BSD-3-Clause
#include "QtApplication.h"

#include <dlfcn.h>

namespace inr {

namespace {

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

} // namespace

bool IsModalDialogOpen()
{
  // QWindow* QGuiApplication::modalWindow()
  auto* const modalWindow = FindInQt<void*()>("_ZN15QGuiApplication11modalWindowEv");
  return modalWindow && modalWindow() != nullptr;
}

bool IsMouseButtonDown()
{
  // Qt::MouseButtons QGuiApplication::mouseButtons(), which is returned as the int that it holds
  auto* const mouseButtons = FindInQt<int()>("_ZN15QGuiApplication12mouseButtonsEv");
  return mouseButtons && mouseButtons() != 0;
}

} // namespace inr
